"""The drone's antennas, one file each: what power they receive from each direction.

Physics, solver, certificate, tables and figures ask the antenna. A new antenna is a record in a file, and its
name in the list below.
"""

from __future__ import annotations

from nullpose.antenna.quadratic import QuadraticAntenna
from nullpose.antenna.short_dipole import SHORT_DIPOLE

__all__ = ["RECORDS", "SHORT_DIPOLE", "QuadraticAntenna"]

RECORDS = {record.name: record for record in (SHORT_DIPOLE,)}
