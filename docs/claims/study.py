"""The data behind the claims: Figure 2's curves, and single solves between their points."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from nullpose.paper import JAMMER_POWER, PrintedPoint, Reproduction, search_as_printed
from nullpose.report.numbers import rounded_up
from nullpose.scenario import Override, Scenario, apply_overrides
from nullpose.study import ResultRow, sweep

RATIO = "jamming_to_transmission_ratio"
"""Name of P_M/P in evidence."""

NOISE = 1e-9
"""In dB and in metres; what is smaller is rounding, and is stated as at most this."""

Measured = dict[str, Any]
"""Verdict, finding, evidence and what is proved, as fields of a claim."""

_BISECTIONS = 12  # of a twelfth of a decade: relative precision 5e-5
_EQUIDISTANT = "halfway between the nodes"


class Lead(NamedTuple):
    """How far one case is ahead of another, dB: as found, and between which numbers it truly is, proved."""

    least_db: float
    found_db: float
    most_db: float


class JammingStudy:
    """A scenario with one jammer, seen at any jamming level; no level is solved twice.

    It notes in ``used`` which rows are looked at, so that a claim can say what it rests on.

    Args:
        reproduction: the data of Figure 2, at ascending levels.
    """

    def __init__(self, reproduction: Reproduction) -> None:
        self.table, self.printed = reproduction.table, reproduction.printed
        self.scenario, self.levels = self.table.rows[0].scenario, self.table.values
        self.used: dict[tuple[str, float], ResultRow] = {}
        self._rows = {(row.scheme, row.value): row for row in self.table.rows}

    def at(self, scheme: str, level: float) -> ResultRow:
        """Find the pose of a scheme at a jamming level, solved now if it has not been yet.

        Args:
            scheme: the scheme's name.
            level: P_M/P, a power ratio.
        """
        return self._row(scheme, float(level), scheme, self.scenario)

    def curve(self, scheme: str) -> tuple[ResultRow, ...]:
        """Return a scheme's rows at the swept levels.

        Args:
            scheme: the scheme's name.
        """
        return tuple(self.at(scheme, row.value) for row in self.table.of(scheme))

    def equidistant_at(self, scheme: str, level: float) -> ResultRow:
        """Return a scheme's best pose among those equally far from both nodes.

        The paper's nodes lie north of one another, so that these are the positions of one northing: an
        airspace as thin as that is solved like any other.

        Args:
            scheme: the scheme's name.
            level: P_M/P, a power ratio.
        """
        return self._row(f"{scheme} {_EQUIDISTANT}", float(level), scheme, self._plane)

    @property
    def _plane(self) -> Scenario:
        north_m = float(self.scenario.node_positions_m[:, 1].mean())
        return apply_overrides(self.scenario, [Override("airspace.y_m", [north_m, north_m])])

    def printed_at(self, level: float) -> PrintedPoint:
        """Return the best position by eq. 3.5 as printed, which nothing is proved of.

        Args:
            level: P_M/P, a power ratio.
        """
        return search_as_printed(self.scenario, level)

    def _row(self, name: str, level: float, scheme: str, scenario: Scenario) -> ResultRow:
        row = self._rows.get((name, level))
        if row is None:
            row = sweep(scenario, JAMMER_POWER, [level], schemes=[scheme]).rows[0]
        self._rows[name, level] = self.used[name, level] = row
        return row

    def lead(self, scheme: str, other: str, level: float) -> Lead:
        """Measure how far one scheme's smallest SINR is above another's.

        Args:
            scheme: the scheme's name.
            other: the one it is compared with.
            level: P_M/P, a power ratio.
        """
        return lead_of(self.at(scheme, level), self.at(other, level))

    def holds_up_to(
        self, condition: Callable[[float], bool], levels: Sequence[float] | None = None
    ) -> float | None:
        """Find the last level up to which a condition holds, nothing if it fails at the first.

        Every level before it was looked at; between the last that holds and the first that fails the level is
        bisected.

        Args:
            condition: what is asked of a level.
            levels: those to look at, in order; without them the swept ones, ascending.
        """
        holding = None
        for level in self.levels if levels is None else levels:
            if not condition(level):
                return holding and _bisected(condition, holding, level)
            holding = level
        return holding

    def holds_from(self, condition: Callable[[float], bool]) -> float | None:
        """Find the smallest level from which a condition holds, nothing if it fails at the last.

        Args:
            condition: what is asked of a level.
        """
        return self.holds_up_to(condition, self.levels[::-1])


def bound_db(row: ResultRow) -> float:
    """Return the upper bound of a row, dB; infinite where nothing is proved.

    Args:
        row: of a sweep.
    """
    return math.inf if row.upper_bound_db is None else row.upper_bound_db


def lead_of(row: ResultRow, other: ResultRow) -> Lead:
    """Measure how far one row's smallest SINR is above another's.

    Args:
        row: of a sweep.
        other: the one it is compared with.
    """
    found_db = row.min_sinr_db - other.min_sinr_db
    return Lead(row.min_sinr_db - bound_db(other), found_db, bound_db(row) - other.min_sinr_db)


def _bisected(condition: Callable[[float], bool], holding: float, failing: float) -> float:
    """Return a level at which the condition was seen to hold, next to one at which it was seen to fail."""
    for _ in range(_BISECTIONS):
        middle = math.sqrt(holding * failing)
        holding, failing = (middle, failing) if condition(middle) else (holding, middle)
    return holding


def level_words(level: float | None) -> str:
    """Write a level in words.

    Args:
        level: P_M/P; None for none.
    """
    return "no swept level" if level is None else f"P_M/P = {level:.3g}"


def printed_apart_m(study: JammingStudy) -> float:
    """Measure by how much the printed form's distances to the two nodes differ at most, metres.

    Args:
        study: with the positions.
    """
    first_m, second_m = study.scenario.node_positions_m
    return max(
        abs(math.dist(point.position_m, first_m) - math.dist(point.position_m, second_m))
        for point in study.printed
    )


def at_least(number: float, digits: int = 2) -> str:
    """Return a number rounded down to so many significant digits.

    Args:
        number: any.
        digits: how many.
    """
    return f"{-float(rounded_up(-number, digits)):.{digits}g}"
