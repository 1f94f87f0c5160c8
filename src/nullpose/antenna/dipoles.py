"""Dipoles: the short one (paper eq. 1.2), its null perfect or of finite depth, and the thin half-wave one."""

from __future__ import annotations

import numpy as np

from nullpose.antenna.harmonics import Harmonics
from nullpose.antenna.kind import AntennaKind, QuadraticAntenna
from nullpose.antenna.pattern import PatternAntenna, axial_harmonics

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

_DEGREE = 14  # whose terms reproduce the gain to 1e-11


def half_wave_harmonics() -> Harmonics:
    """Expand ``cos^2(pi c / 2) / (1 - c^2)``, 1 broadside, c being the cosine of the angle to z.

    Source: Balanis, Antenna Theory, eq. 4-85, squared and normalised.
    """
    harmonics = axial_harmonics(lambda c: np.cos(0.5 * np.pi * c) ** 2 / (1.0 - c * c), _DEGREE)
    harmonics.cosine[1::2] = 0.0  # the same up and down
    return harmonics


HALF_WAVE = AntennaKind(
    "a thin half-wave dipole", lambda: PatternAntenna("half-wave", "half-wave dipole", half_wave_harmonics())
)
