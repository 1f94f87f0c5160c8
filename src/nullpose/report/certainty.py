"""How certain a set of values is, counted and in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from nullpose.report.document import grouped
from nullpose.report.numbers import capitalised, rounded_up
from nullpose.solver import Rigour, Status
from nullpose.study import ResultRow, ResultTable


@dataclass(frozen=True, slots=True, kw_only=True)
class Certainty:
    """How many values there are of each status, and how wide the widest gap to an upper bound is.

    Args:
        values: how many there are.
        certified: values with a bound within the requested gap.
        gap_not_reached: values with a bound farther off.
        best_found: values with no bound.
        largest_relative_gap: of those with a bound; None if there are none.
    """

    values: int
    certified: int
    gap_not_reached: int
    best_found: int
    largest_relative_gap: float | None

    @classmethod
    def of(cls, rows: Iterable[ResultRow]) -> Certainty:
        """Count the rows of a sweep, of any schemes."""
        rows = tuple(rows)
        counts = Counter(row.status for row in rows)
        gaps = [row.objective.relative_gap for row in rows if row.objective.relative_gap is not None]
        return cls(
            values=len(rows),
            certified=counts[Status.CERTIFIED],
            gap_not_reached=counts[Status.GAP_NOT_REACHED],
            best_found=counts[Status.BEST_FOUND],
            largest_relative_gap=max(gaps, default=None),
        )

    @property
    def weakest(self) -> Status:
        """The status that every value has at least."""
        if self.best_found:
            return Status.BEST_FOUND
        return Status.GAP_NOT_REACHED if self.gap_not_reached else Status.CERTIFIED

    @property
    def sentence(self) -> str:
        """What is true of every value, in words, with the widest gap."""
        gap = "none" if self.largest_relative_gap is None else rounded_up(self.largest_relative_gap)
        if self.weakest is Status.BEST_FOUND:
            return "best found by search, no upper bound"
        if self.weakest is Status.CERTIFIED:
            return f"each point is certified optimal within {gap} (relative)"
        return (
            "all bounds are valid, but the requested gap is not reached at "
            f"{self.gap_not_reached} of {self.values} points; relative gap up to {gap}"
        )


def certainty_lines(table: ResultTable) -> list[str]:
    """Write how certain the curves of a sweep are, a sentence for each kind of certainty that occurs."""
    return [capitalised(line) for line in grouped(labelled_certainty(table))]


def labelled_certainty(table: ResultTable) -> list[tuple[str, str]]:
    """Pair the label of each curve of a sweep with how certain it is, curves of one status together."""
    labelled: list[tuple[str, str]] = []
    for status in Status:
        names = [name for name in table.names if Certainty.of(table.of(name)).weakest is status]
        together = Certainty.of(row for row in table.rows if row.name in names)
        labelled += [(table.of(name)[0].label, together.sentence) for name in names]
    return labelled


def rigour_lines(rigours: Iterable[tuple[str, Rigour]]) -> list[str]:
    """Write how sure bounds are, a sentence for each rigour that occurs; labels may repeat."""
    labelled = list(rigours)
    counts, among = Counter(labelled), Counter(label for label, _ in labelled)
    sentences = []
    for (label, rigour), count in counts.items():
        share = "" if count == among[label] else f"at {count} of {among[label]} points "
        sentences.append((label, "" if rigour is Rigour.NONE else f"{share}{rigour.message}."))
    return grouped(sentences)
