"""Angles and distances of a pose."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, strategies as st

from nullpose import Pose, load
from nullpose.report.geometry import axis_angle_rad, azimuth_rad, shadow_outlines_m, tilt_rad

UNIT = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 0.1)


@given(axis=UNIT, towards=UNIT)
def test_null_angle_ignores_the_sign_of_the_axis(
    axis: tuple[float, float, float], towards: tuple[float, float, float]
) -> None:
    """The angle lies in [0, pi/2], its sine squared is the antenna's gain, and -u is the same antenna."""
    position = np.array([1.0, 2.0, 3.0])
    point = position + 5.0 * np.array(towards)
    angles = [axis_angle_rad(Pose.from_axis(position, sign * np.array(axis)), point) for sign in (1, -1)]
    cosine = abs(np.dot(axis, towards)) / (np.linalg.norm(axis) * np.linalg.norm(towards))
    assert angles[0] == pytest.approx(angles[1], abs=1e-12)
    assert 0.0 <= angles[0] <= math.pi / 2
    assert math.cos(angles[0]) == pytest.approx(cosine, abs=1e-9)


def test_a_null_on_the_point_keeps_its_digits() -> None:
    """A microradian is told as one, where an arc cosine would give zero."""
    pose = Pose(np.zeros(3), roll_rad=0.0, pitch_rad=1e-6)
    assert axis_angle_rad(pose, [0.0, 0.0, -7.0]) == pytest.approx(1e-6, rel=1e-9)


@pytest.mark.parametrize(
    ("axis", "tilt_deg", "azimuth_deg"),
    [
        ((0.0, 0.0, 1.0), 0.0, 0.0),
        ((1.0, 0.0, 1.0), 45.0, 0.0),
        ((0.0, 1.0, 1.0), 45.0, 90.0),
        ((0.0, 1.0, -1.0), 45.0, -90.0),
        ((-1.0, -1.0, 0.1), 85.955, -135.0),
    ],
)
def test_tilt_and_azimuth_of_the_upper_end(
    axis: tuple[float, float, float], tilt_deg: float, azimuth_deg: float
) -> None:
    """Tilt is from the vertical, azimuth from east towards north, of the end that points up."""
    pose = Pose.from_axis(np.zeros(3), axis)
    assert math.degrees(tilt_rad(pose)) == pytest.approx(tilt_deg, abs=1e-3)
    assert math.degrees(azimuth_rad(pose)) == pytest.approx(azimuth_deg, abs=1e-9)


def test_the_axis_of_an_antenna_with_one_lobe_has_a_sign() -> None:
    """Seen from below, it leans beyond the horizontal, and a point behind it is at an obtuse angle."""
    pose = Pose.from_axis([0.0, 0.0, 10.0], np.array([0.6, 0.0, 0.8]))
    pose = Pose(pose.position_m, pose.roll_rad, pose.pitch_rad + np.pi, pose.yaw_rad)
    assert tilt_rad(pose, is_even=False) == pytest.approx(np.pi - tilt_rad(pose))
    assert azimuth_rad(pose, is_even=False) == pytest.approx(np.pi)
    assert azimuth_rad(pose) == pytest.approx(0.0, abs=1e-12)
    above = pose.position_m + np.array([0.6, 0.0, 0.8])
    assert axis_angle_rad(pose, above, is_even=False) == pytest.approx(np.pi)
    assert axis_angle_rad(pose, above) == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize("altitude_m", [0.5, 12.0, 29.1, 60.0])
def test_shadows_are_where_the_line_of_sight_is_blocked(altitude_m: float) -> None:
    """Of each point, within the frame, which cuts them; each polygon is convex."""
    scenario, frame_m = load("examples/town.toml"), np.array([[-90.0, -70.0], [80.0, 95.0]])
    points = (*scenario.nodes, *scenario.jammers)
    places_m = np.random.default_rng(1).uniform(*frame_m, (500, 2))
    at_m = np.insert(places_m, 2, altitude_m, axis=1)
    left = scenario.source_channels.blocked_gain(at_m, scenario.source_positions_m)
    for point, gain in zip(points, left.T, strict=True):
        outlines = shadow_outlines_m(scenario, point, altitude_m, frame_m)
        shapes = [shapely.Polygon(outline) for outline in outlines]
        for shape in shapes:
            assert shapely.box(*frame_m.ravel()).buffer(1e-9).contains(shape)
            assert shape.convex_hull.area == pytest.approx(shape.area)
        assert (gain < 1.0).any()
        shadow = shapely.union_all(shapes)
        np.testing.assert_array_equal(shapely.contains_xy(shadow, *places_m.T), gain < 1.0)


def test_without_buildings_there_are_no_shadows() -> None:
    """And nothing to draw."""
    scenario = load("examples/urban.toml")
    assert shadow_outlines_m(scenario, scenario.nodes[0], 30.0, np.array([[-9.0, -9.0], [9.0, 9.0]])) == []
