"""The drone's antennas, one file each: what power they receive from each direction.

Physics, solver, certificate, tables and figures ask the antenna. A new antenna is a file, and its line below.
"""

from __future__ import annotations

from nullpose.antenna.quadratic import QuadraticAntenna
from nullpose.antenna.short_dipole import SHORT_DIPOLE, short_dipole

__all__ = ["ANTENNAS", "SHORT_DIPOLE", "QuadraticAntenna"]

ANTENNAS = {SHORT_DIPOLE.name: short_dipole}
"""By the kind in a scenario file: what makes the antenna from the other keys of its table."""
