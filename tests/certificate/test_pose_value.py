"""The value at a pose in exact arithmetic agrees with the physics."""

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st
from paper_schemes import maximum_gain_axis, zero_interference_axis
from tests.certificate.plain import dense_ratios, random_family, seeds, value_at

from nullpose.certificate.pose_value import (
    antenna_axis,
    band_excess,
    exact,
    field_offset,
    sine_cosine,
)
from nullpose.physics import Pose, antenna_axis as physics_axis, min_sinr
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family

angles = st.floats(-4.0, 4.0)


@given(x=angles)
def test_sine_and_cosine(x: float) -> None:
    """Their squares sum to one, and both agree with the usual ones to rounding."""
    sine, cosine = sine_cosine(Fraction(x))
    assert abs(sine**2 + cosine**2 - 1) < Fraction(1, 10**30)
    assert float(sine) == pytest.approx(math.sin(x), abs=2e-16)
    assert float(cosine) == pytest.approx(math.cos(x), abs=2e-16)


@given(roll=angles, pitch=angles, yaw=angles)
def test_the_axis_is_the_physics_one(roll: float, pitch: float, yaw: float) -> None:
    """Roll, pitch and yaw give the axis of paper eq. 1.1."""
    axis = [float(x) for x in antenna_axis((roll, pitch, yaw))]
    np.testing.assert_allclose(axis, physics_axis(roll, pitch, yaw), atol=1e-15)


@given(
    angle=st.floats(0.0, math.pi / 2),
    turn=angles,
    ends=st.tuples(st.floats(0.0, math.pi / 2), st.floats(0.0, math.pi / 2)).map(sorted),
    length=st.floats(0.1, 10.0),
)
def test_axes_miss_a_band_by_an_angle(angle: float, turn: float, ends: list, length: float) -> None:
    """An axis within the band misses it by nothing; another by the sine of the angle to its nearer end."""
    axis = np.array([math.sin(angle) * math.cos(turn), math.sin(angle) * math.sin(turn), math.cos(angle)])
    band = (math.cos(ends[1]) ** 2, math.cos(ends[0]) ** 2)
    for sign in (1.0, -1.0):
        excess = float(band_excess(band, exact(sign * length * axis)))
        # an end near the vertical is a square near one: its angle is known to half the digits only
        assert excess == pytest.approx(math.sin(max(angle - ends[1], ends[0] - angle)), abs=3e-8)


@given(seed=seeds, roll=angles, pitch=angles, yaw=angles)
def test_the_smallest_ratio_is_the_smallest_sinr(
    seed: int, roll: float, pitch: float, yaw: float, random_scene: Callable
) -> None:
    """The smallest ratio of the family is the paper's objective at the pose."""
    rng = np.random.default_rng(seed)
    scenario = random_scene(seed, int(rng.integers(1, 9)), int(rng.integers(0, 4)))
    pose = Pose(rng.uniform([-20.0, -20.0, 8.0], [120.0, 120.0, 30.0]), roll, pitch, yaw)
    expected = min_sinr(scenario, pose)
    axis = antenna_axis((roll, pitch, yaw))
    value = float(value_at(build_family(scenario), exact(pose.position_m), axis))
    # a node near the null has a gain that is the difference of nearly equal numbers in the physics
    assert value == pytest.approx(expected, rel=1e-13, abs=1e-12)


@given(seed=seeds)
def test_several_denominators(seed: int) -> None:
    """Each ratio takes its own denominator, as in the secrecy rates that the family allows for."""
    rng = np.random.default_rng(seed)
    family, p, u = random_family(rng, 4, 2, groups=3), np.array([1.0, 2.0, 20.0]), rng.normal(size=3)
    value = float(value_at(family, exact(p), exact(u)))
    assert value == pytest.approx(dense_ratios(family, p, u).min(), rel=1e-12)


@given(seed=seeds)
def test_offsets_from_a_field(seed: int, random_scene: Callable) -> None:
    """The paper's own axes are on their fields; one that is turned is off by the sine of the angle."""
    rng = np.random.default_rng(seed)
    scenario = random_scene(seed, 2, 1)
    p = rng.uniform([-20.0, -20.0, 10.0], [120.0, 120.0, 30.0])
    jammer = scenario.jammer_positions_m[0]
    for field, axis in (
        (AxisField.vertical(), np.array([0.0, 0.0, -2.0])),
        (AxisField.towards(jammer), zero_interference_axis(p, jammer)),
        (AxisField.broadside(*scenario.node_positions_m), maximum_gain_axis(scenario, p)),
    ):
        assert field_offset(field, exact(p), exact(axis)) < Fraction(1, 10**24)
        across = np.cross(axis, rng.normal(size=3))
        angle = float(rng.uniform(1e-3, 1.5))
        ahead, across = axis / np.linalg.norm(axis), across / np.linalg.norm(across)
        offset = field_offset(field, exact(p), exact(ahead * math.cos(angle) + across * math.sin(angle)))
        assert float(offset) == pytest.approx(math.sin(angle) ** 2, rel=1e-9)


def test_in_line_with_both_nodes_any_axis_across_the_line_is_broadside() -> None:
    """Where the field vanishes its limits are allowed, and no other axis."""
    field = AxisField.broadside([0.0, 0.0, 0.0], [0.0, 0.0, 5.0])
    above = exact(np.array([0.0, 0.0, 8.0]))
    for axis in ([1.0, 0.0, 0.0], [0.6, -0.8, 0.0], [0.0, 3.0, 0.0]):
        assert field_offset(field, above, exact(np.array(axis))) < Fraction(1, 10**24)
    assert field_offset(field, above, exact(np.array([0.0, 0.0, 1.0]))) == 1
    assert field_offset(field, above, exact(np.array([1.0, 0.0, 1.0]))) == Fraction(1, 2)
