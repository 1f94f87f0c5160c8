"""Polygons with holes in convex pieces."""

import numpy as np
import pytest
import shapely

from nullpose.channel.convex import convex_parts, is_convex, joined
from scenes import star


@pytest.mark.parametrize("seed", range(12))
def test_joined_parts_cover_a_polygon(seed: int) -> None:
    """Joined parts are convex, fewer, apart, and cover the polygon without its hole."""
    rng = np.random.default_rng(seed)
    outline = star(rng, int(rng.integers(5, 40)), 30.0)
    hole = star(rng, 6, 2.0)
    whole = shapely.Polygon(outline, [hole])
    holes = [hole] if whole.is_valid else []
    whole = shapely.Polygon(outline, holes)
    parts = convex_parts(outline, holes)
    fewer = joined(parts)
    polygons = [shapely.Polygon(part) for part in fewer]
    assert len(fewer) < len(parts)
    assert all(map(is_convex, fewer))
    assert all(polygon.is_valid for polygon in polygons)
    assert sum(polygon.area for polygon in polygons) == pytest.approx(whole.area)
    assert shapely.union_all(polygons).symmetric_difference(whole).area < 1e-9


def test_squares_side_by_side() -> None:
    """Two squares are one; parts with two edges in common stay valid."""
    ring = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [0.0, 1.0]])
    (one,) = joined([ring[[0, 1, 4, 5]], ring[[1, 2, 3, 4]]])
    assert shapely.Polygon(one).equals(shapely.Polygon(ring))
    two = joined([ring, ring[::-1] * [1.0, -1.0]])
    assert all(shapely.Polygon(part).is_valid for part in two)
    assert sum(shapely.Polygon(part).area for part in two) == 4.0
