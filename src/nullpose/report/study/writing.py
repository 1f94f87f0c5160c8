"""A study's report, from its folder to files: two sentences, three numbers, a table and two figures."""

from __future__ import annotations

import base64
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.errors import require_usage
from nullpose.files import prepare_folder, replacing, write_text
from nullpose.objectives import Quantity
from nullpose.report.figures.style import write_figure
from nullpose.report.numbers import NONE, number, percent, with_unit
from nullpose.report.study.cases import point_words, report_cases, shown_points
from nullpose.report.study.summary import CONFIDENCE, STATUSES, Summary, summarise
from nullpose.study.monte_carlo import read_study

if TYPE_CHECKING:
    import pandas as pd

_CAPTIONS = {
    "distribution": "The distribution over scenes",
    "gain": "The gains of each case, with their confidence intervals",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyReport:
    """A report that was written.

    Args:
        answer: the first sentence.
        notes: how far the study is, if it is not finished; what is proved.
        summary: the statistics.
        files: that were written.
    """

    answer: str
    notes: tuple[str, ...]
    summary: Summary
    files: tuple[Path, ...]

    def to_dict(self) -> dict[str, object]:
        """Return the report as plain data."""
        frame = self.summary.table()
        return {
            "study": self.summary.spec.name,
            "complete": self.summary.is_complete,
            "scenes_done": self.summary.scenes,
            "answer": self.answer,
            "notes": list(self.notes),
            "summary": frame.astype(object).where(frame.notna(), None).to_dict(orient="records"),
            "files": [str(path) for path in self.files],
        }


def report_study(
    folder: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    requirement_db: float | None = None,
    requirement_bps_hz: float | None = None,
    against: str | None = None,
) -> StudyReport:
    """Write the report of the study in a folder, finished or not.

    Args:
        folder: of the study.
        out: where the report goes; without it the folder ``report`` in the study's.
        requirement_db: smallest SINR or margin that will do [dB]; without it 0 dB of a margin, else none.
        requirement_bps_hz: the same of a secrecy rate.
        against: name of the case that gains refer to; without it the level vehicle.

    Raises:
        UsageError: no study is there, a part of it is damaged, an extra is missing, there is no case of that
            name, or a requirement in the other unit than the study's.
        OutputError: a file cannot be written.
    """
    table = read_study(folder)
    requirement = _requirement(table.quantity, requirement_db, requirement_bps_hz)
    cases = report_cases(table.spec, against)
    target = prepare_folder(Path(folder) / "report" if out is None else Path(out))
    data = target / "study.csv"
    with replacing(data) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        summary = summarise(
            table, cases, requirement, lambda batch: file.write(_csv(batch, header=file.tell() == 0))
        )
    figures = _write_figures(summary, prepare_folder(target / "figures"))
    leader = _leader(summary)
    reference = str(summary.cases.loc[leader, "against"] if leader else summary.cases.index[0])
    unit, spec, done = table.quantity.unit, table.spec, f"{summary.scenes:,} of {table.spec.n_scenes:,}"
    unfinished = "" if summary.is_complete else f"This study is not finished: {done} scenes are done."
    page: dict[str, object] = {
        "summary": summary,
        "title": spec.name or "A study without a name",
        "unfinished": unfinished,
        "counts": {name: int(summary.frame[name.replace("-", "_")].sum()) for name in STATUSES},
        "leader": leader,
        "reference": reference,
        "requirement": "" if requirement is None else f"{requirement:g} {unit}",
        "swept": spec.swept,
        "words": point_words(spec, -1),
        "points": {point: point_words(spec, point) for point in shown_points(spec)},
        "captions": _CAPTIONS,
        "images": {
            name: base64.b64encode(svg.read_bytes()).decode() for name, (_, svg, _) in figures.items()
        },
        "confidence": percent(CONFIDENCE),
        "percent": percent,
        "cell": partial(_cell, summary),
        "with_unit": lambda point, case, name: with_unit(summary.row(point, case)[name], table.quantity),
    }
    sentences = _rendered("sentences.txt.jinja", page).splitlines()
    page["sentences"] = sentences
    return StudyReport(
        answer=sentences[0],
        notes=tuple(filter(None, (unfinished, *sentences[1:]))),
        summary=summary,
        files=(
            write_text(target / "report.md", _rendered("report.md.jinja", page)),
            write_text(target / "report.html", _rendered("report.html.jinja", page)),
            write_text(target / "summary.csv", _csv(summary.table(), header=True)),
            data,
            *(path for pair in figures.values() for path in pair),
        ),
    )


def _requirement(quantity: Quantity, in_db: float | None, in_bps_hz: float | None) -> float | None:
    require_usage(
        in_db is None or not quantity.is_rate,
        "requirement-db: the study's values are rates; give --requirement-bps-hz instead",
    )
    require_usage(
        in_bps_hz is None or quantity.is_rate,
        "requirement-bps-hz: the study's values are in dB; give --requirement-db instead",
    )
    requirement = in_bps_hz if quantity.is_rate else in_db
    require_usage(
        requirement is None or abs(requirement) < 1e6,
        f"requirement: given {requirement!r}; allowed: a finite number, as in 3",
    )
    return 0.0 if requirement is None and quantity.noun == "margin" else requirement


def _leader(summary: Summary) -> str:
    """Choose the omnidirectional case, or that with the highest median gain, at the last swept values."""
    gains = {case: float(summary.row(-1, case)["gain_median"]) for case in summary.compared}
    whole = set(summary.cases["whole"])
    return max(
        (case for case, gain in gains.items() if gain == gain),
        key=lambda case: (case in whole, gains[case]),
        default="",
    )


def _cell(summary: Summary, point: int, case: str, name: str) -> str:
    """Write a number with its interval, as in "4.10 (3.90 to 4.30)"; without, if neither end is known."""
    row, quantity = summary.row(point, case), summary.quantity
    value, low, high = (number(row[key], quantity) for key in (name, f"{name}_low", f"{name}_high"))
    return value if low == high == NONE else f"{value} ({low} to {high})"


def _escaped(value: object) -> str:
    """Escape a title, a name or a reason for a line of Markdown."""
    return re.sub(r"([\\`*|<>\[\]#$])", r"\\\1", " ".join(str(value).split()))


def _rendered(template: str, page: Mapping[str, object]) -> str:
    """Fill a template; a text of the study is never markup."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("nullpose.report.study"),
        autoescape=".html." in template,
        finalize=_escaped if ".md." in template else None,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return str(environment.get_template(template).render(page))


def _write_figures(summary: Summary, folder: Path) -> dict[str, tuple[Path, ...]]:
    """Write the figures; remove those of an earlier report."""
    from nullpose.report.study.figures import figures_of

    kinds, drawn = (".png", ".svg", ".pdf"), figures_of(summary)
    # the last five are of earlier versions, whose folders may be written again
    for name, kind in product((*_CAPTIONS, "sweep", "best", "outage", "robustness", "effort"), kinds):
        (folder / f"{name}{kind}").unlink(missing_ok=True)
    return {name: write_figure(drawn[name], *(folder / f"{name}{kind}" for kind in kinds)) for name in drawn}


def _csv(rows: pd.DataFrame, *, header: bool) -> str:
    return str(rows.to_csv(index=False, header=header, lineterminator="\n"))
