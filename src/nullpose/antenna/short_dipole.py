"""The short dipole (paper eq. 1.2), its null perfect or of finite depth."""

from __future__ import annotations

from nullpose.antenna.kind import AntennaKind
from nullpose.antenna.quadratic import QuadraticAntenna

SHORT_DIPOLE = QuadraticAntenna(name="dipole", label="short dipole", leak=0.0)


def short_dipole(null_depth_db: float | None = None) -> QuadraticAntenna:
    """Make a short dipole, with a perfect null or with one that an airframe fills.

    Args:
        null_depth_db: how far the gain along the axis is below that across it, dB, not negative; None for a
            perfect null.
    """
    if null_depth_db is None:
        return SHORT_DIPOLE
    return QuadraticAntenna(
        name=SHORT_DIPOLE.name,
        label=f"{SHORT_DIPOLE.label} with a null of {null_depth_db:g} dB",
        leak=10.0 ** (-null_depth_db / 10.0),
    )


DIPOLE = AntennaKind("a short dipole", short_dipole, ("null_depth_db",))
