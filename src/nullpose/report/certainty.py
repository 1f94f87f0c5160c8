"""How certain a set of values is, counted and in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from nullpose.files import PlainTable
from nullpose.report.document import grouped
from nullpose.report.numbers import capitalised, rounded_up
from nullpose.solver import Rigour, Status
from nullpose.study import ResultRow, ResultTable


def counted(rows: Iterable[ResultRow]) -> PlainTable:
    """Count values by status, with the widest gap of those with a bound; None if there are none."""
    rows = tuple(rows)
    counts = Counter(row.status for row in rows)
    gaps = [row.objective.relative_gap for row in rows if row.objective.relative_gap is not None]
    return {
        "values": len(rows),
        "certified": counts[Status.CERTIFIED],
        "gap_not_reached": counts[Status.GAP_NOT_REACHED],
        "best_found": counts[Status.BEST_FOUND],
        "largest_relative_gap": max(gaps, default=None),
    }


def _weakest(counts: PlainTable) -> str:
    """Name the status that every value has at least."""
    return next((key for key in ("best_found", "gap_not_reached") if counts[key]), "certified")


def _sentence(counts: PlainTable) -> str:
    """Write what is true of every value, with the widest gap."""
    gap = "none" if counts["largest_relative_gap"] is None else rounded_up(counts["largest_relative_gap"])
    sentences = {
        "best_found": "best found by search, no upper bound",
        "certified": f"each point is certified optimal within {gap} (relative)",
        "gap_not_reached": "all bounds are valid, but the requested gap is not reached at "
        f"{counts['gap_not_reached']} of {counts['values']} points; relative gap up to {gap}",
    }
    return sentences[_weakest(counts)]


def certainty_lines(table: ResultTable) -> list[str]:
    """Write how certain the curves of a sweep are, a sentence for each kind of certainty that occurs."""
    return [capitalised(line) for line in grouped(labelled_certainty(table))]


def labelled_certainty(table: ResultTable) -> list[tuple[str, str]]:
    """Pair the label of each curve of a sweep with how certain it is, curves of one status together."""
    weakest = {name: _weakest(counted(table.of(name))) for name in table.names}
    sentences = {
        status: _sentence(counted(row for row in table.rows if weakest[row.name] == status))
        for status in weakest.values()
    }
    order = ("certified", "gap_not_reached", "best_found")
    names = sorted(weakest, key=lambda name: order.index(weakest[name]))
    return [(table.of(name)[0].label, sentences[weakest[name]]) for name in names]


def rigour_lines(rigours: Iterable[tuple[str, Rigour]]) -> list[str]:
    """Write how sure bounds are, a sentence for each rigour that occurs; labels may repeat."""
    labelled = list(rigours)
    counts, among = Counter(labelled), Counter(label for label, _ in labelled)
    sentences = []
    for (label, rigour), count in counts.items():
        share = "" if count == among[label] else f"at {count} of {among[label]} points "
        sentences.append((label, "" if rigour is Rigour.NONE else f"{share}{rigour.message}."))
    return grouped(sentences)
