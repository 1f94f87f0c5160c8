"""The dipole's gain: eqs. 1.2 to 1.4, its integral, and its digits beside the null."""

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.antenna import GroundAntennas, QuadraticAntenna, unit_axis
from nullpose.physics import antenna_gain
from nullpose.physics.gain import dipole_gain, link_gain

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
    along = (points - position) / np.linalg.norm(points - position, axis=1)[:, None]
    cosine = along @ axis  # eq. 1.3
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


LEAKING = QuadraticAntenna(name="dipole", label="a dipole with a frame", leak=0.01)


def random_pose(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return a position, an axis, four points and a dipole's axis at each."""
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(5, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    points_m = rng.uniform([-50.0, -50.0, 0.0], [50.0, 50.0, 4.0], (4, 3))
    return rng.uniform([-20.0, -20.0, 8.0], [20.0, 20.0, 30.0]), axes[0], points_m, axes[1:]


@given(seed=SEEDS)
def test_a_dipole_takes_three_factors(seed: int) -> None:
    """Both dipoles' sin^2 and the squared cosine of the angle between their fields, no more and no less."""
    position_m, axis, points_m, axes = random_pose(seed)
    gains = dipole_gain(position_m, axis, points_m, axes)
    for gain, point_m, own in zip(gains, points_m, axes, strict=True):
        d = (point_m - position_m) / np.linalg.norm(point_m - position_m)
        one, other = np.cross(d, np.cross(d, axis)), np.cross(d, np.cross(d, own))
        cosine = one @ other / (np.linalg.norm(one) * np.linalg.norm(other))
        wanted = np.linalg.norm(one) ** 2 * np.linalg.norm(other) ** 2 * cosine**2
        assert gain == pytest.approx(wanted, abs=1e-13)


@given(seed=SEEDS)
def test_three_dipoles_across_each_other_miss_nothing(seed: int) -> None:
    """Their gains add up to that of an isotropic antenna, what leaks counted twice."""
    position_m, axis, points_m, _ = random_pose(seed)
    frame = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
    total = sum(dipole_gain(position_m, axis, points_m, np.tile(own, (4, 1)), LEAKING) for own in frame)
    whole = antenna_gain(position_m, axis, points_m, LEAKING)
    np.testing.assert_allclose(total, whole + LEAKING.leak, atol=1e-13)


@given(seed=SEEDS)
def test_each_point_has_the_antenna_it_states(seed: int) -> None:
    """Isotropic: the drone's gain; circular: half of it; dipole: its own."""
    position_m, axis, points_m, axes = random_pose(seed)
    ground = GroundAntennas(
        np.array([np.zeros(3), np.zeros(3), axes[2], axes[3]]),
        np.array([1.0, 0.5, 1.0, 1.0]),
        np.array([1.0, 1.0, 0.0, 0.0]),
    )
    gains = link_gain(position_m, axis, points_m, LEAKING, ground)
    whole = antenna_gain(position_m, axis, points_m, LEAKING)
    assert gains[:2].tolist() == [whole[0], 0.5 * whole[1]]
    assert gains[2:].tolist() == dipole_gain(position_m, axis, points_m, axes, LEAKING)[2:].tolist()


def ground_of(axes: np.ndarray, leak: float) -> GroundAntennas:
    """Return dipoles of one leak."""
    return GroundAntennas(axes, np.ones(len(axes)), np.full(len(axes), leak))


@given(seed=SEEDS, through=st.floats(0.0, 1.0))
def test_leaks_at_both_ends_are_alike(seed: int, through: float) -> None:
    """The gain is that of a mean of antennas, at most 1, and the same if drone and point change places."""
    position_m, axis, points_m, axes = random_pose(seed)
    gains = link_gain(position_m, axis, points_m, LEAKING, ground_of(axes, through))
    assert np.all((gains >= 0.0) & (gains <= 1.0 + 1e-14))
    there = QuadraticAntenna(name="dipole", label="a whip beside a mast", leak=through)
    for gain, point_m, own in zip(gains, points_m, axes, strict=True):
        back = link_gain(point_m, own, position_m[None], there, ground_of(axis[None], LEAKING.leak))
        assert back == pytest.approx([gain], abs=1e-14)


@given(seed=SEEDS)
def test_the_limits_of_a_leak(seed: int) -> None:
    """A perfect null without one, an isotropic antenna at 1, and 1 where both dipoles are seen broadside."""
    position_m, axis, points_m, axes = random_pose(seed)
    at = (position_m, axis, points_m, LEAKING)
    perfect, isotropic = link_gain(*at, ground_of(axes, 0.0)), link_gain(*at, ground_of(axes, 1.0))
    assert perfect.tolist() == dipole_gain(position_m, axis, points_m, axes, LEAKING).tolist()
    assert isotropic.tolist() == antenna_gain(*at).tolist()
    across = np.cross(points_m - position_m, axis)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    for point_m, broadside in zip(points_m, across, strict=True):
        whole = link_gain(position_m, broadside, point_m[None], LEAKING, ground_of(broadside[None], 0.3))
        assert whole == pytest.approx([1.0], abs=1e-14)
    above = ([0.0, 0.0, 30.0], [1.0, 0.0, 0.0], [[0.0, 0.0, 0.0]])  # a level dipole above an upright whip
    whip = ground_of(np.array([[0.0, 0.0, 1.0]]), 0.01)
    assert link_gain(*above, ground=whip) == pytest.approx([0.01], rel=1e-15)


@given(axis=st.lists(st.floats(-1e9, 1e9), min_size=3, max_size=3).filter(any))
def test_axes_are_of_unit_length(axis: list[float]) -> None:
    """Any direction that a file may state is brought to unit length, and none a hair longer."""
    unit = unit_axis((axis[0], axis[1], axis[2]))
    assert np.linalg.norm(unit) == pytest.approx(1.0, abs=1e-15)
    assert sum(Fraction(x) ** 2 for x in unit.tolist()) <= 1
