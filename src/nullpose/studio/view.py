"""What one user looks at: a scenario and the cases chosen for it. Immutable; every change makes another."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import Fault, ScenarioError
from nullpose.physics import from_db, to_db
from nullpose.report.numbers import MINUS
from nullpose.scenario import GroundPoint, Scenario
from nullpose.studio.case import OPTIMUM, Case, cases_of
from nullpose.studio.toml_like import toml_like

Kind = Literal["nodes", "jammers", "eavesdroppers", "no_fly"]
"""A list of the scenario, the last one being that of its airspace."""
Key = tuple[Kind, int]
"""A ground point or a no-fly zone: which list of the scenario it is in, and where there."""

KINDS: tuple[Kind, ...] = ("nodes", "jammers", "eavesdroppers", "no_fly")
_ROUND_M = 3  # digits of a metre that a dragged position keeps
_ROUND_DB = 6  # digits of a decibel that a typed power keeps, so that the field has all of them

POWER_DB = (-30.0, 40.0)
"""Range of the strongest jammer's power over the nodes' that a page offers, dB."""


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """A scenario and the cases chosen for it.

    Args:
        scenario: the scene.
        case: how its pose is chosen.
        compared: a second case to set beside it, or None.
        text: of the file that the scenario is from, which may be out of date; empty without a file.
        opened: how many other scenes were opened before this one.
    """

    scenario: Scenario
    case: Case = OPTIMUM
    compared: Case | None = None
    text: str = ""
    opened: int = 0

    @property
    def cases(self) -> tuple[Case, ...]:
        """The cases to solve, the chosen one first."""
        return (self.case,) if self.compared is None else (self.case, self.compared)

    def points(self) -> Iterator[tuple[Key, GroundPoint]]:
        """Yield every ground point with its key."""
        for kind in KINDS[:-1]:
            for index, point in enumerate(self.members(kind)):
                yield (kind, index), point

    def members(self, kind: Kind) -> tuple[Any, ...]:
        """Return a list of the scenario.

        Args:
            kind: which.
        """
        return tuple(getattr(self.scenario.airspace if kind == "no_fly" else self.scenario, kind))

    def with_members(self, kind: Kind, members: Iterable[Any]) -> View:
        """Return the view with another list in the scenario.

        Args:
            kind: which.
            members: the points or zones that it is to hold.

        Raises:
            ScenarioError: the scenario would be faulty.
        """
        update: dict[str, Any] = {kind: tuple(members)}
        if kind == "no_fly":
            update = {"airspace": self.scenario.airspace.model_copy(update=update)}
        return self.with_scenario(self.scenario.model_copy(update=update))

    def moved(self, key: Key, position_m: ArrayLike) -> View:
        """Return the view with one ground point elsewhere, to a millimetre.

        Args:
            key: which point.
            position_m: (3,) metres.

        Raises:
            ScenarioError: the scenario would be faulty.
        """
        kind, index = key
        east, north, up = np.round(np.asarray(position_m, dtype=float), _ROUND_M).tolist()
        points = list(self.members(kind))
        points[index] = points[index].model_copy(update={"position_m": (east, north, up)})
        return self.with_members(kind, points)

    @property
    def power_db(self) -> float | None:
        """Power of the strongest jammer over that of the strongest transmitter to be heard, dB.

        None without jammers, or if either has no power.
        """
        heard = self.scenario.nodes if self.scenario.transmitter is None else (self.scenario.transmitter,)
        reference_w = max(one.transmit_power_w for one in heard)
        strongest_w = max((jammer.transmit_power_w for jammer in self.scenario.jammers), default=0.0)
        if strongest_w <= 0.0 or reference_w <= 0.0:
            return None
        return float(to_db(strongest_w / reference_w))

    def with_power_db(self, power_db: float) -> View:
        """Return the view with all jammers' powers scaled alike, so that the strongest has this one.

        Args:
            power_db: power of the strongest jammer over that of the strongest transmitter, dB.

        Raises:
            ScenarioError: the scenario would be faulty.
        """
        now_db = self.power_db
        if now_db is None or math.isclose(now_db, power_db, abs_tol=1e-9):
            return self
        by_db = power_db - now_db
        powers = (  # each in the unit that it is stated in
            {"power_w": float(f"{one.transmit_power_w * float(from_db(by_db)):.12g}")}
            if one.power_dbm is None
            else {"power_dbm": float(f"{one.power_dbm + by_db:.12g}")}
            for one in self.scenario.jammers
        )
        jammers = tuple(
            one.model_copy(update=power) for one, power in zip(self.scenario.jammers, powers, strict=True)
        )
        return replace(self, scenario=self.scenario.model_copy(update={"jammers": jammers}))

    @property
    def power_text(self) -> str:
        """The power of the strongest jammer in dB as a text, to a millionth; empty without one."""
        return "" if self.power_db is None else f"{round(self.power_db, _ROUND_DB) + 0.0:.9g}"

    def with_power_text(self, text: str) -> View:
        """Return the view with the jamming power that was typed; see :meth:`with_power_db`.

        Args:
            text: a number of decibels, in the range that a page offers.

        Raises:
            ScenarioError: it is no number, or out of that range.
        """
        typed, (low_db, high_db) = text.strip().replace(MINUS, "-"), POWER_DB
        if typed == self.power_text:
            return self
        with suppress(ValueError):
            power_db = round(float(typed), _ROUND_DB)
            if low_db <= power_db <= high_db:
                return self.with_power_db(power_db)
        allowed = f"allowed: a number from {low_db:g} to {high_db:g}, as in 12.5 or 1e1"
        told = f"given {typed or 'nothing'}; {allowed}; it stays at {self.power_text or 'none'}"
        raise ScenarioError([Fault("jamming power, dB", told)])

    def with_scenario(self, scenario: Scenario, text: str | None = None) -> View:
        """Return the view of another scenario, the cases kept where they have a meaning for it.

        Args:
            scenario: the new one.
            text: of the file that it is from; None if it is still the one of this view.
        """
        allowed = cases_of(scenario)
        case = self.case if self.case in allowed else allowed[0]
        compared = self.compared if self.compared in allowed and self.compared != case else None
        if text is None:
            return replace(self, scenario=scenario, case=case, compared=compared)
        return View(scenario=scenario, case=case, compared=compared, text=text, opened=self.opened + 1)

    @property
    def written(self) -> View:
        """The view with the text of its file, if it has one, brought up to date."""
        return replace(self, text=self.text and toml_like(self.text, self.scenario))

    def with_case(self, case: Case) -> View:
        """Return the view with another case chosen.

        Args:
            case: one that has a meaning for the scenario.
        """
        return replace(self, case=case, compared=None if self.compared == case else self.compared)

    def with_compared(self, case: Case | None) -> View:
        """Return the view with another case set beside the chosen one, or none.

        Args:
            case: the second case; the chosen one counts as none.
        """
        return replace(self, compared=None if case == self.case else case)
