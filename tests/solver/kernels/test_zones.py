"""No-fly zones and fences in a box: the simple constraints stand for the zone exactly where it matters."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import few_examples
from tests.reference.plain_kernels import plain

from nullpose.problem.airspace import airspace_zones
from nullpose.problem.records import Domain
from nullpose.scenario import Airspace
from nullpose.scenario.polygon import depth_m
from nullpose.solver.kernels.search.zones import (
    FORBIDDEN,
    MOST_ALTERNATIVES,
    OUTSIDE,
    UNCLEAR,
    zone_alternatives,
)

SEEDS = st.integers(0, 2**32 - 1)
HAIR_M = 1e-8

alternatives_of = plain(zone_alternatives)


def domain_of(airspace: Airspace) -> Domain:
    """Returns the airspace's zones in a box without bounds, as the kernels take them."""
    zones = airspace_zones(airspace)
    arrays = list(zones.values())
    for array in arrays:
        array.flags.writeable = False
    box = np.array([-np.inf, -np.inf, 8.0]), np.array([np.inf, np.inf, 40.0]), np.zeros((0, 3))
    for array in box:
        array.flags.writeable = False
    return Domain(*box, 1.0, *arrays)


def clear_by(airspace: Airspace, positions: np.ndarray) -> np.ndarray:
    """Returns how far positions are from what the one zone or fence forbids, negative inside of it."""
    if airspace.geofence_m is not None:
        return depth_m(positions[:, :2], airspace.geofence_outline_m)
    return -airspace.no_fly[0].depth_m(positions, airspace.altitude_m)


