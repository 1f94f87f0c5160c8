"""What is proved of a set of values, counted and in words."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from nullpose.report.numbers import begun, short
from nullpose.solve import Rigour, Scheme, Status
from nullpose.study import SweepRow, SweepTable

__all__ = [
    "Certainty",
    "certainty_by_scheme",
    "certainty_lines",
    "rigour_lines",
    "short",
]

_PROVED = " (relative): each point is proved to be so close to its case's global optimum"


@dataclass(frozen=True, slots=True, kw_only=True)
class Certainty:
    """How many values there are of each status, and how wide the widest gap to an upper bound is.

    Args:
        certified: values with a bound within the gap asked for.
        gap_not_reached: values with a bound farther off.
        best_found: values with no bound.
        largest_relative_gap: of those with a bound; None if there are none.
    """

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
            certified=statuses.count(Status.CERTIFIED),
            gap_not_reached=statuses.count(Status.GAP_NOT_REACHED),
            best_found=statuses.count(Status.BEST_FOUND),
            largest_relative_gap=max(gaps, default=None),
        )

    @property
    def values(self) -> int:
        """How many values there are."""
        return self.certified + self.gap_not_reached + self.best_found

    @property
    def complete(self) -> bool:
        """Whether there are values, each of them certified."""
        return self.certified == self.values > 0

    def to_dict(self) -> dict[str, object]:
        """Return the counts as plain data."""
        return {
            "values": self.values,
            "certified": self.certified,
            "gap_not_reached": self.gap_not_reached,
            "best_found": self.best_found,
            "largest_relative_gap": self.largest_relative_gap,
        }

    def words(self) -> str:
        """Return the counts in words, as in ``436 values, all certified; largest relative gap 1e-6``."""
        counts = {
            "certified": self.certified,
            "with a bound farther off than asked for": self.gap_not_reached,
            "best found, with no bound": self.best_found,
        }
        named = ", ".join(f"{count} {status}" for status, count in counts.items() if count)
        shares = "all certified" if self.complete else named
        gap = self.largest_relative_gap
        widest = "" if gap is None else f"; largest relative gap {short(gap)}"
        return f"{self.values} values, {shares}{widest}"


def certainty_by_scheme(table: SweepTable) -> dict[str, Certainty]:
    """Return the certainty of each curve of a table.

    Args:
        table: a sweep.
    """
    return {scheme: Certainty.of(table.of(scheme)) for scheme in table.schemes}


def certainty_lines(table: SweepTable) -> list[str]:
    """Return what is proved of a table's curves, in a sentence for each kind of certainty that occurs.

    Args:
        table: a sweep.
    """
    curves = certainty_by_scheme(table)
    kinds: dict[str, list[str]] = {"proved": [], "open": [], "searched": []}
    for scheme, certainty in curves.items():
        kind = "searched" if certainty.best_found else "open" if certainty.gap_not_reached else "proved"
        kinds[kind].append(scheme)
    lines = []
    if kinds["proved"]:
        lines.append(
            f"{_who(kinds['proved'], curves)}certified to {_widest(kinds['proved'], curves)}{_PROVED}"
        )
    if kinds["open"]:
        missed = sum(curves[scheme].gap_not_reached for scheme in kinds["open"])
        points = sum(curves[scheme].values for scheme in kinds["open"])
        lines.append(
            f"{_who(kinds['open'], curves)}no pose exceeds the bound, but the gap asked for is not reached "
            f"at {missed} of {points} points; relative gap up to {_widest(kinds['open'], curves)}"
        )
    if kinds["searched"]:
        lines.append(f"{_who(kinds['searched'], curves)}best found by searching, nothing is proved")
    return [begun(line) for line in lines]


def rigour_lines(rigours: Iterable[tuple[str, Rigour]]) -> list[str]:
    """Return how sure bounds are, in a sentence for each rigour that occurs.

    Args:
        rigours: the label of each answer, and its rigour; labels may repeat.
    """
    labels: dict[Rigour, dict[str, None]] = {}
    for label, rigour in rigours:
        labels.setdefault(rigour, {})[label] = None
    who = {rigour: f"{', '.join(names)}: " if len(labels) > 1 else "" for rigour, names in labels.items()}
    return [f"{who[rigour]}{rigour.message}." for rigour in labels if rigour is not Rigour.NONE]


def _widest(schemes: Sequence[str], curves: Mapping[str, Certainty]) -> str:
    gaps = (curves[scheme].largest_relative_gap for scheme in schemes)
    return short(max((gap for gap in gaps if gap is not None), default=math.inf))


def _who(schemes: Sequence[str], curves: Collection[str]) -> str:
    labels = (Scheme(scheme).label.lower() for scheme in schemes)
    return "" if len(schemes) == len(curves) else f"{', '.join(labels)}: "
