"""Simple polygons."""

import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, strategies as st
from matplotlib.path import Path

from nullpose.errors import ScenarioError
from nullpose.scenario import Airspace
from nullpose.scenario.polygon import MOST_CORNERS, area_m2, depth_m
from scenes import require_fault, star

SEEDS = st.integers(0, 2**32 - 1)
SQUARE = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]
L_SHAPE = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]]


def accepted(vertices: object) -> np.ndarray:
    """Returns the outline that an airspace makes of the vertices of its fence."""
    return Airspace(altitude_m=(8.0, 30.0), geofence_m=vertices).geofence_outline_m


@given(SEEDS, st.integers(3, 12))
def test_stars_are_accepted_and_run_counter_clockwise(seed: int, count: int) -> None:
    """A simple polygon is accepted in either sense of rotation, and kept counter-clockwise."""
    vertices = star(np.random.default_rng(seed), count, 30.0)
    for given_as in (vertices, vertices[::-1]):
        outline = accepted(given_as)
        assert area_m2(outline) > 0.0
        np.testing.assert_array_equal(outline, vertices)


@given(SEEDS, st.integers(3, 9))
def test_depth_agrees_with_another_test_and_with_a_walk_along_the_border(seed: int, count: int) -> None:
    """The sign is that of an independent point-in-polygon test; the size that of the nearest border point."""
    rng = np.random.default_rng(seed)
    vertices = star(rng, count, 30.0)
    points = rng.uniform(-40.0, 40.0, (50, 2))
    depths = depth_m(points, vertices)
    np.testing.assert_array_equal(depths > 0.0, Path(vertices).contains_points(points))
    share = np.linspace(0.0, 1.0, 501)[:, None, None]
    border = (vertices + share * (np.roll(vertices, -1, axis=0) - vertices)).reshape(-1, 2)
    nearest = np.linalg.norm(points[:, None] - border, axis=-1).min(axis=1)
    np.testing.assert_allclose(np.abs(depths), nearest, atol=0.1)
    assert (np.abs(depths) <= nearest + 1e-12).all()


@pytest.mark.parametrize(("vertices", "area"), [(SQUARE, 16.0), (L_SHAPE, 7.0), (SQUARE[::-1], -16.0)])
def test_area(vertices: list[list[float]], area: float) -> None:
    """The area is signed, and keeps its digits far from the origin."""
    assert area_m2(np.array(vertices)) == area
    assert area_m2(np.array(vertices) + 8e6) == area


@pytest.mark.parametrize(
    ("vertices", "path", "words"),
    [
        ([], "geofence_m", "got an empty list, must be a list of at least three"),
        ([[0, y] for y in range(5001)], "geofence_m", "got a list of 5001 values"),
        (3, "geofence_m", "must be a list of at least three"),
        ([[0, 0], [1, 0], [1]], "geofence_m[2]", "a list of two numbers [x, y]: metres east and north"),
        ([[0, 0], [1, 0], [1, "a"]], "geofence_m[2][1]", 'got the text "a"'),
        ([[0, 0], [1, 0], [1, float("nan")]], "geofence_m[2][1]", "got NaN"),
        ([[0, 0], [1, 0], [1, -2e7]], "geofence_m[2][1]", "from -1e+07"),
        ([[0, 0], [4, 0], [2, 1], [0, 0], [-2, 1]], "geofence_m", "touches itself"),
        ([[0, 0], [1, 1], [2, 2]], "geofence_m", "has no area"),
        ([[0, 0], [0, 0], [0, 0]], "geofence_m", "has no area"),
        ([[0, 0], [1e-10, 0], [0, 1e-10]], "geofence_m", "has no area"),
        ([[0, 0], [4, 4], [4, 0], [0, 4]], "geofence_m", "Self-intersection[2 2]"),
        ([[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]], "geofence_m", "crosses or touches itself"),
        ([[0, 0], [4, 0], [4, 4], [4, 2], [0, 4]], "geofence_m", "list every vertex once"),
    ],
)
def test_what_is_no_polygon(vertices: object, path: str, words: str) -> None:
    """Too few vertices, no area, and borders that meet themselves are refused, once."""
    require_fault(lambda: accepted(vertices), path, words)


def test_doubled_vertices_are_one() -> None:
    """A vertex that is given twice in a row counts once; so does the first if it ends the list."""
    for vertices in ([*SQUARE, SQUARE[0]], [SQUARE[0], *SQUARE], [*SQUARE, SQUARE[-1], SQUARE[0]]):
        np.testing.assert_array_equal(accepted(vertices), SQUARE)


def test_as_many_corners_as_are_allowed_take_little() -> None:
    """A star of 5,000 corners is judged in a few seconds and little memory, whole or with a crossing."""
    count = MOST_CORNERS
    angles = (np.arange(count) + np.random.default_rng(3).uniform(0.0, 0.9, count)) * 2.0 * np.pi / count
    radii = np.random.default_rng(4).uniform(16.0, 40.0, count)
    vertices = radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    crossed = vertices.copy()
    crossed[2000] *= -1.0
    tracemalloc.start()
    began = time.process_time()
    np.testing.assert_array_equal(accepted(vertices.tolist()), vertices)
    with pytest.raises(ScenarioError, match="crosses or touches itself"):
        accepted(crossed.tolist())
    depth_m(np.zeros((3000, 2)), vertices)
    assert time.process_time() - began < 40.0
    assert tracemalloc.get_traced_memory()[1] < 150e6
    tracemalloc.stop()
