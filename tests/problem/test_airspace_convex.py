"""Simple polygons cut into convex parts: areas add up, and every point is where it was."""

import time

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from nullpose.problem.airspace import convex_parts, hull_and_pockets
from nullpose.scenario.polygon import area_m2, depth_m
from scenes import star

SEEDS = st.integers(0, 2**32 - 1)

SHAPES = {
    "triangle": [(0, 0), (4, 0), (1, 3)],
    "square": [(0, 0), (2, 0), (2, 2), (0, 2)],
    "square with a vertex in each side": [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)],
    "arrow": [(0, 0), (4, 2), (0, 4), (1, 2)],
    "L": [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)],
    "U": [(0, 0), (5, 0), (5, 4), (4, 4), (4, 1), (1, 1), (1, 4), (0, 4)],
    "T with vertices in line": [(0, 0), (6, 0), (6, 1), (4, 1), (4, 4), (3, 4), (2, 4), (2, 1), (0, 1)],
    "comb": [(0, 0), (7, 0), (7, 5), (6, 1), (5, 5), (4, 1), (3, 5), (2, 1), (1, 5), (0, 1)],
    "spiral": [
        *((0, 0), (7, 0), (7, 7), (1, 7), (1, 2), (5, 2), (5, 5), (3, 5)),
        *((3, 4), (4, 4), (4, 3), (2, 3), (2, 6), (6, 6), (6, 1), (0, 1)),
    ],
    "sliver": [(0, 0), (100, 0), (100, 1e-3), (50, 5e-4), (0, 1e-3)],
}


def turns(polygon: np.ndarray) -> np.ndarray:
    """Returns the cross product of each two neighbouring edges: none is negative if it is convex."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    after = np.roll(edges, -1, axis=0)
    return edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]


def check(polygon: np.ndarray, rng: np.random.Generator) -> None:
    """Check that convex parts, or hull and pockets, make up the polygon: no area and no point twice."""
    parts, (hull, pockets) = convex_parts(polygon), hull_and_pockets(polygon)
    size, low, high = area_m2(polygon), polygon.min(axis=0), polygon.max(axis=0)
    hair_m = 1e-9 * np.max(high - low)
    corners = {tuple(corner) for corner in polygon}
    for part in parts:
        assert np.all(turns(part) >= -1e-12 * size)
        assert area_m2(part) > 0.0
        assert {tuple(corner) for corner in part} <= corners
    assert np.all(turns(hull) > 0.0)
    assert np.all(depth_m(polygon, hull) >= -1e-3 * hair_m)
    areas = [area_m2(pocket) for pocket in pockets]
    assert min(areas, default=0.0) >= 0.0
    assert sum(area_m2(part) for part in parts) == pytest.approx(size, rel=1e-12)
    assert area_m2(hull) == pytest.approx(size + sum(areas), rel=1e-12)
    points = rng.uniform(low - 1.0, high + 1.0, (400, 2))
    borders = np.min([np.abs(depth_m(points, border)) for border in (polygon, hull, *pockets)], axis=0)
    points = points[borders > max(hair_m, 1e-9)]
    inside = depth_m(points, polygon) > 0.0
    deepest = np.max([depth_m(points, part) for part in parts], axis=0)
    assert np.all(deepest[inside] >= -hair_m)  # on a cut between two parts a point is inside neither
    assert np.all(deepest[~inside] <= 0.0)
    shares = inside + np.sum([depth_m(points, pocket) > 0.0 for pocket in pockets], axis=0)
    np.testing.assert_array_equal(shares, depth_m(points, hull) > 0.0)


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_are_cut_into_convex_parts(name: str) -> None:
    """Shapes with vertices in line, deep bays and needles, from every vertex they may begin at."""
    polygon = np.array(SHAPES[name], dtype=float)
    assert area_m2(polygon) > 0.0
    rng = np.random.default_rng(3)
    for first in range(len(polygon)):
        check(np.roll(polygon, first, axis=0), rng)


@settings(max_examples=50)
@given(seed=SEEDS, count=st.integers(3, 12))
def test_stars_are_cut_into_convex_parts(seed: int, count: int) -> None:
    """Random star-shaped polygons of up to twelve vertices."""
    rng = np.random.default_rng(seed)
    check(star(rng, count, 20.0) + rng.uniform(-50.0, 50.0, 2), rng)


def test_many_vertices_are_cut_in_seconds() -> None:
    """A comb of 1,000 vertices, is cut into triangles."""
    x = np.linspace(-40.0, 40.0, 998)
    teeth = np.column_stack([x, np.where(np.arange(998) % 2, 40.0, -32.0)])
    comb = np.vstack([teeth, [(40.0, -40.0), (-40.0, -40.0)]])[::-1]
    began = time.process_time()
    parts = convex_parts(comb)
    assert time.process_time() - began < 40.0
    assert len(parts) == 998
    np.testing.assert_allclose(sum(area_m2(part) for part in parts), area_m2(comb), rtol=1e-12)
