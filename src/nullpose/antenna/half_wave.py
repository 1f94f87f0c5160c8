"""The thin half-wave dipole."""

from __future__ import annotations

import numpy as np

from nullpose.antenna.harmonics import Harmonics
from nullpose.antenna.kind import AntennaKind
from nullpose.antenna.pattern import PatternAntenna, axial_harmonics

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
