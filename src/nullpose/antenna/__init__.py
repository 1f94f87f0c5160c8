"""The antennas, one file each: the drone's, what power they receive from each direction, and the ground's.

Physics, solver, certificate, tables and figures ask the antenna.
"""

from __future__ import annotations

from typing import TypeAlias

from nullpose.antenna.ground import GROUND_ANTENNAS, GroundAntennas, unit_axis
from nullpose.antenna.pattern import PatternAntenna
from nullpose.antenna.quadratic import QuadraticAntenna
from nullpose.antenna.short_dipole import SHORT_DIPOLE, short_dipole

__all__ = [
    "GROUND_ANTENNAS",
    "SHORT_DIPOLE",
    "Antenna",
    "GroundAntennas",
    "PatternAntenna",
    "QuadraticAntenna",
    "short_dipole",
    "unit_axis",
]

Antenna: TypeAlias = QuadraticAntenna | PatternAntenna
"""Any antenna of the drone."""
