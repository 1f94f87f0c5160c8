"""How certain a set of values is, counted and in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from nullpose.files import PlainTable
from nullpose.report.document import grouped
from nullpose.report.numbers import capitalised, rounded_up
from nullpose.solver import Rigour, Status
from nullpose.study import ResultRow, ResultTable
from nullpose.study.least_tilt import STEP_DEG

_ORDER = (Status.CERTIFIED, Status.GAP_NOT_REACHED, Status.BEST_FOUND)


def counted(rows: Iterable[ResultRow]) -> PlainTable:
    """Count values by status, with the widest gap of those with a bound; None if there are none."""
    rows = tuple(rows)
    counts = Counter(row.status for row in rows)
    return {
        "values": len(rows),
        "certified": counts[Status.CERTIFIED],
        "gap_not_reached": counts[Status.GAP_NOT_REACHED],
        "best_found": counts[Status.BEST_FOUND],
        "largest_relative_gap": max(
            [row.objective.relative_gap for row in rows if row.objective.relative_gap is not None],
            default=None,
        ),
    }


def _sentence(status: Status, rows: Sequence[ResultRow]) -> str:
    """Write what is true of every value of a status at least, with the widest gap."""
    counts = counted(rows)
    if rows[0].tilt is not None:
        count = f"{counts['certified']} of {counts['values']} points"
        target = f"the least tilt for {rows[0].case.reach:.7g} of the value"
        return f"{target} is proved to {STEP_DEG:g} degrees at {count}"
    gap = "none" if counts["largest_relative_gap"] is None else rounded_up(counts["largest_relative_gap"])
    return {
        Status.CERTIFIED: f"each point is certified optimal within {gap} (relative)",
        Status.GAP_NOT_REACHED: "all bounds are valid, but the requested gap is not reached at "
        f"{counts['gap_not_reached']} of {counts['values']} points; relative gap up to {gap}",
        Status.BEST_FOUND: "best found by search, no upper bound",
    }[status]


def certainty_lines(table: ResultTable) -> list[str]:
    """Write how certain the curves of a sweep are, a sentence for each kind of certainty that occurs."""
    return [capitalised(line) for line in grouped(labelled_certainty(table))]


def labelled_certainty(table: ResultTable) -> list[tuple[str, str]]:
    """Pair the label of each curve of a sweep with how certain it is, curves of one status together."""
    weakest = {name: max((row.status for row in table.of(name)), key=_ORDER.index) for name in table.names}
    sentences = {
        status: _sentence(status, [row for row in table.rows if weakest[row.name] is status])
        for status in weakest.values()
    }
    return [
        (table.of(name)[0].label, sentences[weakest[name]])
        for name in sorted(weakest, key=lambda name: _ORDER.index(weakest[name]))
    ]


def rigour_lines(rigours: Iterable[tuple[str, Rigour]]) -> list[str]:
    """Write how sure bounds are, a sentence for each rigour that occurs; labels may repeat."""
    labelled = list(rigours)
    counts, among = Counter(labelled), Counter(label for label, _ in labelled)
    sentences = []
    for (label, rigour), count in counts.items():
        share = "" if count == among[label] else f"at {count} of {among[label]} points "
        sentences.append((label, "" if rigour is Rigour.NONE else f"{share}{rigour.message}."))
    return grouped(sentences)
