"""Shapes: they are where and as large as the physics says, and closed."""

import math

import numpy as np
import pytest
from hypothesis import given, seed, strategies as st

from nullpose.antenna import SHORT_DIPOLE
from nullpose.physics import Pose, antenna_gain
from nullpose.report.geometry import outline_m
from nullpose.scenario import NoFlyZone
from nullpose.studio import meshes
from nullpose.studio.meshes import Mesh


def _volume(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    return float(np.sum(np.cross(a, b) * c) / 6.0)


def _area(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _gains(mesh: Mesh) -> np.ndarray:
    away = np.linalg.norm(mesh.vertices, axis=1) > 1e-6
    return antenna_gain(np.zeros(3), np.array([0.0, 0.0, 1.0]), mesh.vertices[away])


def test_the_doughnut_is_the_gain() -> None:
    """Along each direction the doughnut's distance is the antenna's gain there, zero on its axis."""
    mesh, gain = meshes.pattern_mesh(SHORT_DIPOLE, 2.0, 24, 32)
    distance = np.linalg.norm(mesh.vertices, axis=1)
    assert distance == pytest.approx(2.0 * gain)
    assert distance[distance > 1e-6] == pytest.approx(2.0 * _gains(mesh), abs=1e-9)
    assert np.min(distance) < 1e-12
    assert _volume(mesh) > 0.0


def test_an_opening_leaves_out_its_part() -> None:
    """An opened doughnut has that much less area, none of it towards the opening's middle."""
    whole, _ = meshes.pattern_mesh(SHORT_DIPOLE, 1.0, 40, 180)
    opened, _ = meshes.pattern_mesh(SHORT_DIPOLE, 1.0, 40, 180, open_rad=math.pi / 2, towards_rad=2.0)
    assert _area(opened) == pytest.approx(0.75 * _area(whole), rel=1e-3)
    broad = opened.vertices[np.hypot(*opened.vertices[:, :2].T) > 0.1]
    off_rad = np.angle(np.exp(1j * (np.arctan2(broad[:, 1], broad[:, 0]) - 2.0)))
    assert np.abs(off_rad).min() == pytest.approx(math.pi / 4, abs=1e-6)


@seed(0)
@given(east=st.floats(-9.0, 9.0), north=st.floats(-9.0, 9.0), up=st.floats(1.0, 9.0))
def test_the_beam_widens_by_its_angle(east: float, north: float, up: float) -> None:
    """Every way from the tip to the beam's end is at the same angle from its middle."""
    tip, end = np.array([1.0, 2.0, 10.0]), np.array([1.0 + east, 2.0 + north, 10.0 - up])
    ways = meshes.beam_mesh(tip, end, 0.1).vertices[1:] - tip
    cosines = ways @ (end - tip) / np.linalg.norm(ways, axis=1) / np.linalg.norm(end - tip)
    assert cosines == pytest.approx(np.full(len(ways), math.cos(0.1)))


@pytest.mark.parametrize(
    ("mesh", "volume"),
    [
        (meshes.MARKS["nodes"].placed(2.0), 8.0),
        (meshes.MARKS["eavesdroppers"], 2.0 * 0.64 * 2.0 / 3.0),
        (meshes.ellipsoid_mesh(np.diag([1.0, 2.0, 3.0]), 90, 180), 8.0 * math.pi),
        (meshes.prism_mesh([[0, 0], [4, 0], [4, 1], [1, 1], [1, 4], [0, 4]], -1.0, 1.0), 14.0),
    ],
)
def test_solids_are_closed_and_face_outwards(mesh: Mesh, volume: float) -> None:
    """The divergence theorem gives a solid's volume only if it is closed and its faces look outwards."""
    assert _volume(mesh) == pytest.approx(volume, rel=2e-3)
    assert _volume(mesh.placed(offset_m=[5.0, -7.0, 2.0])) == pytest.approx(volume, rel=2e-3)


@seed(0)
@given(east=st.floats(-1.0, 1.0), north=st.floats(-1.0, 1.0))
def test_the_null_line_lies_along_the_axis(east: float, north: float) -> None:
    """Both ends of the null's line are on the antenna's axis, the lower one on the ground."""
    pose = Pose.from_axis([3.0, 4.0, 8.0], [east, north, 1.0])
    ends = meshes.null_line_m(pose, 5.0)
    for end in ends:
        assert np.cross(end - pose.position_m, pose.antenna_axis) == pytest.approx(np.zeros(3), abs=1e-9)
    assert ends[1, 2] == pytest.approx(0.0, abs=1e-9)
    assert np.linalg.norm(ends[0] - pose.position_m) == pytest.approx(5.0)


def test_a_level_null_line_ends() -> None:
    """A level axis never meets the ground; its line ends all the same."""
    pose = Pose.from_axis([0.0, 0.0, 8.0], [1.0, 0.0, 0.0])
    assert np.linalg.norm(meshes.null_line_m(pose, 5.0, most_m=100.0)[1] - pose.position_m) == pytest.approx(
        100.0
    )


def test_zones_are_drawn_where_they_forbid() -> None:
    """A point just inside a drawn zone is forbidden, for each shape."""
    for zone in (
        NoFlyZone(x_m=(0.0, 4.0), y_m=(0.0, 2.0)),
        NoFlyZone(centre_m=(1.0, 1.0), radius_m=2.0, altitude_m=(0.0, 5.0)),
        NoFlyZone(polygon_m=((0.0, 0.0), (0.0, 4.0), (1.0, 1.0), (4.0, 0.0))),
    ):
        mesh = meshes.prism_mesh(outline_m(zone), 0.0, min(10.0, zone.ceiling_m))
        assert _volume(mesh) > 0.0
        assert np.all(np.abs(zone.depth_m(mesh.vertices)) < 0.02 * 2.0 + 1e-9)
