"""Lines of sight past buildings, against shapely on sections and known answers."""

from collections.abc import Sequence

import numpy as np
import pytest
import shapely
from sizes import and_slow, chosen

from nullpose.channel.buildings import HAIR_M, Prisms, is_blocked, prisms_of, shadows_of
from scenes import star

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
NEAR_M = 1e-4
"""A shorter way through a building, or past one, is left to rounding."""


def towers(*heights_m: tuple[float, float]) -> Prisms:
    """Return the square with these heights, once for each."""
    count = len(heights_m)
    return prisms_of([SQUARE] * count, [[]] * count, [0.0] * count, heights_m)


def meets(prisms: Prisms, begin: np.ndarray, end: np.ndarray, low: bool) -> list[bool]:
    """Return which prisms a line passes through, clipped by their half-spaces one after the other."""
    found = []
    for piece, roof in enumerate(prisms.least_height_m if low else prisms.most_height_m):
        sides = np.insert(prisms.sides[prisms.start[piece] : prisms.start[piece + 1]], 2, 0.0, axis=1)
        ends = [[0.0, 0.0, 1.0, roof], [0.0, 0.0, -1.0, -prisms.base_m[piece]]]
        enters, leaves = 0.0, 1.0
        for *normal, offset in np.vstack([sides, ends]):
            at_begin, at_end = begin @ normal - offset, end @ normal - offset
            share = at_begin / (at_begin - at_end)
            enters = max(enters, share if at_begin > 0.0 else 0.0)
            leaves = min(leaves, share if at_end > 0.0 else 1.0)
            enters = 2.0 if at_begin > 0.0 and at_end > 0.0 else enters
        found.append(enters < leaves)
    return found


def longest_inside_m(
    polygons: Sequence[shapely.Polygon], ends_m: Sequence[tuple[float, float]], at: np.ndarray, to: np.ndarray
) -> float:
    """Return how much of a line is inside the buildings, seen from above, at the altitudes they have."""
    inside = 0.0
    for polygon, (base, roof) in zip(polygons, ends_m, strict=True):
        low, high = sorted((np.array([base, roof]) - at[2]) / (to[2] - at[2]))
        low, high = max(low, 0.0), min(high, 1.0)
        if low < high:
            part = shapely.LineString([(at + t * (to - at))[:2] for t in (low, high)])
            inside = max(inside, part.intersection(polygon).length)
    return inside


@pytest.mark.parametrize("seed", chosen(range(8), range(4)))
def test_lines_are_clipped_as_by_shapely(seed: int) -> None:
    """A link is blocked where a part of it is inside a building that may have a courtyard, and only there."""
    rng = np.random.default_rng(seed)
    outlines = [star(rng, int(rng.integers(3, 12)), 25.0) + rng.uniform(-60.0, 60.0, 2) for _ in range(8)]
    yards = [[outline.mean(axis=0) + 0.02 * (outline - outline.mean(axis=0))] for outline in outlines]
    polygons = [shapely.Polygon(*both) for both in zip(outlines, yards, strict=True)]
    sound = [polygon.is_valid for polygon in polygons]
    yards = [yard if is_sound else [] for yard, is_sound in zip(yards, sound, strict=True)]
    polygons = [shapely.Polygon(*both) for both in zip(outlines, yards, strict=True)]
    base = rng.choice([0.0, 4.0], 8)
    ends = np.column_stack([base, base + rng.uniform(1.0, 30.0, 8)])
    prisms = prisms_of(outlines, yards, base, ends[:, [1, 1]])
    at, to = rng.uniform(-80.0, 80.0, (20, 3)), rng.uniform(-80.0, 80.0, (10, 3))
    at[:, 2], to[:, 2] = rng.uniform(5.0, 60.0, 20), rng.uniform(0.0, 5.0, 10)
    blocked = is_blocked(prisms, at, to, False)
    lengths = np.array([[longest_inside_m(polygons, ends, a, b) for b in to] for a in at])
    assert 0.2 < blocked.mean() < 0.95
    assert blocked[lengths > NEAR_M].all()
    assert not blocked[lengths == 0.0].any()


