"""Which antenna axes a vehicle reaches."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field

from nullpose.scenario.rules import ByName, Choice, Limits
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import Position
from nullpose.scenario.ways import exactly_one

PRESET_TILTS_DEG = {
    "level": 0.0,
    "quadrotor": 25.0,
    "hexarotor-tilted-20": 20.0,
    "hexarotor-tilted-30": 30.0,
    "omnidirectional": 180.0,
}
"""Largest tilt of each airframe that has a name [deg]; docs/airframes.md has the sources."""

_PRESETS = ", ".join(f"{name} ({tilt_deg:g})" for name, tilt_deg in PRESET_TILTS_DEG.items())


class Airframe(Section, ways=(exactly_one("preset", "tilt_max_deg"),), unstated=("mount_deg",)):
    """How far the vehicle can tilt, and how the dipole is mounted on it.

    A dipole mounted at an angle a from the body's vertical, on a vehicle that tilts by at most t in any
    direction and yaws freely, reaches exactly the axes whose angle from the vertical lies in
    ``[max(0, a - t), min(90 deg, a + t)]``, an elevation band.

    Args:
        preset: an airframe by name, a key of ``PRESET_TILTS_DEG``; or else
        tilt_max_deg: largest angle between the body's vertical and the world's [deg].
        mount_deg: angle between the dipole and the body's vertical [deg].
        speed_max_m_s: the largest speed [m/s], in a scene in motion.
        start_m, end_m: where it is at the first and at the last instant of such a scene [m], (3,).
    """

    preset: Annotated[str, Choice("a preset", tuple(PRESET_TILTS_DEG))] | None = optional(
        f"An airframe by name, with its largest tilt in degrees: {_PRESETS}. Either this or tilt_max_deg.",
        "level",
    )
    tilt_max_deg: (
        Annotated[
            float,
            Limits("an angle in degrees", 0.0, 180.0, "a tilt below 0 reaches no axis; 180 is any attitude"),
        ]
        | None
    ) = optional("Largest tilt of the vehicle from the horizontal, in degrees. Either this or preset.", 10.0)
    mount_deg: Annotated[
        float, Limits("an angle in degrees", 0.0, 90.0, "0 is along the body's vertical, 90 across it")
    ] = Field(
        default=0.0,
        description="Angle between the dipole and the body's vertical, in degrees: 0 upright, 90 flat.",
        examples=[90.0],
    )
    speed_max_m_s: (
        Annotated[float, Limits("a speed in m/s", 0.0, 1e5, "a speed is never negative; 36 km/h are 10 m/s")]
        | None
    ) = optional("Largest speed of the vehicle, in metres a second. In a scene with [time].", 5.0)
    start_m: Position | None = optional(
        "Where the vehicle is at t = 0, in metres: [east, north, up]. In a scene with [time].",
        [0.0, 0.0, 10.0],
    )
    end_m: Position | None = optional(
        "Where it is at the last instant, in metres: [east, north, up]. In a scene with [time].",
        [50.0, 0.0, 10.0],
    )

    @property
    def tilt_max_rad(self) -> float:
        """Largest angle between the body's vertical and the world's, however it was stated [rad]."""
        return math.radians(self._tilt_deg)

    @property
    def mount_rad(self) -> float:
        """Angle between the dipole and the body's vertical [rad]."""
        return math.radians(self.mount_deg)

    @property
    def axis_band(self) -> tuple[float, float]:
        """Least and greatest squared vertical component ``u_z^2`` of the unit axes that are reached.

        ``cos^2`` of the greatest and of the least angle from the vertical; exactly 0.0 at 90 degrees and 1.0
        at 0, and two equal numbers where only one angle is reached.
        """
        ends_deg = min(90.0, self.mount_deg + self._tilt_deg), max(0.0, self.mount_deg - self._tilt_deg)
        low, high = (0.0 if end == 90.0 else math.cos(math.radians(end)) ** 2 for end in ends_deg)
        return low, high

    @property
    def is_omnidirectional(self) -> bool:
        """Whether every axis is reached."""
        return self.axis_band == (0.0, 1.0)

    @property
    def _tilt_deg(self) -> float:
        return PRESET_TILTS_DEG[self.preset] if self.preset else self.tilt_max_deg or 0.0


NamedAirframe = Annotated[
    Airframe,
    ByName("a table with tilt_max_deg, or a name", {name: {"preset": name} for name in PRESET_TILTS_DEG}),
]
"""The type of a key ``airframe``: a table, or the name of a preset."""
