"""What is proved of a set of values, counted and in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from nullpose.problem.schemes import Scheme
from nullpose.report.document import grouped
from nullpose.report.numbers import begun, short
from nullpose.solver import Rigour, Status
from nullpose.study import SweepRow, SweepTable


@dataclass(frozen=True, slots=True, kw_only=True)
class Certainty:
    """How many values there are of each status, and how wide the widest gap to an upper bound is.

    Args:
        values: how many there are.
        certified: values with a bound within the gap asked for.
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
    def of(cls, rows: Iterable[SweepRow]) -> Certainty:
        """Return the certainty of some rows.

        Args:
            rows: of any schemes.
        """
        rows = tuple(rows)
        statuses = [row.status for row in rows]
        gaps = [row.relative_gap for row in rows if row.relative_gap is not None]
        return cls(
            values=len(rows),
            certified=statuses.count(Status.CERTIFIED),
            gap_not_reached=statuses.count(Status.GAP_NOT_REACHED),
            best_found=statuses.count(Status.BEST_FOUND),
            largest_relative_gap=max(gaps, default=None),
        )

    @property
    def weakest(self) -> Status:
        """What can be said of each of them."""
        if self.best_found:
            return Status.BEST_FOUND
        return Status.GAP_NOT_REACHED if self.gap_not_reached else Status.CERTIFIED

    @property
    def sentence(self) -> str:
        """The same in words, with the widest gap."""
        gap = self.largest_relative_gap
        widest = "none" if gap is None else short(gap)
        sentences = {
            Status.CERTIFIED: f"each point is certified optimal within {widest} (relative)",
            Status.GAP_NOT_REACHED: "all bounds are valid, but the requested gap is not reached at "
            f"{self.gap_not_reached} of {self.values} points; relative gap up to {widest}",
            Status.BEST_FOUND: "best found by search, no upper bound",
        }
        return sentences[self.weakest]


def certainty_lines(table: SweepTable) -> list[str]:
    """Return what is proved of a table's curves, in a sentence for each kind of certainty that occurs.

    Args:
        table: a sweep.
    """
    return [begun(line) for line in grouped(labelled_certainty(table))]


def labelled_certainty(table: SweepTable) -> list[tuple[str, str]]:
    """Return the label of each of a table's curves with what is proved of it, in words.

    Args:
        table: a sweep.
    """
    said: list[tuple[str, str]] = []
    for status in Status:
        schemes = [name for name in table.schemes if Certainty.of(table.of(name)).weakest is status]
        together = Certainty.of(row for row in table.rows if row.scheme in schemes)
        said += [(Scheme(name).label, together.sentence) for name in schemes]
    return said


def rigour_lines(rigours: Iterable[tuple[str, Rigour]]) -> list[str]:
    """Return how sure bounds are, in a sentence for each rigour that occurs.

    Args:
        rigours: the label of each answer, and its rigour; labels may repeat.
    """
    said = list(rigours)
    counts, among = Counter(said), Counter(label for label, _ in said)
    sentences = []
    for (label, rigour), count in counts.items():
        share = "" if count == among[label] else f"at {count} of {among[label]} points "
        sentences.append((label, "" if rigour is Rigour.NONE else f"{share}{rigour.message}."))
    return grouped(sentences)
