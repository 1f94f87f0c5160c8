"""The dipole's gain: eqs. 1.2 to 1.4, its integral, and its digits beside the null."""

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.physics import antenna_gain, elevation_cosine

SEEDS = st.integers(0, 2**32 - 1)


def exact_gain(position_m: np.ndarray, axis: np.ndarray, point_m: np.ndarray) -> Fraction:
    """Returns sin^2 of the angle between two vectors of doubles, in exact rational arithmetic."""
    u = [Fraction(float(x)) for x in axis]
    r = [Fraction(float(q)) - Fraction(float(p)) for q, p in zip(point_m, position_m, strict=True)]
    dot = sum(a * b for a, b in zip(u, r, strict=True))
    return 1 - dot**2 / (sum(a * a for a in u) * sum(b * b for b in r))


def test_gain_integrates_to_two_thirds_of_the_sphere() -> None:
    """Over all directions the gain integrates to (2/3) 4 pi: a dipole of directivity 3/2, scaled to 1."""
    # Gauss in the cosine and equal steps in the azimuth are exact for this polynomial on the sphere
    heights, weights = np.polynomial.legendre.leggauss(8)
    azimuths = np.arange(16) * (2.0 * math.pi / 16)
    across = np.sqrt(1.0 - heights**2)
    turns = [np.cos(azimuths), np.sin(azimuths)]
    directions = np.stack(
        [*(across[:, None] * turn for turn in turns), np.tile(heights[:, None], 16)], axis=-1
    )
    axis = np.array([2.0, -3.0, 6.0]) / 7.0
    gain = antenna_gain(np.zeros(3), axis, 5.0 * directions.reshape(-1, 3)).reshape(8, 16)
    integral = np.sum(weights[:, None] * gain) * (2.0 * math.pi / 16)
    assert integral == pytest.approx(4.0 * math.pi * 2.0 / 3.0, rel=1e-14)


@given(seed=SEEDS)
def test_gain_is_equations_1_2_to_1_4(seed: int, random_poses: Callable[..., tuple]) -> None:
    """The gain is sin^2 (eq. 1.4), 1 broadside, 0 along the axis, and the same for u and -u."""
    rng = np.random.default_rng(seed)
    position, axis = random_poses(rng)
    points = rng.uniform(-50.0, 50.0, (20, 3))
    gain = antenna_gain(position, axis, points)
    assert np.all((gain >= 0.0) & (gain <= 1.0 + 4e-16))
    cosine = elevation_cosine(position, axis, points)  # eq. 1.3
    along = (points - position) / np.linalg.norm(points - position, axis=1)[:, None]
    np.testing.assert_allclose(cosine, along @ axis, atol=1e-15)
    np.testing.assert_allclose(gain, np.sin(np.arccos(cosine)) ** 2, atol=1e-15)
    np.testing.assert_array_equal(gain, antenna_gain(position, -axis, points))
    broadside = np.cross(axis, rng.normal(size=3))
    ends = position + np.stack([30.0 * broadside, 20.0 * axis, -20.0 * axis])
    np.testing.assert_allclose(antenna_gain(position, axis, ends), [1.0, 0.0, 0.0], atol=1e-14)


@pytest.mark.parametrize("angle", [1e-1, 1e-3, 1e-5, 1e-7])
def test_digits_beside_the_null(angle: float) -> None:
    """Beside the null the gain is good to the rounding of the directions, not of 1 - cos^2."""
    rng = np.random.default_rng(7)
    for _ in range(50):
        position = rng.uniform([-50.0, -50.0, 8.0], [50.0, 50.0, 30.0])
        point = rng.uniform([-50.0, -50.0, 0.0], [50.0, 50.0, 5.0])
        direction = (point - position) / math.dist(point, position)
        across = np.cross(direction, rng.normal(size=3))
        axis = direction + angle * across / np.linalg.norm(across)
        axis /= np.linalg.norm(axis)
        exact = exact_gain(position, axis, point)
        error = abs(Fraction(float(antenna_gain(position, axis, point[None])[0])) / exact - 1)
        assert error < 1e-15 / angle  # an eps in a direction, seen against the angle
