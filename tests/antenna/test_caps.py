"""Bounds over caps of directions hold what is in the cap."""

import numpy as np
import pytest
from tests.reference.plain_kernels import plain

from nullpose.antenna.caps import pattern_arrays
from nullpose.antenna.harmonics import Harmonics
from nullpose.solver.kernels.linear_algebra import harmonics as kernels

STEP = 2e-3  # of differences, radians

cap_bounds, gain_at, gain_jet = map(plain, (kernels.cap_bounds, kernels.gain_at, kernels.gain_jet))


def pattern(degree: int, seed: int) -> Harmonics:
    """Return a pattern with every coefficient drawn."""
    rng = np.random.default_rng(seed)
    cosine, sine = (np.tril(rng.normal(size=(degree + 1, degree + 1))) for _ in range(2))
    sine[:, 0] = 0.0
    return Harmonics(cosine, sine)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Return vectors of length one."""
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


@pytest.mark.parametrize(
    ("degree", "caps"), [(1, 30), (5, 30), (16, 15), pytest.param(30, 60, marks=pytest.mark.slow)]
)
def test_samples_are_within(degree: int, caps: int) -> None:
    """Gains and derivatives along great circles, by differences, are within a cap's bounds."""
    rng = np.random.default_rng(degree)
    harmonics = pattern(degree, degree)
    arrays, bounds = pattern_arrays(harmonics), np.empty(5)
    for _ in range(caps):
        middle, radius = unit(rng.normal(size=3)), 10.0 ** rng.uniform(-3.0, 0.6)
        cap_bounds(arrays, tuple(middle), min(radius, np.pi), bounds)
        across = unit(np.cross(middle, rng.normal(size=(200, 3))))
        angle = np.minimum(radius, np.pi) * np.sqrt(rng.uniform(size=(200, 1)))
        there = middle * np.cos(angle) + across * np.sin(angle)
        along = unit(np.cross(there, rng.normal(size=(200, 3))))
        g = [harmonics.gain(there * np.cos(k * STEP) + along * np.sin(k * STEP)) for k in range(-2, 3)]
        assert -bounds[0] <= g[2].min()
        assert g[2].max() <= bounds[1]
        slopes = np.abs(g[3] - g[1]) / (2.0 * STEP)
        bends = np.abs(g[3] - 2.0 * g[2] + g[1]) / STEP**2
        thirds = np.abs(g[4] - 2.0 * g[3] + 2.0 * g[1] - g[0]) / (2.0 * STEP**3)
        assert np.all(np.max([slopes, bends, thirds], axis=1) <= 1.01 * bounds[2:] + 1e-6)


def test_kernels_evaluate_the_pattern() -> None:
    """Gain, gradient and Hessian of the gain over squared distance are those of the harmonics."""
    harmonics = pattern(8, 3)
    arrays = pattern_arrays(harmonics)
    ways = unit(np.random.default_rng(4).normal(size=(50, 3)))
    found = [gain_at(arrays, *way) for way in ways]
    np.testing.assert_allclose(found, np.maximum(0.0, harmonics.gain(ways)), atol=1e-12)

    def over_square(r: np.ndarray) -> float:
        return float(harmonics.gain(unit(r)) / (r @ r))

    slope, bend, e = np.empty(3), np.empty((3, 3)), 1e-4 * np.eye(3)
    d = ways[0]
    gain_jet(arrays, tuple(d), slope, bend)
    by_steps = [(over_square(d + i) - over_square(d - i)) / 2e-4 for i in e]
    twice = [
        [
            (
                over_square(d + i + j)
                - over_square(d + i - j)
                - over_square(d - i + j)
                + over_square(d - i - j)
            )
            / 4e-8
            for j in e
        ]
        for i in e
    ]
    np.testing.assert_allclose(slope, by_steps, atol=1e-4)
    np.testing.assert_allclose(bend, twice, atol=1e-3)


def test_rounding_of_a_gain_is_within_the_margin() -> None:
    """Against Legendre polynomials in extended precision, of the highest degree that a file can have."""
    rng = np.random.default_rng(48)
    harmonics = Harmonics(np.zeros((49, 49)), np.zeros((49, 49)))
    harmonics.cosine[:, 0] = rng.normal(size=49)
    cosines = np.cos(rng.uniform(0.0, np.pi, size=300))
    x, series = cosines.astype(np.longdouble), [np.ones(300, np.longdouble), cosines.astype(np.longdouble)]
    for n in range(2, 49):
        series.append(((2 * n - 1) * x * series[-1] - (n - 1) * series[-2]) / n)
    norms = np.sqrt(2 * np.arange(49, dtype=np.longdouble) + 1)
    exact = np.sum(harmonics.cosine[:, 0, None] * norms[:, None] * np.array(series), axis=0)
    sines = np.sqrt(np.maximum(0.0, 1.0 - cosines**2))
    gains = harmonics.gain(np.stack([sines, np.zeros(300), cosines], axis=-1))
    off = float(np.max(np.abs(gains - exact)))
    assert 0.0 < off < 0.5 * pattern_arrays(harmonics).rounding