def test_what_touches_is_clear() -> None:
    """Along a wall, over the roof's edge, past a corner, on the roof or at the foot of a wall: all clear."""
    tower = towers((20.0, 20.0))
    for at, to in (
        ([-10.0, 0.0, 9.0], [30.0, 0.0, 1.0]),
        ([-10.0, 5.0, 20.0], [30.0, 5.0, 20.0]),
        ([-10.0, 5.0, 30.0], [30.0, 5.0, 10.0]),
        ([-5.0, 5.0, 9.0], [5.0, -5.0, 9.0]),
        ([5.0, 5.0, 20.0], [50.0, 5.0, 30.0]),
        ([0.0, 5.0, 1.0], [-50.0, 5.0, 30.0]),
        ([5.0, 20.0, 5.0], [5.0, 20.0, 15.0]),
    ):
        for begin, end in ((at, to), (to, at)):
            assert not is_blocked(tower, begin, [end], False).any()
    through = np.array([[[-10.0, 5.0, 9.0], [5.0, 5.0, 30.0]], [[5.0, 30.0, 9.0], [5.0, 5.0, 21.0]]])
    assert is_blocked(tower, through, [[30.0, 5.0, 1.0], [5.0, 5.0, 0.0]], False).tolist() == [
        [[True, True], [False, True]],
        [[False, True], [True, True]],
    ]


def test_no_line_slips_between_the_pieces_of_a_building() -> None:
    """An L is cut into pieces; a line that runs along the cut is blocked like any other."""
    corner = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [10.0, 10.0], [10.0, 20.0], [0.0, 20.0]])
    prisms = prisms_of([corner], [[]], [0.0], [[9.0, 9.0]])
    assert set(prisms.building) == {0}
    assert len(prisms.start) == len(prisms.base_m) + 1 > 2
    for begin, end in zip(prisms.start, prisms.start[1:], strict=False):
        sides = prisms.sides[begin:end]
        vertices = [
            np.linalg.solve(both[:, :2], both[:, 2]) for both in np.stack([sides, np.roll(sides, 1, 0)], 1)
        ]
        for a, b in zip(vertices, np.roll(vertices, 1, axis=0), strict=True):
            middle, along = 0.5 * (a + b), b - a
            is_inner = shapely.Polygon(corner).contains(shapely.Point(middle).buffer(0.01))
            at, to = [*(middle - 0.4 * along), 1.0], [*(middle + 0.4 * along), 1.0]
            assert not is_inner or is_blocked(prisms, at, [to], False).all()


@pytest.mark.parametrize("apart_m", [(10.0, 0.0), (10.0, 5.0), (10.0, 10.0)])
def test_no_line_slips_between_houses_that_touch(apart_m: tuple[float, float]) -> None:
    """Whether they have a wall in common, a part of one or only a corner; a gap of 1 mm lets it through."""
    east_m, north_m = apart_m
    house = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    walls = [[house, np.add(house, (east_m + gap_m, north_m))] for gap_m in (0.0, 1e-3)]
    closed, open_ = (prisms_of(pair, [[], []], [0.0, 0.0], [[9.0, 9.0]] * 2) for pair in walls)
    lines = [([10.0, -30.0, 1.0], [10.0, 50.0, 5.0]), ([10.0005, -30.0, 1.0], [10.0005, 50.0, 5.0])]
    at, to = lines[0]
    assert is_blocked(closed, at, [to], False).all()
    at, to = lines[1]
    assert not is_blocked(open_, at, [to], False).any()


def test_the_roof_is_the_one_that_is_asked_for() -> None:
    """Of an interval of heights the upper end blocks more; a building of height 0 blocks nothing."""
    tower = towers((0.0, 0.0), (8.0, 12.0))
    at, to = [-10.0, 5.0, 10.0], [[30.0, 5.0, 10.0]]
    assert is_blocked(tower, at, to, False).all()
    assert not is_blocked(tower, at, to, True).any()
    flat = towers((0.0, 0.0))
    rng = np.random.default_rng(3)
    assert not is_blocked(flat, rng.normal(size=(50, 3)), rng.normal(size=(9, 3)), False).any()
    none = prisms_of([], [], [], [])
    assert not is_blocked(none, at, to, False).any()


def test_ground_points_may_differ_from_position_to_position() -> None:
    """As errors move them: each line is that of its own points, on rows and columns of positions too."""
    tower = towers((0.0, 12.0))
    rng = np.random.default_rng(5)
    at, to = rng.uniform(-30.0, 40.0, (7, 1, 3)), rng.uniform(-30.0, 40.0, (5, 9, 3))
    blocked = is_blocked(tower, at, to, False)
    assert blocked.shape == (7, 5, 9)
    assert 0 < blocked.sum() < blocked.size
    for i, place in enumerate(at[:, 0]):
        for j, points in enumerate(to):
            np.testing.assert_array_equal(blocked[i, j], is_blocked(tower, place, points, False))


def test_a_passage_is_open() -> None:
    """Below its base a building lets links through."""
    arch = prisms_of([SQUARE], [[]], [4.0], [[9.0, 9.0]])
    at = [[-10.0, 5.0, 3.0], [-10.0, 5.0, 5.0]]
    assert is_blocked(arch, at, [[30.0, 5.0, 3.0]], False)[:, 0].tolist() == [False, True]


