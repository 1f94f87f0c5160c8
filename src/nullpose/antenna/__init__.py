"""The antennas: the drone's, what power they receive from each direction, and the ground's.

Physics, solver, certificate, tables and figures ask the antenna.
"""

from __future__ import annotations

from nullpose.antenna.dipoles import DIPOLE, HALF_WAVE, SHORT_DIPOLE, short_dipole
from nullpose.antenna.from_file import PATTERN, PROFILE
from nullpose.antenna.kind import (
    GROUND_ANTENNAS,
    AntennaKind,
    AnyAntenna,
    GroundAntennas,
    QuadraticAntenna,
    unit_axis,
)
from nullpose.antenna.pattern import PatternAntenna

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
