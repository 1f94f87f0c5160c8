"""The tables of a study's report, as Markdown."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from nullpose.report.numbers import number, percent, with_interval
from nullpose.report.study.cases import ReportCase, nominal_of, whole_of
from nullpose.report.study.summary import Summary
from nullpose.report.study.values import STATUSES
from nullpose.report.study.wording import escaped

__all__ = [
    "best_table",
    "cost_table",
    "effort_table",
    "gain_table",
    "level_table",
    "outage_table",
    "reasons_table",
    "share_table",
    "status_table",
]

_MOST_REASONS = 12
_LONGEST_REASON = 300  # letters

Cell = Callable[[Any], str]


def level_table(summary: Summary, name: str) -> str:
    """Return a quantile of what is reached, a row for each case, a column for each combination shown.

    Args:
        summary: of a study.
        name: ``median`` or ``worst_tenth``.
    """
    return _by_point(summary, summary.cases, lambda row: _interval(summary, row, name))


def gain_table(summary: Summary, name: str) -> str:
    """Return a statistic of the gains in the same layout; empty if there is nothing to compare.

    Args:
        summary: of a study.
        name: ``gain_median``, ``gain_worst_tenth`` or ``shift_worst_tenth``.
    """
    compared = [case for case in summary.cases if summary.reference(case) is not case]
    return _by_point(summary, compared, lambda row: _interval(summary, row, name))


def share_table(summary: Summary, name: str) -> str:
    """Return what part of the omnidirectional vehicle's gain each case has; empty if that is not known.

    Args:
        summary: of a study.
        name: ``share_of_median`` or ``share_of_worst_tenth``.
    """

    def cell(row: Any) -> str:
        share, low, high = (float(row[key]) for key in (name, f"{name}_low", f"{name}_high"))
        return _per_cent(share, low, high, 0)

    known = [
        case
        for case in summary.cases
        if case not in (summary.reference(case), whole_of(summary.cases, robust=case.robust))
        and summary.frame.loc[summary.frame["case"] == case.name, name].notna().any()
    ]
    return _by_point(summary, known, cell)


def best_table(summary: Summary) -> str:
    """Return in what share of scenes no case is better, in the same layout.

    Args:
        summary: of a study.
    """
    return _by_point(summary, summary.cases, lambda row: _share(row, "best_share"))


def outage_table(summary: Summary) -> str:
    """Return in what share of scenes the requirement is missed, in the same layout; empty without one.

    Args:
        summary: of a study.
    """
    if summary.requirement is None:
        return ""
    return _by_point(summary, summary.cases, lambda row: _share(row, "outage"))


def cost_table(summary: Summary) -> str:
    """Return what robust cases give up, in the same layout; empty if there are none with a nominal one.

    Args:
        summary: of a study.
    """
    paired = [case for case in summary.cases if nominal_of(summary.spec, summary.cases, case) is not None]

    def cell(row: Any) -> str:
        worst = number(float(row["cost_worst_tenth"]), summary.quantity)
        return f"{_interval(summary, row, 'cost_median')}; {worst}"

    return _by_point(summary, paired, cell)


def status_table(summary: Summary) -> str:
    """Return how many rows of each case have which status.

    Args:
        summary: of a study.
    """
    names = [status.replace("-", "_") for status in STATUSES]
    sums = summary.frame.groupby("case", sort=False)[names].sum()
    rows = [
        [escaped(case.name), *(f"{int(sums.loc[case.name, name]):,}" for name in names)]
        for case in summary.cases
    ]
    return _table(["case", "certified", "gap not reached", "best found", "failed"], rows)


def effort_table(summary: Summary) -> str:
    """Return the gaps and the seconds of each case over all combinations: median, 95th percentile, worst.

    Args:
        summary: of a study.
    """
    import numpy as np

    from nullpose.report.study.statistics import quantile

    rows = []
    for case in summary.cases:
        gap, seconds = (
            each[:, :, case.place].ravel().astype(float)
            for each in (summary.values.gap, summary.values.seconds)
        )
        solved = summary.values.status[:, :, case.place].ravel() != STATUSES.index("failed")
        gaps = [quantile(gap, share) for share in (0.5, 0.95, 1.0)]
        times = [quantile(seconds[solved], share) for share in (0.5, 0.95, 1.0)]
        rows.append(
            [
                escaped(case.name),
                *("\N{EN DASH}" if math.isnan(each) else f"{each:.1e}" for each in gaps),
                *("\N{EN DASH}" if math.isnan(each) else f"{each:.3g}" for each in times),
                f"{float(np.sum(seconds[solved])):.3g}",
            ]
        )
    heads = ["gap: median", "95 %", "worst", "seconds: median", "95 %", "worst", "sum"]
    return _table(["case", *heads], rows)


def reasons_table(summary: Summary) -> str:
    """Return why rows failed or were not certified, the most frequent first; empty if all went well.

    Args:
        summary: of a study.
    """
    found = summary.values.reasons.most_common(_MOST_REASONS)
    rows = [
        [escaped(case), status.replace("-", " "), f"{count:,}", escaped(_short(reason))]
        for (case, status, reason), count in found
    ]
    left = len(summary.values.reasons) - len(rows)
    if left > 0:
        count = sum(summary.values.reasons.values()) - sum(count for _, count in found)
        rows.append(["others", "", f"{count:,}", f"{left:,} other reasons"])
    return _table(["case", "status", "rows", "reason"], rows) if rows else ""


def _short(reason: str) -> str:
    return reason if len(reason) <= _LONGEST_REASON else f"{reason[:_LONGEST_REASON]} ..."


def _interval(summary: Summary, row: Any, name: str) -> str:
    return with_interval(
        float(row[name]), float(row[f"{name}_low"]), float(row[f"{name}_high"]), summary.quantity
    )


def _share(row: Any, name: str) -> str:
    share, low, high = (float(row[key]) for key in (name, f"{name}_low", f"{name}_high"))
    return _per_cent(share, low, high, 1)


def _per_cent(share: float, low: float, high: float, digits: int) -> str:
    """Return a share and its interval in per cent, without the sign, which the heading has."""
    if math.isnan(share):
        return percent(share)
    whole, *ends = (percent(each, digits).replace(" %", "") for each in (share, low, high))
    return whole if math.isnan(low) or math.isnan(high) else f"{whole} ({ends[0]} to {ends[1]})"


def _by_point(summary: Summary, cases: Sequence[ReportCase], cell: Cell) -> str:
    if not cases:
        return ""
    points = summary.points.shown
    heads = [escaped(summary.points.words(point)) or "value" for point in points]
    rows = [[escaped(case.name), *(cell(summary.row(point, case)) for point in points)] for case in cases]
    return _table(["case", *heads], rows)


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [heads, ["---", *("---:" for _ in heads[1:])], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
