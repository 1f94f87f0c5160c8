"""The antennas, one file each: the drone's, what power they receive from each direction, and the ground's.

Physics, solver, certificate, tables and figures ask the antenna. A new antenna is a file, and its line below.
"""

from __future__ import annotations

from nullpose.antenna.ground import GROUND_ANTENNAS, GroundAntennas, unit_axis
from nullpose.antenna.quadratic import QuadraticAntenna
from nullpose.antenna.short_dipole import SHORT_DIPOLE, short_dipole

__all__ = [
    "ANTENNAS",
    "GROUND_ANTENNAS",
    "SHORT_DIPOLE",
    "GroundAntennas",
    "QuadraticAntenna",
    "unit_axis",
]

ANTENNAS = {SHORT_DIPOLE.name: short_dipole}
"""By the kind in a scenario file: what makes the antenna from the other keys of its table."""
