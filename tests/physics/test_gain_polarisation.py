"""The gain of a link between two antennas: patterns and polarisation."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.antenna import GroundAntennas, QuadraticAntenna, unit_axis
from nullpose.physics import antenna_gain
from nullpose.physics.gain import dipole_gain, link_gain

SEEDS = st.integers(0, 2**32 - 1)
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
