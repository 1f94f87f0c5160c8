"""The vehicles that a comparison of airframes tries: by the tilt they take, then level ones with arrays."""

from __future__ import annotations

import math
from dataclasses import dataclass

from nullpose.objectives import USUAL
from nullpose.scenario import Airframe, Array, Scenario

OMNIDIRECTIONAL = "omnidirectional"  # the case that the others are measured against
STATED = "stated"  # the case that a scenario states itself, if it is none of the others


@dataclass(frozen=True, slots=True, kw_only=True)
class AirframeCase:
    """A vehicle that a comparison tries.

    Args:
        name: as in ``tilt-10``.
        label: in a table, as in "tilt 10, horizontal".
        phrase: in a sentence, as in "a 10 degree tilt with a horizontal dipole".
        airframe: how far it tilts and how its dipole is mounted.
        array: several upright dipoles in place of the one, or None.
    """

    name: str
    label: str
    phrase: str
    airframe: Airframe
    array: Array | None = None

    def on(self, scenario: Scenario) -> Scenario:
        """Return the scenario with this vehicle in place of its own.

        Args:
            scenario: any.
        """
        return scenario.model_copy(update={"airframe": self.airframe, "array": self.array})


# The vehicles that every comparison tries, by the tilt that they take. Yaw is free for all of them.
AIRFRAME_CASES: tuple[AirframeCase, ...] = tuple(
    AirframeCase(
        name=name, label=label, phrase=phrase, airframe=Airframe(tilt_max_deg=tilt_deg, mount_deg=mount_deg)
    )
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


def cases_of(scenario: Scenario) -> tuple[AirframeCase, ...]:
    """Return the vehicles to try for a scenario: its own among the usual ones, if it is none of them.

    Two vehicles are the same if they reach the same axes. Arrays are for hearing nodes only, with the paper's
    antennas at both ends; their layout and spacing are those that the scenario states, or a line with half a
    wavelength from one to the next.

    Args:
        scenario: with or without an airframe or an array.
    """
    vehicles, own, array = AIRFRAME_CASES, scenario.airframe, scenario.array or _ARRAY
    if own is not None and all(own.axis_band != case.airframe.axis_band for case in vehicles):
        tilting = sorted((*vehicles, _stated(own)), key=lambda case: case.airframe.tilt_max_rad)
        vehicles = tuple(tilting)
    if scenario.objective != USUAL or scenario.states_antennas:
        return vehicles
    arrays = (
        AirframeCase(
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
    """Return a vehicle in a sentence, as in "a 20 degree tilt with the dipole mounted at 45 degrees".

    Args:
        airframe: any.
    """
    tilt, mount = _degrees(airframe.tilt_max_rad), _degrees(airframe.mount_rad)
    vehicle = f"a {tilt} degree tilt" if airframe.tilt_max_rad else "a level vehicle"
    return f"{vehicle} with the dipole mounted at {mount} degrees"


def array_phrase(elements: int) -> str:
    """Return a vehicle with an array in a sentence.

    Args:
        elements: of the array.
    """
    return f"a level vehicle with an array of {elements} with digital combining"


def _degrees(angle_rad: float) -> str:
    return f"{round(math.degrees(angle_rad), 6):g}"


def _stated(own: Airframe) -> AirframeCase:
    label = f"file: tilt {_degrees(own.tilt_max_rad)}, mount {_degrees(own.mount_rad)}"
    phrase = f"the file's vehicle ({mounted_phrase(own)})"
    return AirframeCase(name=STATED, label=label, phrase=phrase, airframe=own)
