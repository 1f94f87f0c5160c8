"""Antennas with a pattern."""

import numpy as np
import pytest

from nullpose.antenna import PatternAntenna
from nullpose.antenna.dipoles import half_wave_harmonics
from nullpose.antenna.harmonics import directions
from nullpose.antenna.pattern import harmonics_of_rows, normalised, profile_harmonics, table_harmonics
from nullpose.antenna.table import PatternTable

THETA, PHI = np.arange(0.0, 181.0), np.arange(0.0, 360.0)


def closed_form(ways: np.ndarray) -> np.ndarray:
    """Return a smooth pattern of degree 4 without symmetry."""
    x, y, z = np.moveaxis(ways, -1, 0)
    return (1.0 - z**2) * (1.0 + 0.3 * x + 0.2 * y * z) + 0.01 + 0.05 * x**2 * z**2


def test_a_table_in_decibels_is_the_closed_form() -> None:
    """Steps of 1 degree and two decimals of dB give the pattern to 1e-3, at its own degree."""
    gain = 10.0 ** (np.round(10.0 * np.log10(closed_form(directions(THETA, PHI))), 2) / 10.0)
    harmonics = table_harmonics(PatternTable(theta_deg=THETA, phi_deg=PHI, gain=gain))
    off_grid = directions(THETA[:-1] + 0.4, PHI + 0.3)
    assert harmonics.degree == 4
    np.testing.assert_allclose(harmonics.gain(off_grid), closed_form(off_grid), atol=1e-3)


def test_half_wave() -> None:
    """The half-wave dipole is its formula, 1 broadside, to 1e-10; a fine profile of it is it to 1e-4."""
    theta = np.linspace(0.01, np.pi - 0.01, 500)
    formula = (np.cos(0.5 * np.pi * np.cos(theta)) / np.sin(theta)) ** 2
    np.testing.assert_allclose(half_wave_harmonics().on_grid(theta, np.zeros(1))[:, 0], formula, atol=1e-10)
    angle = np.linspace(0.0, 180.0, 1801)
    theta = np.radians(np.clip(angle, 1e-6, 180.0 - 1e-6))
    gain = (np.cos(0.5 * np.pi * np.cos(theta)) / np.sin(theta)) ** 2
    found = profile_harmonics(angle, gain)
    assert found.is_axisymmetric
    np.testing.assert_allclose(found.on_grid(theta, np.zeros(1))[:, 0], gain, atol=4e-4)


def test_rows_round_trip() -> None:
    """What a result tells of a pattern is the pattern."""
    antenna = PatternAntenna("pattern", "any", half_wave_harmonics())
    assert PatternAntenna("pattern", "any", harmonics_of_rows(antenna.harmonics.rows())) == antenna


def test_no_gain_is_above_the_peak_and_none_below_zero() -> None:
    """The peak bounds all directions; what is read is lifted where the fit would be negative."""
    theta, phi = THETA[::3], PHI[::3]
    gain = np.maximum(0.0, closed_form(directions(theta, phi)) - 0.2)
    table = PatternTable(theta_deg=theta, phi_deg=phi, gain=gain)
    antenna = PatternAntenna("pattern", "any", table_harmonics(table))
    everywhere = antenna.gain(directions(np.linspace(0.0, 180.0, 350), np.linspace(0.0, 360.0, 450)))
    assert everywhere.min() >= 0.0
    assert everywhere.max() <= antenna.peak
    assert normalised(antenna.harmonics).gain(directions(THETA, PHI)).max() == pytest.approx(1.0)
