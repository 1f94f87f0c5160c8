"""Polygons in rectangles: every allowed point meets an alternative, in all coincidences, exactly."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from sizes import few_examples
from tests.certificate.plain import seeds

from nullpose.certificate.outline import Outline, Point, clipped, corners, may_meet
from nullpose.certificate.pose_value import exact


def star(rng: np.random.Generator, on_grid: bool) -> np.ndarray:
    """Return the edges of a polygon around the origin, counter-clockwise, perhaps with whole coordinates."""
    count = int(rng.integers(3, 10))
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
    radii = rng.uniform(2.0, 10.0, count)
    vertices = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
    if on_grid:
        vertices = np.round(vertices)
    keep = np.any(vertices != np.roll(vertices, 1, axis=0), axis=1)
    vertices = vertices[keep]
    return np.hstack([vertices, np.roll(vertices, -1, axis=0)])


def rectangle_near(
    rng: np.random.Generator, edges: np.ndarray, on_grid: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Return corners of a rectangle: anywhere, or small and on an edge or a vertex."""
    if on_grid:
        a, b = np.sort(rng.integers(-10, 11, (2, 2)), axis=0)
        return a.astype(float), b.astype(float)
    edge = edges[int(rng.integers(len(edges)))]
    share = float(rng.choice([0.0, 0.5, rng.uniform()]))
    centre = edge[:2] + share * (edge[2:] - edge[:2])
    half = 10.0 ** rng.uniform(-6.0, 0.8, 2)
    centre = centre + rng.uniform(-1.5, 1.5, 2) * half
    return centre - half, centre + half


def is_on(edges: np.ndarray, point: Point) -> bool:
    """Return whether a point is on an edge, exactly."""
    for edge in edges:
        (ax, ay), (bx, by) = exact(edge[:2]), exact(edge[2:])
        cross = (bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax)
        along = (point[0] - ax) * (point[0] - bx) + (point[1] - ay) * (point[1] - by)
        if cross == 0 and along <= 0:
            return True
    return False


def is_inside(edges: np.ndarray, point: Point) -> bool:
    """Return whether a point on no edge is inside, by the edges above it, exactly."""
    above = 0
    for edge in edges:
        (ax, ay), (bx, by) = exact(edge[:2]), exact(edge[2:])
        if (ax > point[0]) != (bx > point[0]):
            above += ay + (point[0] - ax) * (by - ay) / (bx - ax) > point[1]
    return above % 2 == 1


def samples(rng: np.random.Generator, low: np.ndarray, high: np.ndarray, edges: np.ndarray) -> list[Point]:
    """Return points of a rectangle: some anywhere, its corners, and some on the edges in it."""
    rectangle = exact(low), exact(high)
    points = list(corners(*rectangle))
    for x, y in rng.integers(0, 9, (12, 2)):
        share_x, share_y = Fraction(int(x), 8), Fraction(int(y), 8)
        points.append(rectangle[0] + np.array([share_x, share_y]) * (rectangle[1] - rectangle[0]))
    for edge in edges:
        ends = sorted(map(tuple, clipped(exact(edge), *rectangle)))
        points += ends
        if ends:
            points.append(tuple((a + b) / 2 for a, b in zip(ends[0], ends[-1], strict=True)))
    return points


@pytest.mark.parametrize("is_fence", [False, True])
@pytest.mark.parametrize("on_grid", [False, True])
@few_examples(50)
@given(seed=seeds)
def test_allowed_points_meet_an_alternative(is_fence: bool, on_grid: bool, seed: int) -> None:
    """Of one of the tuples every edge is kept to; without tuples nothing is allowed."""
    rng = np.random.default_rng(seed)
    edges = star(rng, on_grid)
    outline = Outline(exact(edges), is_fence)
    low, high = rectangle_near(rng, edges, on_grid)
    met = [int(e) for e in np.flatnonzero(may_meet(edges, low[None], high[None])[0])]
    alternatives = outline.alternatives(met, low, high)
    for point in samples(rng, low, high, edges):
        on = is_on(edges, point)
        if on or is_inside(edges, point) == is_fence:
            assert any(all(outline.allowance(e, point) >= 0 for e in chosen) for chosen in alternatives)
        if not on:
            assert outline.forbids(point) == (is_inside(edges, point) != is_fence)


@given(seed=seeds)
def test_edges_that_meet_are_never_left_out(seed: int) -> None:
    """An edge with a point in the rectangle is named, also where they only touch."""
    rng = np.random.default_rng(seed)
    for on_grid in (False, True):
        edges = star(rng, on_grid)
        boxes = [rectangle_near(rng, edges, on_grid) for _ in range(10)]
        low, high = (np.array([box[i] for box in boxes]) for i in range(2))
        named = may_meet(edges, low, high)
        for b in range(10):
            rectangle = exact(low[b]), exact(high[b])
            for e, edge in enumerate(edges):
                assert named[b, e] or not clipped(exact(edge), *rectangle)


L_SHAPE = np.array([[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [4.0, 8.0], [4.0, 4.0], [0.0, 4.0]])
L_EDGES = np.hstack([L_SHAPE, np.roll(L_SHAPE, -1, axis=0)])
WALL, SALIENT, REFLEX = (6.0, 0.0), (8.0, 8.0), (4.0, 4.0)


def around(point: tuple[float, float], half: float) -> list[tuple[int, ...]]:
    """Return the alternatives of the L around a point, as a forbidden zone and as a fence."""
    low, high = np.array(point) - half, np.array(point) + half
    met = [int(e) for e in np.flatnonzero(may_meet(L_EDGES, low[None], high[None])[0])]
    return [Outline(exact(L_EDGES), fence).alternatives(met, low, high) for fence in (False, True)]


def test_alternatives_are_as_few_as_can_be() -> None:
    """On a wall one side; at a corner either of two or both, whichever the forbidden part asks for."""
    assert around(WALL, 0.5) == [[(0,)], [(0,)]]
    assert around(SALIENT, 0.5) == [[(1,), (2,)], [(1, 2)]]
    assert around(REFLEX, 0.5) == [[(3, 4)], [(3,), (4,)]]
    assert around((6.0, 3.0), 0.5) == [[], [()]]
    assert around((-3.0, 3.0), 0.5) == [[()], []]
    # the arm is 4 wide: both its walls, that of the foot, and more
    assert around((6.0, 6.0), 2.5) == [[()], [()]]
    # a passage between walls that are not neighbours
    assert around((6.0, 6.0), 1.99) == [[], [()]]
    wide = np.array([3.9, 5.0]), np.array([8.1, 6.0])
    outline = Outline(exact(L_EDGES), True)
    assert outline.alternatives([1, 3], *wide) == [(1, 3)]
    assert Outline(exact(L_EDGES), False).alternatives([1, 3], *wide) == [(1,), (3,)]
