"""Zones and fences as arrays: what is outside all pieces and zones is what the airspace allows."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from nullpose.problem.airspace import FENCE, FORBIDDEN_CYLINDER, FORBIDDEN_POLYGON, airspace_zones
from nullpose.problem.records import Domain
from nullpose.scenario import Airspace
from nullpose.solver.kernels.search.zones import in_zone

SEEDS = st.integers(0, 2**32 - 1)
HIGH_M = 40.0


def star(rng: np.random.Generator, size_m: float) -> list[tuple[float, float]]:
    """Returns a star-shaped polygon in either sense of rotation."""
    count = int(rng.integers(3, 9))
    angles = 2.0 * np.pi * (np.arange(count) + rng.uniform(0.1, 0.9, count)) / count
    around = size_m * rng.uniform(0.3, 1.0, (count, 1)) * np.column_stack([np.cos(angles), np.sin(angles)])
    corners = [(float(x), float(y)) for x, y in rng.uniform(20.0, 60.0, 2) + around]
    return corners[::-1] if rng.uniform() < 0.5 else corners


def random_airspace(seed: int, *, zones: int, fenced: bool) -> Airspace:
    """Returns an airspace with zones of every shape, some of limited height, and a fence or none."""
    rng = np.random.default_rng(seed)
    no_fly: list[dict] = []
    for _ in range(zones):
        x, y = rng.uniform(10.0, 70.0, 2)
        zone: dict = {"polygon_m": star(rng, 20.0)}
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
        geofence_m=star(rng, 50.0) if fenced else None,
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
    ours = zones
    domain = Domain(low_m=none, high_m=none, keep_out_points_m=no_points, keep_out_m=1.0, **ours)
    count = len(zones["zone_kind"])
    return np.array([any(in_zone(domain, z, p) for z in range(count)) for p in positions])


@settings(max_examples=50)
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


def test_kinds_and_edges() -> None:
    """A box, a cylinder, a polygon and a fence keep their order, kinds, edges and altitudes."""
    triangle = [(0.0, 0.0), (0.0, 9.0), (9.0, 0.0)]  # clockwise
    airspace = Airspace(
        altitude_m=(8.0, 30.0),
        geofence_m=[(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)],
        no_fly=(
            {"x_m": (1.0, 2.0), "y_m": (3.0, 5.0), "altitude_m": (0.0, 12.0)},
            {"centre_m": (20.0, 21.0), "radius_m": 4.0},
            {"polygon_m": triangle},
        ),
    )
    zones = airspace_zones(airspace)
    np.testing.assert_array_equal(
        zones["zone_kind"], [FORBIDDEN_POLYGON, FORBIDDEN_CYLINDER, FORBIDDEN_POLYGON, FENCE]
    )
    np.testing.assert_array_equal(zones["zone_start"], [0, 4, 5, 8, 12])
    np.testing.assert_array_equal(zones["zone_edges"][4], [20.0, 21.0, 4.0, 0.0])
    np.testing.assert_array_equal(zones["zone_range_m"][0], [-np.inf, 12.0])
    assert np.all(np.isinf(zones["zone_range_m"][1:]))
    edges = zones["zone_edges"][5:8]
    np.testing.assert_array_equal(edges[:, 2:], np.roll(edges[:, :2], -1, axis=0))
    doubled = np.sum(edges[:, 0] * edges[:, 3] - edges[:, 2] * edges[:, 1])
    assert doubled == 81.0  # twice the area, counter-clockwise
    # the box has a ceiling of its own (its floor is that of all), and the fence one piece for each side
    np.testing.assert_array_equal(np.diff(zones["piece_start"]), [5, 1, 3, 1, 1, 1, 1])


@pytest.mark.parametrize(
    ("altitude_m", "kept"),
    [((0.0, 8.0), 0), ((0.0, 8.1), 1), ((30.0, 50.0), 0), ((29.9, 50.0), 1), (None, 1), ((0.0, 99.0), 1)],
)
def test_zones_beyond_the_altitudes_are_left_out(altitude_m: tuple | None, kept: int) -> None:
    """A zone that only touches the lowest or highest altitude, whose border is allowed, takes no part."""
    zone = {"centre_m": (0.0, 0.0), "radius_m": 5.0, "altitude_m": altitude_m}
    zones = airspace_zones(Airspace(altitude_m=(8.0, 30.0), no_fly=(zone,)))
    assert len(zones["zone_kind"]) == len(zones["piece_start"]) - 1 == kept