@pytest.mark.parametrize(("seed", "count"), and_slow([(0, 80), (1, 80)], [(seed, 400) for seed in range(6)]))
def test_a_shadow_is_where_a_line_is_blocked(seed: int, count: int) -> None:
    """Inside of all sides of a prism's shadow, and nowhere else but a hair beside its border."""
    rng = np.random.default_rng(seed)
    outlines = [star(rng, int(rng.integers(3, 9)), 20.0) + rng.uniform(-60.0, 60.0, 2) for _ in range(5)]
    base = rng.choice([0.0, 4.0], 5)
    heights = base[:, None] + np.sort(rng.uniform(1.0, 30.0, (5, 2)), axis=1)
    prisms = prisms_of(outlines, [[]] * 5, base, heights)
    points = rng.uniform(-80.0, 80.0, (12, 3))
    points[:, 2] = rng.choice([0.0, 1.5, 45.0], 12)
    is_low = rng.random(12) < 0.5
    shadows = shadows_of(prisms, points, is_low)
    places = rng.uniform([-120.0, -120.0, 0.5], [120.0, 120.0, 70.0], (count, 3))
    found = 0
    for j, (point, low) in enumerate(zip(points, is_low, strict=True)):
        blocked = np.any([meets(prisms, place, point, low) for place in places], axis=1)
        np.testing.assert_array_equal(is_blocked(prisms, places, point[None], low)[:, 0], blocked)
        found += int(blocked.sum())
        inside, near = np.zeros(len(places), bool), np.zeros(len(places), bool)
        for s in range(shadows.of_point[j], shadows.of_point[j + 1]):
            sides = shadows.sides[shadows.start[s] : shadows.start[s + 1]]
            away = np.max(places @ sides[:, :3].T - sides[:, 3], axis=1)
            inside |= away < 0.0
            near |= np.abs(away) < 1e-4
            real = sides[np.isfinite(sides[:, 3])]
            assert np.abs(real[:, 4] - real[:, 3]) == pytest.approx(HAIR_M)
        assert np.all((inside == blocked) | near)
    assert 0.25 * count < found < 10 * count


@pytest.mark.parametrize("seed", range(4))
def test_a_margin_counts_the_worst_line_of_sight_around_the_drone(seed: int) -> None:
    """To a node a link is clear only if it is so from everywhere within the margin, and to a jammer blocked.

    Of one building a jammer is blocked exactly where it is so all around, edges of its shadow left aside.
    """
    rng = np.random.default_rng(seed)
    margin_m, count = 2.0, 300
    prisms = prisms_of([star(rng, 4, 20.0)], [[]], [0.0], [[12.0, 15.0]], margin_m)
    points = np.column_stack([*(40.0 * star(rng, 6, 1.0).T), rng.uniform(0.0, 20.0, 6)])
    points = points[~is_blocked(prisms, points + np.array([0.0, 0.0, 1e3]), points, False).diagonal()]
    at = np.column_stack([rng.uniform(-90.0, 90.0, (count, 2)), rng.uniform(0.5, 40.0, count)])
    around = rng.normal(size=(400, 3))
    around *= margin_m / np.linalg.norm(around, axis=1)[:, None]
    near = at[:, None] + around
    bare = prisms._replace(margin_m=0.0)
    worst_to_nodes = is_blocked(bare, near, points, False).any(axis=1)
    worst_to_jammers = is_blocked(bare, near, points, True).all(axis=1)
    to_nodes, to_jammers = is_blocked(prisms, at, points, False), is_blocked(prisms, at, points, True)
    assert np.all(to_nodes[worst_to_nodes])
    assert np.all(worst_to_jammers[to_jammers])
    assert 0 < to_jammers.sum() < is_blocked(bare, at, points, True).sum()
    assert is_blocked(bare, at, points, False).sum() < to_nodes.sum() < count * len(points)
    if len(bare.base_m) == 1:  # samples leave a little
        less = is_blocked(prisms._replace(margin_m=0.9 * margin_m), at, points, True)
        assert np.all(less[worst_to_jammers])


def test_shadows_of_moved_points_are_their_own() -> None:
    """Whether points are the same for all positions or differ, with a margin and inside a building too."""
    tower = towers((9.0, 12.0))._replace(margin_m=0.5)
    rng = np.random.default_rng(5)
    at, to = rng.uniform(-30.0, 40.0, (40, 3)), rng.uniform(-30.0, 40.0, (6, 3))
    to[0] = [5.0, 5.0, 1.0]
    low = np.arange(6) % 2 == 1
    fixed = is_blocked(tower, at, to, low)
    assert fixed[:, 0].all()
    moved = is_blocked(tower, at, np.broadcast_to(to, (40, 6, 3)), low)
    np.testing.assert_array_equal(fixed, moved)
