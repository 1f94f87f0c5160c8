"""The cases that the studio offers for a scene: the paper's schemes, vehicles, the robust pose."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass

from nullpose.errors import ScenarioError
from nullpose.scenario import Airspace, Node, Receiver, Scenario
from nullpose.solver import Scheme
from nullpose.solver.refusal import refusal
from nullpose.study import AIRFRAME_CASES, Case


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseCase:
    """One way to choose the pose.

    Args:
        label: its name in the page; every case has its own.
        scheme: how the pose is chosen.
        vehicle: the vehicle in place of the scenario's own, or None.
        robust: whether the pose is to guarantee most under the scenario's errors.
    """

    label: str
    scheme: Scheme = Scheme.OPTIMUM
    vehicle: Case | None = None
    robust: bool = False

    def on(self, scenario: Scenario) -> Scenario:
        """Return the scenario that is solved for this case: one dipole, and the vehicle that it names.

        Args:
            scenario: as stated.
        """
        return scenario.without_array if self.vehicle is None else self.vehicle.on(scenario)

    def missing(self, scenario: Scenario) -> str | None:
        """Name the reason for which the solver refuses the case for a scenario, or None.

        Args:
            scenario: as stated.
        """
        if self.robust and not scenario.is_uncertain:
            return "the scenario states no errors to guard against"
        one_antenna, refused = self.on(scenario), None
        with suppress(ScenarioError):  # a fault of the scene, and of no case
            refused = refusal(one_antenna, robust=self.robust)
        return refused or self.scheme.not_applicable(one_antenna)

    def left_out(self, scenario: Scenario) -> str:
        """List in sentences the parts of a scenario that the case leaves out.

        Args:
            scenario: as stated.
        """
        array = (
            ""
            if scenario.array is None
            else "The array of the file is not shown: this is the pose of one antenna. "
        )
        if self.robust or not scenario.is_uncertain:
            return array
        refused = ROBUST.missing(scenario)
        advice = (
            "the case Robust pose guards against them"
            if refused is None
            else f"robust poses do not allow for its {refused.partition(':')[0]}"
        )
        return f"{array}The errors of the file are left out; {advice}."


OPTIMUM = PoseCase(label="Optimum pose")
"""The case that the studio opens with."""

ROBUST = PoseCase(label="Robust pose", robust=True)
"""The case that counts on the scenario's errors."""

CASES = (
    OPTIMUM,
    *(PoseCase(label=scheme.label, scheme=scheme) for scheme in Scheme if scheme is not Scheme.OPTIMUM),
    ROBUST,
    *(PoseCase(label=f"Vehicle: {vehicle.label}", vehicle=vehicle) for vehicle in AIRFRAME_CASES),
)
"""Every case, in the order in which they are offered."""


_offered: dict[tuple[object, ...], tuple[PoseCase, ...]] = {}


def cases_of(scenario: Scenario) -> tuple[PoseCase, ...]:
    """Return the cases that the solver takes for a scenario; the optimum, if it takes none.

    Args:
        scenario: as stated.
    """
    channels = (scenario.source_channels, scenario.eavesdropper_channels, scenario.destination_channels)
    traits = (
        scenario.objective,
        scenario.airframe,
        scenario.antenna,
        scenario.is_uncertain,
        scenario.has_margins,
        frozenset(kind for each in channels if each is not None for kind in each.rows[:, 0].tolist()),
        scenario.receiver.position_error_m > 0.0,
        scenario.has_custom_channels,
        scenario.prisms is None,
        bool(scenario.jammers),
        len(scenario.terminals),
    )
    if traits not in _offered:  # asked at every step of a drag
        _offered[traits] = tuple(case for case in CASES if case.missing(scenario) is None) or (OPTIMUM,)
    return _offered[traits]


def case_named(label: str) -> PoseCase:
    """Return the case of a label.

    Args:
        label: as in the page.

    Raises:
        KeyError: there is none.
    """
    return {case.label: case for case in CASES}[label]


def new_scenario() -> Scenario:
    """Return the scene to build another in: one node, and the paper's noise and altitudes."""
    return Scenario(
        name="New scene",
        airspace=Airspace(altitude_m=(8.0, 30.0)),
        receiver=Receiver(noise_w=1e-3, reference_gain_db=0.0),
        nodes=(Node(name="S1", position_m=(0.0, 0.0, 0.0), power_w=1.0),),
    )
