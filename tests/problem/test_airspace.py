"""Zones and fences as arrays: what is outside all pieces and zones is what the airspace allows."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from nullpose.problem.airspace import airspace_zones
from nullpose.problem.records import Domain
from nullpose.scenario import Airspace
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


@pytest.mark.parametrize(
    ("altitude_m", "kept"),
    [((0.0, 8.0), 0), ((0.0, 8.1), 1), ((30.0, 50.0), 0), ((29.9, 50.0), 1), (None, 1), ((0.0, 99.0), 1)],
)
def test_zones_beyond_the_altitudes_are_left_out(altitude_m: tuple | None, kept: int) -> None:
    """A zone that only touches the lowest or highest altitude, whose border is allowed, takes no part."""
    zone = {"centre_m": (0.0, 0.0), "radius_m": 5.0, "altitude_m": altitude_m}
    zones = airspace_zones(Airspace(altitude_m=(8.0, 30.0), no_fly=(zone,)))
    assert len(zones["zone_kind"]) == len(zones["piece_start"]) - 1 == kept