def met_by(side: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Returns a constraint's value at positions, in metres: not negative where it is met."""
    if side[0] == 0.0:
        return positions @ side[1:4] - side[4]
    return np.linalg.norm(positions[:, :2] - side[1:3], axis=1) - side[4]


def check_box(airspace: Airspace, centre: np.ndarray, half: np.ndarray, rng: np.random.Generator) -> int:
    """Checks what is said of a box against positions in it; returns the word or the number."""
    sides, counts = np.full((MOST_ALTERNATIVES, 2, 5), np.nan), np.zeros(MOST_ALTERNATIVES, np.int64)
    said = alternatives_of(domain_of(airspace), 0, centre, half, sides, counts)
    positions = centre + half * rng.uniform(-1.0, 1.0, (300, 3))
    snapped = rng.uniform(size=positions.shape) < 0.2
    positions = np.where(snapped, centre + half * np.sign(positions - centre), positions)
    clear = clear_by(airspace, positions)
    if said == FORBIDDEN:
        assert np.all(clear < HAIR_M)
    elif said == OUTSIDE:
        assert np.all(clear > -HAIR_M)
    elif said != UNCLEAR:
        assert 1 <= said <= MOST_ALTERNATIVES
        allowed = positions[clear > 0.0]
        met = np.zeros(len(allowed), dtype=bool)
        for a in range(said):
            assert counts[a] in (1, 2)
            values = [met_by(sides[a, c], allowed) for c in range(counts[a])]
            met |= np.min(values, axis=0) >= -HAIR_M
        assert np.all(met)
    return int(said)


def star(rng: np.random.Generator) -> list[tuple[float, float]]:
    """Returns a star-shaped polygon, often with deep bays."""
    count = int(rng.integers(3, 9))
    angles = 2.0 * np.pi * (np.arange(count) + rng.uniform(0.1, 0.9, count)) / count
    corners = rng.uniform(3.0, 20.0, (count, 1)) * np.column_stack([np.cos(angles), np.sin(angles)])
    return [(float(x), float(y)) for x, y in corners]


def some_airspace(rng: np.random.Generator, kind: str) -> Airspace:
    """Returns an airspace with one zone, perhaps of limited height, or with a fence."""
    if kind == "fence":
        return Airspace(altitude_m=(8.0, 40.0), geofence_m=star(rng))
    zone: dict = {"polygon_m": star(rng)}
    if kind == "cylinder":
        zone = {"centre_m": tuple(rng.uniform(-5.0, 5.0, 2)), "radius_m": rng.uniform(2.0, 15.0)}
    elif kind == "box":
        west, south = rng.uniform(-15.0, 0.0, 2)
        zone = {"x_m": (west, west + rng.uniform(1.0, 15.0)), "y_m": (south, south + rng.uniform(1.0, 15.0))}
    if rng.uniform() < 0.5:
        low = rng.uniform(0.0, 25.0)
        zone["altitude_m"] = (low, low + rng.uniform(9.0, 20.0))
    return Airspace(altitude_m=(8.0, 40.0), no_fly=(zone,))


@pytest.mark.parametrize("kind", ["fence", "polygon", "box", "cylinder"])
def test_allowed_positions_meet_an_alternative(kind: str) -> None:
    """In boxes of any size about a zone, every allowed position meets all constraints of an alternative.

    Boxes called forbidden hold no allowed position, those called outside no forbidden one; small boxes are
    seldom unclear.
    """
    rng = np.random.default_rng(["fence", "polygon", "box", "cylinder"].index(kind))
    said: Counter[int] = Counter()
    small: Counter[int] = Counter()
    for _ in range(400):
        airspace = some_airspace(rng, kind)
        half = 10.0 ** rng.uniform(-2.0, 1.0) * rng.uniform(0.3, 1.0, 3)
        half *= rng.uniform(size=3) < 0.95  # some are flat
        centres = rng.uniform([-20.0, -20.0, 8.0], [20.0, 20.0, 40.0], (int(rng.integers(1, 20)), 3))
        nearest = np.argmin(np.abs(clear_by(airspace, centres)))  # most boxes are to be on a border
        word = check_box(airspace, centres[nearest], half, rng)
        said[word] += 1
        if np.max(half[:2]) < 0.3:
            small[word] += 1
    assert min(said[FORBIDDEN], said[OUTSIDE], sum(said[n] for n in range(1, 5))) > 20
    assert small[UNCLEAR] <= 0.02 * sum(small.values())
    if kind == "cylinder":
        assert said[UNCLEAR] == 0


LATTICE = {
    "diamond": [(0, -4), (4, 0), (0, 4), (-4, 0)],
    "bay": [(-8, -8), (8, -8), (8, 8), (0, 0), (-8, 8)],
    "vertex in a side": [(-8, -8), (0, -8), (8, -8), (8, 8), (-8, 8), (-8, 0)],
    "cross": [
        *((-2, -8), (2, -8), (2, -2), (8, -2), (8, 2), (2, 2)),
        *((2, 8), (-2, 8), (-2, 2), (-8, 2), (-8, -2), (-2, -2)),
    ],
}


@few_examples(20)
@given(seed=SEEDS, name=st.sampled_from(sorted(LATTICE)), is_fence=st.booleans())
def test_borders_on_the_faces_of_boxes(seed: int, name: str, is_fence: bool) -> None:
    """Edges and vertices that lie exactly on faces, edges and corners of boxes are neither lost nor invented.

    Polygons with whole coordinates, and boxes whose sides are powers of two on the same lattice.
    """
    rng = np.random.default_rng(seed)
    corners = [(float(x), float(y)) for x, y in LATTICE[name]]
    limits = {} if rng.uniform() < 0.5 else {"altitude_m": (4.0, 16.0)}
    if is_fence:
        airspace = Airspace(altitude_m=(8.0, 40.0), geofence_m=corners)
    else:
        airspace = Airspace(altitude_m=(8.0, 40.0), no_fly=({"polygon_m": corners} | limits,))
    for _ in range(8):
        half = 2.0 ** rng.integers(-4, 3, 3)
        centre = half * rng.integers(-np.ceil(9 / half), np.ceil(9 / half) + 1)
        centre[2] += 16.0
        check_box(airspace, centre, half.astype(float), rng)


@pytest.mark.parametrize("end", [-1.0, 1.0])
def test_a_face_on_a_zones_top_or_bottom_is_allowed(end: float) -> None:
    """A box in a zone that reaches to its top or bottom, rounding aside, has that face to be looked at."""
    zone = {"centre_m": (0.0, 0.0), "radius_m": 9.0, "altitude_m": (12.0, 30.1)}
    domain = domain_of(Airspace(altitude_m=(8.0, 40.0), no_fly=(zone,)))
    face = 30.1 if end > 0.0 else 12.0
    sides, counts = np.zeros((MOST_ALTERNATIVES, 2, 5)), np.zeros(MOST_ALTERNATIVES, np.int64)
    for half in (0.1, 0.3, 1.0, 0.7):
        centre, halves = np.array([1.0, 2.0, face - end * half]), np.full(3, half)
        assert alternatives_of(domain, 0, centre, halves, sides, counts) == 1
        np.testing.assert_array_equal(sides[0, 0], [0.0, 0.0, 0.0, end, end * face])
        centre[2] -= end * 1e-3
        assert alternatives_of(domain, 0, centre, halves, sides, counts) == FORBIDDEN
