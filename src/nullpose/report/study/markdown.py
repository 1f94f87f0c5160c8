"""The report as Markdown: the answer first, then each part with its figure and its tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nullpose.report.document import markdown_table
from nullpose.report.numbers import NONE, begun, count_of, escaped, number, percent, with_interval
from nullpose.report.study.answer import answer_of, certainty_of, null_words, outage_words, unfinished_note
from nullpose.report.study.cases import ReportCase
from nullpose.report.study.statistics import CONFIDENCE, FEW_SCENES, quantile, replicates_of
from nullpose.report.study.summary import Summary, three_of
from nullpose.report.study.values import STATUSES

_SURE = percent(CONFIDENCE)
_MOST_REASONS = 12
_LONGEST_REASON = 300  # letters

Rows = Sequence[Mapping[str, str]]


@dataclass(frozen=True, slots=True)
class _Part:
    """A part of a report, which is written if it has a figure or a table.

    Args:
        heading: above it.
        words: what is shown.
        figure: its name.
        caption: of the figure.
        tables: rows by what stands above them; those without rows are left out.
    """

    heading: str
    words: str
    figure: str
    caption: str
    tables: Mapping[str, Rows] = field(default_factory=dict)

    def blocks(self, figures: Collection[str]) -> Iterator[str]:
        """Yield the paragraphs of the part, given which figures were drawn."""
        tables = {title: rows for title, rows in self.tables.items() if rows}
        if self.figure not in figures and not tables:
            return
        yield f"## {self.heading}"
        yield self.words
        if self.figure in figures:
            caption = escaped(self.caption)
            yield f"![{caption}](figures/{self.figure}.png)"
            yield f"*{caption}*"
        for title, rows in tables.items():
            yield f"**{title}**"
            yield markdown_table(rows)


def title_of(summary: Summary) -> str:
    """Return the title of a report: the study's name.

    Args:
        summary: of the study.
    """
    return summary.spec.name or "A study without a name"


def report_text(summary: Summary, figures: Collection[str]) -> str:
    """Return the report as Markdown; figures are looked for in the folder ``figures`` beside it.

    Args:
        summary: of the study.
        figures: names of those that were drawn.
    """
    note = unfinished_note(summary)
    blocks = [f"# {escaped(title_of(summary))}", f"> **{note}**" if note else ""]
    blocks += map(
        escaped, (answer_of(summary), outage_words(summary), null_words(summary), certainty_of(summary))
    )
    if summary.values.scenes:
        blocks.append(_definitions(summary))
        along = f"Median and worst tenth of the {summary.quantity.smallest} along the sweep."
        parts = [
            _reached(summary),
            _gained(summary),
            _Part("Along the sweep", "", "sweep", along),
            *(part(summary) for part in (_best, _outage, _robustness, _proofs)),
        ]
        blocks += [block for part in parts for block in part.blocks(figures)]
    return "\n\n".join(filter(None, [*blocks, *_data(summary)])) + "\n"


def _definitions(summary: Summary) -> str:
    quantity = summary.quantity
    return (
        f"*Median gain*: the median over scenes of the difference in {quantity.smallest} "
        f"({quantity.unit}) on the same scene. *Gain in the worst tenth*: the difference between the two "
        "cases' 10th percentiles. Nine scenes in ten reach or exceed a 10th percentile. "
        f"Numbers in brackets are {_SURE} confidence intervals."
    )


def _reached(summary: Summary) -> _Part:
    quantity = summary.quantity
    shown, count = len(summary.points.shown), len(summary.spec.points)
    words = f"The distribution over scenes of the {quantity.smallest} over the nodes at each case's pose."
    if summary.has_robust:
        words += " For robust cases it is the guaranteed value under the stated errors."
    if shown < count:
        words += f" {shown} of {count:,} combinations of swept values are shown; `summary.csv` has all."
    return _Part(
        begun(quantity.smallest),
        words,
        "distribution",
        f"CDF of the {quantity.smallest} over scenes. Each band contains the whole true curve with "
        f"{_SURE} confidence. It is drawn as far as there are values.",
        {
            f"Median, {quantity.unit}": _intervals(summary, summary.cases, "median"),
            f"Worst tenth (10th percentile), {quantity.unit}": _intervals(
                summary, summary.cases, "worst_tenth"
            ),
        },
    )


def _gained(summary: Summary) -> _Part:
    first = summary.cases[summary.cases[0].reference]
    references = {case.robust: summary.cases[case.reference] for case in summary.cases}
    words = [
        f"{'The guaranteed value' if robust else 'Each case'} is compared with "
        f"{escaped(f'{reference.phrase} ({reference.name})')} on the same scenes."
        for robust, reference in references.items()
    ]
    return _Part(
        "Gain over the level vehicle" if first.tilt_deg == 0.0 else "Gain",
        " ".join(words),
        "gain",
        "Disc: median of the gains on the same scenes; diamond: gain of the worst tenth; lines: their "
        f"{_SURE} confidence intervals; bar: 10th to 90th percentile of the gains.",
        gain_tables(summary),
    )


def gain_tables(summary: Summary) -> dict[str, Rows]:
    """Return the gains and their differences from the omnidirectional vehicle's, by each table's heading.

    Args:
        summary: of the study.
    """
    compared, unit = summary.compared, summary.quantity.unit
    partial = [case for case in compared if case.whole not in (None, case.place, case.reference)]
    return {
        f"Median of the gains, {unit}": _intervals(summary, compared, "gain_median"),
        f"Gain of the worst tenth (difference of the 10th percentiles), {unit}": _intervals(
            summary, compared, "shift_worst_tenth"
        ),
        f"10th percentile of the gains (nine scenes in ten gain this or more), {unit}": _intervals(
            summary, compared, "gain_worst_tenth"
        ),
        f"Difference from the omnidirectional vehicle's median gain, {unit}": _intervals(
            summary, partial, "difference_median"
        ),
        f"Difference from its gain in the worst tenth, {unit}": _intervals(
            summary, partial, "difference_worst_tenth"
        ),
    }


def _best(summary: Summary) -> _Part:
    robust = " Robust cases are compared with one another only." if summary.has_robust else ""
    cases = summary.cases if len(summary.cases) > 1 else ()
    return _Part(
        "How often each case is the best",
        "A case is the best in a scene if no other case exceeds its upper bound. Without a certificate "
        "its value takes the place of the bound. Each case of a tie counts, so "
        f"shares can add up to more than 100 %.{robust}",
        "best",
        "Share of scenes in which no other case is better. Each case of a tie counts.",
        {"Share of scenes, %": _shares(summary, cases, "best_share", 1)},
    )


def _outage(summary: Summary) -> _Part:
    quantity = summary.quantity
    option = "--requirement-bps-hz" if quantity.is_rate else "--requirement-db"
    cases = () if summary.requirement is None else summary.cases
    return _Part(
        "Outage",
        f"The share of scenes whose {quantity.smallest} is below the requirement. Set a requirement "
        f"with `nullpose study report {option}`.",
        "outage",
        f"Outage probability against the required {quantity.noun}.",
        {"Share of scenes that miss the requirement, %": _shares(summary, cases, "outage", 1)},
    )


def _robustness(summary: Summary) -> _Part:
    def cell(row: Any) -> str:
        worst = number(float(row["cost_worst_tenth"]), summary.quantity)
        return f"{with_interval(*three_of(row, 'cost_median'), summary.quantity)}; {worst}"

    title = f"Median; 90th percentile, {summary.quantity.unit}"
    return _Part(
        "Cost of robustness",
        f"The {summary.quantity.smallest} of the same vehicle's best pose without errors, minus "
        "the guaranteed value of its robust pose, on the same scene.",
        "robustness",
        "Loss of robust cases against the same vehicle's best pose without errors.",
        {title: _by_point(summary, summary.paired, cell)},
    )


def _proofs(summary: Summary) -> _Part:
    return _Part(
        "Proofs, gaps and time",
        "*Certified*: optimal within the requested gap. *Gap not reached*: a limit "
        "ended the proof. *Best found*: no upper bound. *Given*: the case states the pose; nothing is "
        "searched or proved. *Failed*: no pose, and the row is in no distribution. The rigour of all bounds "
        "is *floating-point*: a study keeps no certificates.",
        "effort",
        "Time of a solve, and relative gap between bound and value.",
        {
            "Rows of all combinations by status": _status_rows(summary),
            "Relative gap, and time of a solve": _effort_rows(summary),
            "Why rows failed or were not certified": _reason_rows(summary),
        },
    )


def _status_rows(summary: Summary) -> Rows:
    sums = summary.frame.groupby("case", sort=False)[[name.replace("-", "_") for name in STATUSES]].sum()
    return [
        {"case": escaped(str(case))}
        | {name.replace("_", " "): f"{count:,}" for name, count in counts.items()}
        for case, counts in sums.to_dict(orient="index").items()
    ]


def _effort_rows(summary: Summary) -> Rows:
    def cells(numbers: NDArray[np.float32], name: str, digits: str) -> dict[str, str]:
        shares = {"median": 0.5, "95 %": 0.95, "worst": 1.0}
        found = {words: quantile(numbers.astype(float).ravel(), share) for words, share in shares.items()}
        return {f"{name}: {words}": format(one, digits).replace("nan", NONE) for words, one in found.items()}

    gap, seconds = summary.values.gap, summary.values.seconds
    return [
        {"case": escaped(case.name)}
        | cells(gap[:, :, case.place], "gap", ".1e")
        | cells(seconds[:, :, case.place], "seconds", ".3g")
        | {"seconds: sum": f"{np.nansum(seconds[:, :, case.place].astype(float)):.3g}"}
        for case in summary.cases
    ]


def _reason_rows(summary: Summary) -> Rows:
    """Return why rows failed or were not certified, the most frequent first."""
    told = summary.values.reasons.most_common()
    if others := told[_MOST_REASONS:]:
        count = sum(count for _, count in others)
        told[_MOST_REASONS:] = [(("others", "", f"{len(others):,} other reasons"), count)]
    return [
        {
            "case": escaped(case),
            "status": status.replace("-", " "),
            "rows": f"{count:,}",
            "reason": escaped(
                reason if len(reason) <= _LONGEST_REASON else f"{reason[:_LONGEST_REASON]} ..."
            ),
        }
        for (case, status, reason), count in told
    ]


def _intervals(summary: Summary, cases: Sequence[ReportCase], name: str) -> Rows:
    return _by_point(summary, cases, lambda row: with_interval(*three_of(row, name), summary.quantity))


def _shares(summary: Summary, cases: Sequence[ReportCase], name: str, digits: int = 0) -> Rows:
    """Return shares and their intervals in per cent, without the sign, which the heading has."""

    def cell(row: Any) -> str:
        share, *ends = three_of(row, name)
        whole, low, high = (percent(each, digits).removesuffix(" %") for each in (share, *ends))
        return whole if math.isnan(share + sum(ends)) else f"{whole} ({low} to {high})"

    return _by_point(summary, cases, cell)


def _by_point(summary: Summary, cases: Sequence[ReportCase], cell: Callable[[Any], str]) -> Rows:
    """Return a row for each case with a cell for each combination shown."""
    heads = {point: escaped(summary.points.words(point)) or "value" for point in summary.points.shown}
    return [
        {"case": escaped(case.name)} | {head: cell(summary.row(point, case)) for point, head in heads.items()}
        for case in cases
    ]


def _data(summary: Summary) -> list[str]:
    spec = summary.spec
    gap = "by the number of nodes" if spec.gap is None else f"{spec.gap:g}"
    return [
        "## How it is calculated, and the data",
        f"{count_of(spec.n_scenes, 'scene')} from seed {spec.seed}, gap {gap}; bands of distribution "
        "functions after Dvoretzky, Kiefer and Wolfowitz, intervals of quantiles by order statistics, of "
        "shares after Clopper and Pearson, and of differences and ratios of quantiles by a bootstrap over "
        f"scenes ({replicates_of(summary.values.scenes):,} replicates, seeded; with fewer than {FEW_SCENES} "
        "scenes none is given). Quantiles are values that occur: the smallest value with at least that "
        "share of scenes at or below it.",
        "`study.csv` has a row for each scene, combination and case; `summary.csv` one for each combination "
        "and case, with every number above. In one line each, in the study's folder:",
        '```python\nframe = nullpose.study.monte_carlo.read_study(".").frame()    # pandas\n'
        'arrays = nullpose.study.monte_carlo.read_study(".").to_xarray()  # by scene, value and case\n```',
    ]
