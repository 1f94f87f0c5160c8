"""Zones and fences as arrays: what is outside all pieces and zones is what the airspace allows."""

import time

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import few_examples

from nullpose.problem.airspace import airspace_zones, convex_parts, hull_and_pockets
from nullpose.problem.records import Domain
from nullpose.scenario import Airspace
from nullpose.scenario.polygon import area_m2, depth_m
from nullpose.solver.kernels.search.zones import in_zone
from scenes import star

SEEDS = st.integers(0, 2**32 - 1)
HIGH_M = 40.0


def outline(rng: np.random.Generator, size_m: float) -> list[list[float]]:
    """Returns a star-shaped polygon in either sense of rotation."""
    corners = star(rng, int(rng.integers(3, 9)), size_m) + rng.uniform(20.0, 60.0, 2)
    return corners[:: rng.choice([-1, 1])].tolist()


def random_airspace(seed: int, *, zones: int, fenced: bool) -> Airspace:
    """Returns an airspace with zones of every shape, some of limited height, and a fence or none."""
    rng = np.random.default_rng(seed)
    no_fly: list[dict] = []
    for _ in range(zones):
        x, y = rng.uniform(10.0, 70.0, 2)
        zone: dict = {"polygon_m": outline(rng, 20.0)}
        shape = rng.integers(3)
        if shape == 0:
            zone = {"x_m": (x, x + rng.uniform(1.0, 30.0)), "y_m": (y, y + rng.uniform(1.0, 30.0))}
        elif shape == 1:
            zone = {"centre_m": (x, y), "radius_m": rng.uniform(1.0, 20.0)}
        if rng.uniform() < 0.5:
            low = rng.uniform(-5.0, 35.0)
            zone["altitude_m"] = (low, low + rng.uniform(1.0, 20.0))
        no_fly.append(zone)
    return Airspace(
        altitude_m=(8.0, HIGH_M),
        x_m=(0.0, 80.0) if rng.uniform() < 0.5 else None,
        geofence_m=outline(rng, 50.0) if fenced else None,
        no_fly=tuple(no_fly),
    )


def outside_pieces(zones: dict[str, np.ndarray], positions: np.ndarray) -> np.ndarray:
    """Returns by how much positions, (n, 3), are outside of the piece that they are least outside of [m]."""
    least = np.full(len(positions), np.inf)
    for start, end in zip(zones["piece_start"][:-1], zones["piece_start"][1:], strict=True):
        sides = [
            positions @ side[1:4] - side[4]
            if side[0] == 0.0
            else np.linalg.norm(positions[:, :2] - side[1:3], axis=1) - side[4]
            for side in zones["piece_sides"][start:end]
        ]
        least = np.minimum(least, np.max(sides, axis=0))
    return least


def in_zones(zones: dict[str, np.ndarray], positions: np.ndarray) -> np.ndarray:
    """Returns which positions a zone forbids, by the kernel that the branch and bound asks."""
    none, no_points = np.zeros(3), np.zeros((0, 3))
    domain = Domain(low_m=none, high_m=none, keep_out_points_m=no_points, keep_out_m=1.0, **zones)
    count = len(zones["zone_kind"])
    return np.array([any(in_zone(domain, z, p) for z in range(count)) for p in positions])


@few_examples(20)
@given(seed=SEEDS, zones=st.integers(0, 3), fenced=st.booleans())
def test_pieces_and_zones_forbid_what_the_airspace_forbids(seed: int, zones: int, fenced: bool) -> None:
    """In the box, a position is allowed exactly if it is outside of all pieces, and of all zones."""
    airspace = random_airspace(seed, zones=zones, fenced=fenced)
    arrays = airspace_zones(airspace)
    rng = np.random.default_rng(seed)
    positions = rng.uniform([-20.0, -20.0, 8.0], [100.0, 100.0, HIGH_M], (300, 3))
    positions[:, 0] = np.clip(positions[:, 0], *(airspace.x_m or (-np.inf, np.inf)))
    # not within rounding of a border, and not on a cut between two pieces
    positions = positions[np.abs(airspace.clearance_m(positions)) > 1e-9]
    outside = outside_pieces(arrays, positions)
    positions, outside = positions[outside != 0.0], outside[outside != 0.0]
    allowed = airspace.allows(positions)
    np.testing.assert_array_equal(outside > 0.0, allowed)
    np.testing.assert_array_equal(~in_zones(arrays, positions), allowed)


@pytest.mark.parametrize(
    ("altitude_m", "kept"),
    [((0.0, 8.0), 0), ((0.0, 8.1), 1), ((30.0, 50.0), 0), ((29.9, 50.0), 1), (None, 1), ((0.0, 99.0), 1)],
)
def test_zones_beyond_the_altitudes_are_left_out(altitude_m: tuple | None, kept: int) -> None:
    """A zone that only touches the lowest or highest altitude, whose border is allowed, takes no part."""
    zone = {"centre_m": (0.0, 0.0), "radius_m": 5.0, "altitude_m": altitude_m}
    zones = airspace_zones(Airspace(altitude_m=(8.0, 30.0), no_fly=(zone,)))
    assert len(zones["zone_kind"]) == len(zones["piece_start"]) - 1 == kept


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


@few_examples(20)
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
