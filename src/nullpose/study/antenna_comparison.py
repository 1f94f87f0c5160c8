"""What the antennas of a scenario change: the paper's best pose flown with them, and the best for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Unpack

from nullpose.errors import UsageError
from nullpose.objectives import Quantity
from nullpose.physics import Pose, evaluate
from nullpose.scenario import Antenna, Scenario
from nullpose.solver import Result, solve
from nullpose.solver.options import SolveKeywords, SolveOptions
from nullpose.solver.provenance import provenance

_POINTS = ("nodes", "jammers", "eavesdroppers")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AntennaComparison:
    """The same scene with the paper's antennas and with those that it states.

    Args:
        scenario: as stated.
        promised: the best pose for the paper's antennas, and its value with them.
        received: what that pose gives with the antennas stated: a power ratio, or bits/s/Hz.
        with_ground: what it gives with the ground's antennas stated and the drone's null perfect.
        with_null: what it gives with the drone's antenna stated and the paper's on the ground.
        possible: the best pose for the antennas stated.
        provenance: versions, seed and settings.
    """

    scenario: Scenario
    promised: Result
    received: float
    with_ground: float
    with_null: float
    possible: Result
    provenance: Mapping[str, Any]

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended a proof."""
        return self.promised.interrupted or self.possible.interrupted

    def to_dict(self) -> dict[str, Any]:
        """Return the comparison as plain data, the scenario as stated once."""
        told = {"promised": self.promised, "possible": self.possible}
        quantity = Quantity.of(self.scenario)
        values = {"received": self.received, "with_ground": self.with_ground, "with_null": self.with_null}
        return {
            "scenario": self.scenario.to_dict(),
            **{name: _without_scenario(result) for name, result in told.items()},
            **{name: {"value": value, "unit": quantity.unit} for name, value in values.items()},
            "provenance": dict(self.provenance),
        }


def compare_antennas(
    scenario: Scenario,
    *,
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> AntennaComparison:
    """Return what the antennas that a scenario states cost, and what the best pose for them gets back.

    Args:
        scenario: states another antenna than the paper's, on the drone or on the ground.
        on_progress: called with how many of the two solves are done.
        options: as for :func:`nullpose.solve`.

    Raises:
        UsageError: every antenna is the paper's; a bad seed or limit.
        SolveError: no pose reaches every node.
    """
    asked = SolveOptions(**options).of(scenario)
    if not scenario.states_antennas:
        raise UsageError(
            "antenna: every antenna is the paper's, a dipole with a perfect null on the drone and isotropic "
            "ones on the ground; state [antenna] null_depth_db, or antenna at a node or a jammer"
        )
    promised = solve(with_antennas(scenario, drone=False, ground=False), **options)
    if on_progress is not None:
        on_progress(1, 2)
    possible = solve(scenario, **options | {"certify": asked.certify and not promised.interrupted})
    if on_progress is not None:
        on_progress(2, 2)
    return AntennaComparison(
        scenario=scenario,
        promised=promised,
        received=_value(scenario, promised.pose),
        with_ground=_value(with_antennas(scenario, drone=False, ground=True), promised.pose),
        with_null=_value(with_antennas(scenario, drone=True, ground=False), promised.pose),
        possible=possible,
        provenance=MappingProxyType(provenance(asked.seed) | asked.settings),
    )


def with_antennas(scenario: Scenario, *, drone: bool, ground: bool) -> Scenario:
    """Return a scenario with the antennas that it states, or with the paper's of the same gain.

    Args:
        scenario: as stated.
        drone: whether to keep the drone's.
        ground: whether to keep those on the ground.
    """
    changed: dict[str, Any] = {} if drone else {"antenna": Antenna(gain_dbi=scenario.antenna_gain_dbi)}
    for kind in () if ground else _POINTS:
        changed[kind] = tuple(point.isotropic for point in getattr(scenario, kind))
    return scenario.model_copy(update=changed)


def _value(scenario: Scenario, pose: Pose) -> float:
    return Quantity.of(scenario).least(evaluate(scenario, pose))


def _without_scenario(result: Result) -> dict[str, Any]:
    return {key: value for key, value in result.to_dict().items() if key != "scenario"}
