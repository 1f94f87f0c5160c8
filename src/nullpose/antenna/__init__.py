"""The antennas, one file each: the drone's, what power they receive from each direction, and the ground's.

Physics, solver, certificate, tables and figures ask the antenna.
"""

from __future__ import annotations

from nullpose.antenna.from_file import PATTERN, PROFILE
from nullpose.antenna.ground import GROUND_ANTENNAS, GroundAntennas, unit_axis
from nullpose.antenna.half_wave import HALF_WAVE
from nullpose.antenna.kind import AntennaKind, AnyAntenna
from nullpose.antenna.pattern import PatternAntenna
from nullpose.antenna.quadratic import QuadraticAntenna
from nullpose.antenna.short_dipole import DIPOLE, SHORT_DIPOLE, short_dipole

__all__ = [
    "ANTENNAS",
    "GROUND_ANTENNAS",
    "SHORT_DIPOLE",
    "AntennaKind",
    "AnyAntenna",
    "GroundAntennas",
    "PatternAntenna",
    "QuadraticAntenna",
    "short_dipole",
    "unit_axis",
]

ANTENNAS: dict[str, AntennaKind] = {
    "dipole": DIPOLE,
    "half-wave": HALF_WAVE,
    "profile": PROFILE,
    "pattern": PATTERN,
}
"""By the kind in a scenario file."""
