"""A study's report, from its folder to files."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nullpose.errors import UsageError
from nullpose.files import prepare_folder, replacing, write_text
from nullpose.objectives import Quantity
from nullpose.report.figures.style import write_figure
from nullpose.report.study.answer import answer_of, certainty_of, null_words, outage_words, unfinished_note
from nullpose.report.study.cases import report_cases
from nullpose.report.study.html import report_page
from nullpose.report.study.markdown import report_text, title_of
from nullpose.report.study.summary import Summary, summarise
from nullpose.report.study.values import gather
from nullpose.study.monte_carlo import read_study

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyReport:
    """A report that was written.

    Args:
        answer: the first paragraph.
        notes: that the study is not finished, if so; outage; what is proved.
        summary: the statistics.
        files: what was written.
    """

    answer: str
    notes: tuple[str, ...]
    summary: Summary
    files: tuple[Path, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the report as plain data."""
        frame = self.summary.table()
        rows = frame.astype(object).where(frame.notna(), None).to_dict(orient="records")
        return {
            "study": self.summary.spec.name,
            "complete": self.summary.is_complete,
            "scenes_done": self.summary.values.scenes,
            "answer": self.answer,
            "notes": list(self.notes),
            "summary": rows,
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
    """Write the report of the study in a folder, as far as it is, and return what it says.

    Args:
        folder: of the study.
        out: where the report goes; without it the folder ``report`` in the study's.
        requirement_db: smallest SINR or margin that will do [dB]; without it 0 dB of a margin, else none.
        requirement_bps_hz: the same of a secrecy rate.
        against: name of the case to measure gains against; without it the level vehicle.

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
        values = gather(table, lambda batch: file.write(_csv(batch, header=file.tell() == 0)))
    summary = summarise(table, values, cases, requirement)
    figures = _write_figures(summary, prepare_folder(target / "figures"))
    text = report_text(summary, list(figures))
    page = report_page(text, title_of(summary), {name: svg for name, (_, svg) in figures.items()})
    files = [
        write_text(target / "report.md", text),
        write_text(target / "report.html", page),
        write_text(target / "summary.csv", _csv(summary.table(), header=True)),
        data,
        *(path for pair in figures.values() for path in pair),
    ]
    notes = (unfinished_note(summary), outage_words(summary), null_words(summary), certainty_of(summary))
    return StudyReport(
        answer=answer_of(summary),
        notes=tuple(note for note in notes if note),
        summary=summary,
        files=tuple(files),
    )


def _requirement(quantity: Quantity, in_db: float | None, in_bps_hz: float | None) -> float | None:
    if quantity.is_rate and in_db is not None:
        raise UsageError("requirement-db: the study's values are rates; give --requirement-bps-hz instead")
    if not quantity.is_rate and in_bps_hz is not None:
        raise UsageError("requirement-bps-hz: the study's values are in dB; give --requirement-db instead")
    given = in_bps_hz if quantity.is_rate else in_db
    if given is not None and not abs(given) < 1e6:
        raise UsageError(f"requirement: given {given!r}; allowed: a finite number, as in 3")
    return 0.0 if given is None and quantity.noun == "margin" else given


def _write_figures(summary: Summary, folder: Path) -> dict[str, tuple[Path, ...]]:
    """Write what there is to draw; take away what an earlier report drew and this one does not."""
    from nullpose.report.study.figures import FIGURES, figures_of

    written = {name: write_figure(figure, folder, name) for name, figure in figures_of(summary)}
    for name in FIGURES:
        if name not in written:
            for suffix in (".png", ".svg"):
                (folder / f"{name}{suffix}").unlink(missing_ok=True)
    return written


def _csv(rows: pd.DataFrame, *, header: bool) -> str:
    return str(rows.to_csv(index=False, header=header, lineterminator="\n"))
