"""Spherical harmonics of power patterns."""

import numpy as np
import pytest

from nullpose.antenna.harmonics import Harmonics, directions, fit
from nullpose.antenna.table import PatternTable

THETA, PHI = np.arange(0.0, 181.0, 5.0), np.arange(0.0, 360.0, 5.0)


def any_harmonics(degree: int, seed: int = 1) -> Harmonics:
    """Return harmonics with every coefficient drawn."""
    rng = np.random.default_rng(seed)
    cosine, sine = (np.tril(rng.normal(size=(degree + 1, degree + 1))) for _ in range(2))
    sine[:, 0] = 0.0
    return Harmonics(cosine, sine)


def table_of(harmonics: Harmonics) -> PatternTable:
    """Return the pattern on a grid of 5 degrees."""
    return PatternTable(theta_deg=THETA, phi_deg=PHI, gain=harmonics.gain(directions(THETA, PHI)))


@pytest.mark.parametrize("degree", [0, 1, 4, 12, 30])
def test_what_a_grid_supports_is_found_again(degree: int) -> None:
    """A pattern on a grid that supports its degree is the same pattern."""
    wanted = any_harmonics(degree)
    found = fit(table_of(wanted), max(degree, 2))
    off_grid = directions(np.linspace(1.0, 179.0, 23), np.linspace(0.5, 359.0, 31))
    np.testing.assert_allclose(found.gain(off_grid), wanted.gain(off_grid), atol=1e-9 * (1 + degree) ** 2)


def test_a_field_tells_its_power() -> None:
    """A table with phases gives the power pattern of its field: of a short dipole along y, ``1 - y^2``."""
    theta, phi = np.radians(THETA)[:, None], np.radians(PHI)
    field = np.stack([np.cos(theta) * np.sin(phi), np.cos(phi) + 0.0 * theta], axis=-1).astype(complex)
    table = PatternTable(theta_deg=THETA, phi_deg=PHI, gain=np.sum(np.abs(field) ** 2, axis=-1), field=field)
    somewhere = directions([20.0, 77.0], [10.0, 100.0, 200.0])
    np.testing.assert_allclose(fit(table, 6).gain(somewhere), 1.0 - somewhere[..., 1] ** 2, atol=1e-9)


def test_on_a_grid_and_by_direction() -> None:
    """Both ways to evaluate agree."""
    harmonics = any_harmonics(7)
    theta, phi = np.linspace(0.0, np.pi, 9), np.linspace(0.0, 6.0, 8)
    by_direction = harmonics.gain(directions(np.degrees(theta), np.degrees(phi)))
    np.testing.assert_allclose(harmonics.on_grid(theta, phi), by_direction, atol=1e-10)


def test_mean_square_and_mean() -> None:
    """The first coefficient is the mean over the sphere, and the spectrum the mean square by degree."""
    harmonics = any_harmonics(5)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    gain = harmonics.on_grid(np.arccos(nodes), np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False))
    assert np.mean(gain, axis=1) @ weights / 2.0 == pytest.approx(harmonics.cosine[0, 0], abs=1e-12)
    assert np.mean(gain**2, axis=1) @ weights / 2.0 == pytest.approx(harmonics.spectrum.sum(), rel=1e-12)
