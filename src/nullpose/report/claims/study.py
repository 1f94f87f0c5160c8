"""The data behind the claims: a sweep over the jamming level, and single solves between its points."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from nullpose.report.paper import JAMMER_POWER
from nullpose.scenario import Override, Scenario, apply_overrides
from nullpose.schemes import Scheme
from nullpose.study import SweepRow, SweepTable, sweep

__all__ = ["JammingStudy", "bound_db", "lead_range_db"]

_BISECTIONS = 12  # of a twelfth of a decade: relative precision 5e-5
_EQUIDISTANT = "maximum-gain halfway between the nodes"


class JammingStudy:
    """A scenario with one jammer, seen at any jamming level; no level is solved twice.

    It notes which rows are looked at, so that a claim can say what it rests on.

    Args:
        scenario: the paper's scenario.
        table: its sweep over the jammer's power, at ascending levels.
        seed: the random seed of the solves between the table's points.
    """

    def __init__(self, scenario: Scenario, table: SweepTable, seed: int = 0) -> None:
        self.scenario = scenario
        self.table = table
        self.seed = seed
        self._rows = {(row.scheme, row.value): row for row in table.rows}
        self._used: dict[tuple[str, float], SweepRow] = {}

    @property
    def levels(self) -> tuple[float, ...]:
        """The swept values of P_M/P, ascending."""
        return self.table.values

    def forget_uses(self) -> None:
        """Begin to note anew which rows are looked at."""
        self._used = {}

    @property
    def used(self) -> tuple[SweepRow, ...]:
        """The rows looked at since the last :meth:`forget_uses`, each once."""
        return tuple(self._used.values())

    def at(self, scheme: str, level: float) -> SweepRow:
        """Return the pose of a scheme at a jamming level, solved now if it has not been yet.

        Args:
            scheme: the scheme's name.
            level: P_M/P, a power ratio.
        """
        return self._row((scheme, float(level)), scheme, self.scenario)

    def curve(self, scheme: str) -> tuple[SweepRow, ...]:
        """Return a scheme's rows at the swept levels.

        Args:
            scheme: the scheme's name.
        """
        return tuple(self.at(scheme, row.value) for row in self.table.of(scheme))

    def equidistant_at(self, level: float) -> SweepRow:
        """Return the best maximum-gain pose among those equally far from both nodes.

        The paper's nodes lie north of one another, so that these are the positions of one northing: an
        airspace as thin as that is solved, with a proof, like any other.

        Args:
            level: P_M/P, a power ratio.
        """
        north_m = float(self.scenario.node_positions_m[:, 1].mean())
        plane = apply_overrides(self.scenario, [Override("airspace.y_m", [north_m, north_m])])
        return self._row((_EQUIDISTANT, float(level)), Scheme.MAXIMUM_GAIN, plane)

    def _row(self, key: tuple[str, float], scheme: str, scenario: Scenario) -> SweepRow:
        if key not in self._rows:
            solved = sweep(scenario, JAMMER_POWER, [key[1]], schemes=[scheme], seed=self.seed)
            self._rows[key] = solved.rows[0]
        self._used[key] = self._rows[key]
        return self._rows[key]

    def lead_db(self, scheme: str, other: str, level: float) -> float:
        """Return how far one scheme's smallest SINR is above another's, dB.

        Args:
            scheme: the scheme's name.
            other: the one it is compared with.
            level: P_M/P, a power ratio.
        """
        return self.at(scheme, level).min_sinr_db - self.at(other, level).min_sinr_db

    def lead_range_db(self, scheme: str, other: str, level: float) -> tuple[float, float]:
        """Return between which numbers the lead of one scheme's true optimum over another's is proved, dB.

        Args:
            scheme: the scheme's name.
            other: the one it is compared with.
            level: P_M/P, a power ratio.
        """
        return lead_range_db(self.at(scheme, level), self.at(other, level))

    def holds_up_to(self, condition: Callable[[float], bool]) -> float | None:
        """Return the largest level up to which a condition holds, nothing if it fails at the first.

        Every swept level below it was looked at; between the last that holds and the first that fails the
        level is bisected.

        Args:
            condition: what is asked of a level.
        """
        return _last_holding(condition, self.levels)

    def holds_from(self, condition: Callable[[float], bool]) -> float | None:
        """Return the smallest level from which a condition holds, nothing if it fails at the last.

        Args:
            condition: what is asked of a level.
        """
        return _last_holding(condition, self.levels[::-1])


def bound_db(row: SweepRow) -> float:
    """Return the upper bound of a row, dB; infinite where nothing is proved.

    Args:
        row: of a sweep.
    """
    return math.inf if row.upper_bound_db is None else row.upper_bound_db


def lead_range_db(row: SweepRow, other: SweepRow) -> tuple[float, float]:
    """Return between which numbers the lead of one row's true optimum over another's is proved, dB.

    Args:
        row: of a sweep.
        other: the one it is compared with.
    """
    return row.min_sinr_db - bound_db(other), bound_db(row) - other.min_sinr_db


def _last_holding(condition: Callable[[float], bool], levels: Sequence[float]) -> float | None:
    """Return the last level, bisected, up to which a condition was seen to hold from the first of some on."""
    holding = levels[0]
    if not condition(holding):
        return None
    for failing in levels[1:]:
        if not condition(failing):
            return _bisected(condition, holding, failing)
        holding = failing
    return holding


def _bisected(condition: Callable[[float], bool], holding: float, failing: float) -> float:
    """Return a level at which the condition was seen to hold, next to one at which it was seen to fail."""
    for _ in range(_BISECTIONS):
        middle = math.sqrt(holding * failing)
        if condition(middle):
            holding = middle
        else:
            failing = middle
    return holding
