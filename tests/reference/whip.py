"""The gain of a collinear whip by elevation: four half-wave elements in phase, 0.8 wavelengths apart."""

import numpy as np

_ELEMENTS, _SPACING = 4, 0.8
_FLOOR = 3e-3  # of the peak; masts and cables fill nulls


def whip_rows(step_deg: float = 5.0, over_fed: float = 1.0) -> list[list[float]]:
    """Return rows of elevation [deg] and gain [dBi] whose mean over the sphere is a given number."""
    elevation_deg = np.linspace(-90.0, 90.0, round(180.0 / step_deg) + 1)
    gain = over_fed * _shape(elevation_deg) / _mean()
    return [[float(a), float(round(b, 3))] for a, b in zip(elevation_deg, 10.0 * np.log10(gain), strict=True)]


def _shape(elevation_deg: np.ndarray) -> np.ndarray:
    sine, cosine = np.sin(np.radians(elevation_deg)), np.cos(np.radians(elevation_deg))
    element = np.cos(0.5 * np.pi * sine) / np.maximum(cosine, 1e-9)
    phases = np.exp(2j * np.pi * _SPACING * np.outer(np.arange(_ELEMENTS), sine))
    power = (element * np.abs(phases.mean(axis=0))) ** 2
    return np.asarray(_FLOOR + (1.0 - _FLOOR) * power)


def _mean() -> float:
    sine = np.linspace(-1.0, 1.0, 100_001)
    return float(np.mean(_shape(np.degrees(np.arcsin(sine)))))
