"""What of a scenario is drawn."""

import numpy as np
import pytest
import shapely

from nullpose import load
from nullpose.scenario import Scenario
from nullpose.studio.drawing import prism_mesh
from nullpose.studio.ground import ground_shapes
from nullpose.studio.look import LIGHT
from nullpose.studio.state import State


def test_buildings_stand_on_the_ground_at_their_highest(paper: Scenario) -> None:
    """All as one mesh, which stays the same one while points move; none without buildings."""
    state = State(scenario=load("examples/town.toml"))
    shapes = ground_shapes(state, 100.0, LIGHT)
    vertices = np.asarray(shapes["/buildings/bodies"].values["vertices"])
    assert vertices.min(axis=0).tolist() == [-80.0, -40.0, 0.0]
    assert vertices.max(axis=0).tolist() == [80.0, 80.0, 25.0]
    assert 11.0 in vertices[:, 2]  # of 9 to 11
    moved = ground_shapes(state.moved(("nodes", 0), (-71, -3, 2)), 100.0, LIGHT)
    assert moved["/buildings/bodies"] is shapes["/buildings/bodies"]
    bare = ground_shapes(State(scenario=paper), 100.0, LIGHT)
    assert not any(name.startswith("/buildings") for name in bare)


def test_a_courtyard_is_open() -> None:
    """Roof and floor have the area between the outlines."""
    outline, yard = [[0, 0], [10, 0], [10, 10], [0, 10]], [[4, 4], [6, 4], [6, 7], [4, 7]]
    vertices, faces = prism_mesh(shapely.Polygon(outline, [yard]), 0.0, 5.0)
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    areas = 0.5 * np.abs(np.cross(b - a, c - a))
    assert areas[:, 2].sum() == pytest.approx(2.0 * (100.0 - 6.0))
    assert areas[:, :2].sum() == pytest.approx(5.0 * (40.0 + 10.0))
