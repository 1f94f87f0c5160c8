"""Shapes: they are where and as large as the physics says, and closed."""

import math

import numpy as np
import pytest
import shapely

from nullpose.antenna import SHORT_DIPOLE
from nullpose.physics import antenna_gain
from nullpose.report.geometry import outline_m
from nullpose.scenario import NoFlyZone
from nullpose.studio import drawing as meshes
from nullpose.studio.drawing import Mesh

YARD = [[1, 1], [2, 1], [2, 2], [1, 2]]


def _volume(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    return float(np.sum(np.cross(a, b) * c) / 6.0)


def _area(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def test_the_doughnut_is_the_gain() -> None:
    """Along each direction the doughnut's distance is the antenna's gain there, zero on its axis."""
    mesh, gain = meshes.pattern_mesh(SHORT_DIPOLE, 24, 32)
    distance = np.linalg.norm(mesh.vertices, axis=1)
    assert distance == pytest.approx(gain)
    away = distance > 1e-6
    gains = antenna_gain(np.zeros(3), np.array([0.0, 0.0, 1.0]), mesh.vertices[away])
    assert distance[away] == pytest.approx(gains, abs=1e-9)
    assert np.min(distance) < 1e-12
    assert _volume(mesh) > 0.0


def test_an_opening_leaves_out_its_part() -> None:
    """An opened doughnut has that much less area, none of it towards the opening's middle."""
    whole, _ = meshes.pattern_mesh(SHORT_DIPOLE, 40, 180)
    opened, _ = meshes.pattern_mesh(SHORT_DIPOLE, 40, 180, math.pi / 2, 2.0)
    assert _area(opened) == pytest.approx(0.75 * _area(whole), rel=1e-3)
    broad = opened.vertices[np.hypot(*opened.vertices[:, :2].T) > 0.1]
    off_rad = np.angle(np.exp(1j * (np.arctan2(broad[:, 1], broad[:, 0]) - 2.0)))
    assert np.abs(off_rad).min() == pytest.approx(math.pi / 4, abs=1e-6)


@pytest.mark.parametrize(
    ("mesh", "volume"),
    [
        (meshes.MARKS["nodes"], 1.0),
        (meshes.MARKS["eavesdroppers"], 2.0 * 0.64 * 2.0 / 3.0),
        (meshes.sphere_mesh(90, 180).placed(np.diag([1.0, 2.0, 3.0])), 8.0 * math.pi),
        (meshes.prism_mesh(shapely.Polygon([[0, 0], [4, 0], [4, 1], [0, 4]], [YARD]), -1.0, 1.0), 18.0),
    ],
)
def test_solids_are_closed_and_face_outwards(mesh: Mesh, volume: float) -> None:
    """The divergence theorem gives a solid's volume only if it is closed and its faces look outwards."""
    assert _volume(mesh) == pytest.approx(volume, rel=2e-3)
    assert _volume(mesh.placed(np.eye(3), [5.0, -7.0, 2.0])) == pytest.approx(volume, rel=2e-3)


def test_zones_are_drawn_where_they_forbid() -> None:
    """A point just inside a drawn zone is forbidden, for each shape."""
    for zone in (
        NoFlyZone(x_m=(0.0, 4.0), y_m=(0.0, 2.0)),
        NoFlyZone(centre_m=(1.0, 1.0), radius_m=2.0, altitude_m=(0.0, 5.0)),
        NoFlyZone(polygon_m=((0.0, 0.0), (0.0, 4.0), (1.0, 1.0), (4.0, 0.0))),
    ):
        outline = outline_m(zone)
        mesh = meshes.level_mesh(shapely.Polygon(outline), 1.0)
        assert _area(mesh) == pytest.approx(shapely.Polygon(outline).area)
        assert np.all(np.abs(zone.depth_m(mesh.vertices)) < 0.02 * 2.0 + 1e-9)
