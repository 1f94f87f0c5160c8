"""The tables of a study's report, as Markdown."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from nullpose.report.numbers import NONE, escaped, number, percent, with_interval
from nullpose.report.study.cases import ReportCase, whole_of
from nullpose.report.study.statistics import quantile
from nullpose.report.study.summary import Summary, three_of
from nullpose.report.study.values import STATUSES

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
    return _by_point(summary, summary.compared, lambda row: _interval(summary, row, name))


def share_table(summary: Summary, name: str) -> str:
    """Return what part of the omnidirectional vehicle's gain each case has; empty if that is not known.

    Args:
        summary: of a study.
        name: ``share_of_median`` or ``share_of_worst_tenth``.
    """
    known = [
        case
        for case in summary.compared
        if case != whole_of(summary.cases, robust=case.robust)
        and summary.frame.loc[summary.frame["case"] == case.name, name].notna().any()
    ]
    return _by_point(summary, known, lambda row: _share(row, name, 0))


def best_table(summary: Summary) -> str:
    """Return in what share of scenes no case is better, in the same layout.

    Args:
        summary: of a study.
    """
    return _by_point(summary, summary.cases, lambda row: _share(row, "best_share", 1))


def outage_table(summary: Summary) -> str:
    """Return in what share of scenes the requirement is missed, in the same layout; empty without one.

    Args:
        summary: of a study.
    """
    cases = () if summary.requirement is None else summary.cases
    return _by_point(summary, cases, lambda row: _share(row, "outage", 1))


def cost_table(summary: Summary) -> str:
    """Return what robust cases give up, in the same layout; empty if there are none with a nominal one.

    Args:
        summary: of a study.
    """

    def cell(row: Any) -> str:
        worst = number(float(row["cost_worst_tenth"]), summary.quantity)
        return f"{_interval(summary, row, 'cost_median')}; {worst}"

    return _by_point(summary, summary.paired, cell)


def status_table(summary: Summary) -> str:
    """Return how many rows of each case have which status.

    Args:
        summary: of a study.
    """
    sums = summary.frame.groupby("case", sort=False)[[name.replace("-", "_") for name in STATUSES]].sum()
    rows = [
        [escaped(str(case)), *(f"{int(count):,}" for count in counts)] for case, *counts in sums.itertuples()
    ]
    return _table(["case", *(name.replace("-", " ") for name in STATUSES)], rows)


def effort_table(summary: Summary) -> str:
    """Return the gaps and the seconds of each case over all combinations: median, 95th percentile, worst.

    Args:
        summary: of a study.
    """
    rows = []
    for case in summary.cases:
        gap, seconds = summary.values.effort(case.place)
        gaps, times = ([quantile(each, share) for share in (0.5, 0.95, 1.0)] for each in (gap, seconds))
        cells = [f"{each:.1e}" for each in gaps]
        cells += [f"{each:.3g}" for each in (*times, float(np.nansum(seconds)))]
        rows.append([escaped(case.name), *(cell.replace("nan", NONE) for cell in cells)])
    heads = ["gap: median", "95 %", "worst", "seconds: median", "95 %", "worst", "sum"]
    return _table(["case", *heads], rows)


def reasons_table(summary: Summary) -> str:
    """Return why rows failed or were not certified, the most frequent first; empty if all went well.

    Args:
        summary: of a study.
    """
    found = summary.values.reasons.most_common(_MOST_REASONS)
    rows = [
        [escaped(case), status.replace("-", " "), f"{count:,}", escaped(_shortened(reason))]
        for (case, status, reason), count in found
    ]
    left = len(summary.values.reasons) - len(rows)
    if left > 0:
        count = sum(summary.values.reasons.values()) - sum(count for _, count in found)
        rows.append(["others", "", f"{count:,}", f"{left:,} other reasons"])
    return _table(["case", "status", "rows", "reason"], rows) if rows else ""


def _shortened(reason: str) -> str:
    return reason if len(reason) <= _LONGEST_REASON else f"{reason[:_LONGEST_REASON]} ..."


def _interval(summary: Summary, row: Any, name: str) -> str:
    return with_interval(*three_of(row, name), summary.quantity)


def _share(row: Any, name: str, digits: int) -> str:
    """Return a share and its interval in per cent, without the sign, which the heading has."""
    share, low, high = three_of(row, name)
    whole, *ends = (percent(each, digits).removesuffix(" %") for each in (share, low, high))
    return whole if math.isnan(share + low + high) else f"{whole} ({ends[0]} to {ends[1]})"


def _by_point(summary: Summary, cases: Sequence[ReportCase], cell: Cell) -> str:
    points = summary.points.shown
    heads = [escaped(summary.points.words(point)) or "value" for point in points]
    rows = [[escaped(case.name), *(cell(summary.row(point, case)) for point in points)] for case in cases]
    return _table(["case", *heads], rows) if rows else ""


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [heads, ["---", *("---:" for _ in heads[1:])], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
