"""A case: one way of solving a scene, by a scheme, a vehicle or its antennas; and the usual vehicles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from nullpose.objectives import USUAL
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Airframe, Antenna, Array, Scenario

OMNIDIRECTIONAL = "omnidirectional"  # the case that other vehicles are compared with
STATED = "stated"  # the scenario's own vehicle, if it is none of the others


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One way of solving a scene.

    Args:
        name: as in ``tilt-10``.
        label: in a table, as in "tilt 10, horizontal".
        phrase: in a sentence, as in "a 10 degree tilt with a horizontal dipole".
        scheme: how the pose is chosen.
        airframe: the vehicle in place of the scene's, or None.
        antenna: the drone's antenna in place of the scene's, or None.
        array: several upright dipoles in place of the one, or None.
        robust: whether the pose guarantees most under the scene's errors.
    """

    name: str
    label: str = ""
    phrase: str = ""
    scheme: Scheme = Scheme.OPTIMUM
    airframe: Airframe | None = None
    antenna: Antenna | None = None
    array: Array | None = None
    robust: bool = False

    @property
    def airframe_or_any(self) -> Airframe:
        """The vehicle; one that takes every attitude if it is the scene's."""
        return self.airframe or Airframe(tilt_max_deg=180.0)

    def on(self, scenario: Scenario) -> Scenario:
        """Put this case's vehicle and antenna into a scenario; an array of the scenario's goes."""
        changes: dict[str, Any] = {"array": self.array}
        if self.airframe is not None or self.array is not None:
            changes["airframe"] = self.airframe
        if self.antenna is not None:
            changes["antenna"] = self.antenna
        return scenario.model_copy(update=changes)


# The vehicles of every comparison, by the tilt that they take. Yaw is free for all of them.
AIRFRAME_CASES: tuple[Case, ...] = tuple(
    Case(name=name, label=label, phrase=phrase, airframe=Airframe(tilt_max_deg=tilt_deg, mount_deg=mount_deg))
    for name, label, phrase, tilt_deg, mount_deg in (
        ("level-vertical", "level, vertical", "a level vehicle with a vertical dipole", 0.0, 0.0),
        ("level-horizontal", "level, horizontal", "a level vehicle with a horizontal dipole", 0.0, 90.0),
        ("tilt-10", "tilt 10, horizontal", "a 10 degree tilt with a horizontal dipole", 10.0, 90.0),
        ("tilt-30", "tilt 30, horizontal", "a 30 degree tilt with a horizontal dipole", 30.0, 90.0),
        (OMNIDIRECTIONAL, "omnidirectional", "an omnidirectional vehicle", 180.0, 0.0),
    )
)

ARRAY_SIZES = (2, 4, 8)  # of the arrays that every comparison tries

_ARRAY = Array(elements=ARRAY_SIZES[0], layout="linear", spacing_wavelengths=0.5)


def cases_of(scenario: Scenario) -> tuple[Case, ...]:
    """List the vehicles to try for a scenario: its own among the usual ones, if it is none of them.

    Two vehicles are the same if they reach the same axes. Arrays are for hearing nodes only, with the paper's
    antennas at both ends; their layout and spacing are those that the scenario states, or a line with half a
    wavelength from one to the next.

    Args:
        scenario: with or without an airframe or an array.
    """
    vehicles, airframe, array = AIRFRAME_CASES, scenario.airframe, scenario.array or _ARRAY
    bands = [case.airframe_or_any.axis_band for case in vehicles]
    if airframe is not None and airframe.axis_band not in bands:
        tilting = (*vehicles, _own_vehicle(airframe))
        vehicles = tuple(sorted(tilting, key=lambda case: case.airframe_or_any.tilt_max_rad))
    if scenario.objective != USUAL or scenario.states_antennas:
        return vehicles
    arrays = (
        Case(
            name=f"array-{size}-digital",
            label=f"array of {size}, digital",
            phrase=array_phrase(size),
            airframe=AIRFRAME_CASES[0].airframe,
            array=array.model_copy(update={"elements": size}),
        )
        for size in sorted({*ARRAY_SIZES, array.elements})
    )
    return (*vehicles, *arrays)


def mounted_phrase(airframe: Airframe) -> str:
    """Write a vehicle in a sentence, as in "a 20 degree tilt with the dipole mounted at 45 degrees".

    Args:
        airframe: any.
    """
    tilt, mount = _degrees(airframe.tilt_max_rad), _degrees(airframe.mount_rad)
    vehicle = f"a {tilt} degree tilt" if airframe.tilt_max_rad else "a level vehicle"
    return f"{vehicle} with the dipole mounted at {mount} degrees"


def array_phrase(elements: int) -> str:
    """Write a vehicle with an array in a sentence.

    Args:
        elements: of the array.
    """
    return f"a level vehicle with an array of {elements} with digital combining"


def _degrees(angle_rad: float) -> str:
    return f"{round(math.degrees(angle_rad), 6):g}"


def _own_vehicle(airframe: Airframe) -> Case:
    label = f"file: tilt {_degrees(airframe.tilt_max_rad)}, mount {_degrees(airframe.mount_rad)}"
    phrase = f"the file's vehicle ({mounted_phrase(airframe)})"
    return Case(name=STATED, label=label, phrase=phrase, airframe=airframe)
