"""How far the drone stays from fence and zones."""

from pathlib import Path

import numpy as np
import pytest
import shapely
from sizes import chosen

from nullpose.errors import ScenarioError
from nullpose.problem.build import build_family
from nullpose.scenario import Airspace, NoFlyZone, Scenario
from nullpose.scenario.polygon import offset_outlines_m
from scenes import small

ALTITUDE_M = (10.0, 50.0)
FARTHEST = 1.81
"""From a polygon's corner the margin's border is at most so many margins away."""
FENCE = [[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]]


def star_m(rng: np.random.Generator, middle_m: tuple[float, float], size_m: float) -> list[list[float]]:
    """Return a polygon of many shapes, with sharp corners to either side, and no pocket that could close."""
    count = int(rng.integers(3, 20))
    angles = (np.arange(count) + rng.uniform(0.1, 0.9, count)) * 2.0 * np.pi / count
    radii = size_m * np.exp(rng.uniform(0.1, 0.7) * rng.normal(size=count))
    return (radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)]) + middle_m).tolist()


def scene(**airspace: object) -> Scenario:
    """Return a scenario in an airspace."""
    return Scenario.from_dict(small(airspace={"altitude_m": list(ALTITUDE_M), **airspace}))


def sideways_m(zone: NoFlyZone, plane: np.ndarray) -> np.ndarray:
    """Return how far points are outside a zone seen from above, as the margin of its shape counts."""
    if zone.shape == "box":
        (west, south), (east, north) = zone.outline_m[0], zone.outline_m[2]
        x, y = plane.T
        return np.max([west - x, x - east, south - y, y - north], axis=0)
    if zone.shape == "cylinder":
        return np.linalg.norm(plane - zone.centre_m, axis=1) - zone.radius_m
    return shapely.distance(shapely.Polygon(zone.outline_m), shapely.points(plane))


@pytest.mark.parametrize("seed", chosen(range(10), range(4)))
def test_positions_are_allowed_as_the_distances_say(seed: int) -> None:
    """Never nearer than the margin; always allowed beyond it, or at a polygon's corner beyond 1.81 of it."""
    rng = np.random.default_rng(seed)
    margin_m = float(10.0 ** rng.uniform(-1.0, 0.8))
    low_m = rng.uniform(5.0, 40.0, 3)
    heights = [{"altitude_m": [low, low + 10.0]} for low in low_m]
    shapes = [
        {"polygon_m": star_m(rng, (-20.0, 0.0), 9.0)},
        {"x_m": [5.0, 12.0], "y_m": [-15.0, 20.0]},
        {"centre_m": [30.0, 5.0], "radius_m": 6.0},
    ]
    stated = {"no_fly": [a | b for a, b in zip(shapes, heights, strict=True)], "altitude_m": ALTITUDE_M}
    airspace = Airspace(margin_m=margin_m, geofence_m=star_m(rng, (0.0, 0.0), 55.0), **stated)
    at = rng.uniform([-70.0, -70.0, 10.0], [70.0, 70.0, 50.0], (2000, 3))
    plane, fence = at[:, :2], shapely.Polygon(airspace.geofence_m)
    depth_m = fence.exterior.distance(shapely.points(plane)) * np.where(
        fence.contains(shapely.points(plane)), 1, -1
    )
    must, may = depth_m < margin_m, depth_m < FARTHEST * margin_m
    for zone in airspace.no_fly:
        low, high = zone.altitude_m
        beyond_m, over_m = sideways_m(zone, plane), np.maximum(low - at[:, 2], at[:, 2] - high)
        farthest = FARTHEST if zone.shape == "polygon" else 1.0
        must |= (beyond_m < margin_m) & (over_m < margin_m)
        may |= (beyond_m < farthest * margin_m) & (over_m < margin_m)
    allowed = airspace.allows(at)
    assert not np.any(allowed & must)
    assert np.all(allowed | may)
    assert 0.05 < allowed.mean() < 0.95
    assert np.mean(may & ~must) < 0.15


def test_beside_an_edge_the_distance_is_the_margin() -> None:
    """Away from corners the border is the margin away, to 2e-5 of it; no position is nearer."""
    rng = np.random.default_rng(7)
    for _ in range(200):
        outline, by_m = np.array(star_m(rng, (1e3, -2e3), 20.0)), float(10.0 ** rng.uniform(-2.0, 1.0))
        stated = shapely.Polygon(outline)
        (grown,) = offset_outlines_m(outline, by_m)
        apart_m = shapely.Polygon(grown).exterior.distance(stated)
        assert by_m <= apart_m <= by_m * (1.0 + 2e-5)
        assert max(stated.distance(shapely.points(grown))) <= FARTHEST * by_m
        for part in offset_outlines_m(outline, -by_m):
            assert stated.contains(shapely.Polygon(part))
            assert by_m <= shapely.Polygon(part).distance(stated.exterior) <= by_m * (1.0 + 2e-5)


@pytest.mark.parametrize(
    ("allowed", "positions_m"),
    [
        (True, [[13.01, 5, 20], [5, 5, 33.01], [46.99, 0, 20], [0, 30, 46.99], [-39.99, 40, 20]]),
        (False, [[12.99, 5, 20], [5, 5, 32.99], [47.01, 0, 20], [0, 30, 47.01], [-30, -19, 20]]),
        (False, [[12.99, 12.99, 20], [12.9, 5, 32.9]]),  # a right angle stays one, above too
        (True, [[0, 30, 10], [-30, -16.99, 20]]),  # ranges have no margin, a wall has two sides
    ],
)
@pytest.mark.parametrize("shape", ["box", "polygon"])
def test_what_is_allowed(allowed: bool, positions_m: list[list[float]], shape: str) -> None:
    """Sideways, above and below, for zones of two shapes that cover the same."""
    corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]
    block = {"x_m": [0.0, 10.0], "y_m": [0.0, 10.0]} if shape == "box" else {"polygon_m": corners}
    zones = [
        block | {"altitude_m": [0.0, 30.0]},
        {"x_m": [-5.0, 5.0], "y_m": [25.0, 35.0], "altitude_m": [50.0, 60.0]},
        {"x_m": [-40.0, -20.0], "y_m": [-20.0, -20.0]},
    ]
    scenario = scene(margin_m=3.0, x_m=[-40.0, 60.0], geofence_m=FENCE, no_fly=zones)
    assert np.all(scenario.airspace.allows(positions_m) == allowed)
    family = build_family(scenario)  # the solver's zones are the same, the wall among them
    assert len(family.domain.zone_kind) == 4


def test_a_saved_scenario_is_as_it_was_stated(tmp_path: Path) -> None:
    """The margin is saved beside zones and fence as stated; loaded again, it counts once."""
    airspace = {
        "altitude_m": list(ALTITUDE_M),
        "margin_m": 2.5,
        "geofence_lat_lon_deg": [[49.999, 14.499], [49.999, 14.501], [50.001, 14.501], [50.001, 14.499]],
        "no_fly": [{"polygon_lat_lon_deg": [[50.0, 14.5], [50.0, 14.5003], [50.0002, 14.5001]]}],
    }
    origin = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 200.0}
    stated = Scenario.from_dict(scene().to_dict() | {"origin": origin, "airspace": airspace})
    digest = build_family(stated).digest
    assert stated.airspace.no_fly[0].outline_m.max() < 22.3
    path = tmp_path / "saved.toml"
    path.write_text(stated.to_toml())
    for again in (Scenario.from_file(path), Scenario.from_dict(stated.to_dict())):
        assert again == stated
        assert build_family(again).digest == digest


HOURGLASS = [[-50, -20], [0, -4], [50, -20], [50, 20], [0, 4], [-50, 20]]


@pytest.mark.parametrize(("margin_m", "parts"), [(6.0, "2"), (1e3, "none")])
def test_a_fence_in_parts_is_refused(margin_m: float, parts: str) -> None:
    """The fault says how many parts are left, and a margin that leaves one."""
    with pytest.raises(ScenarioError, match=rf"leaves {parts}; try") as caught:
        scene(geofence_m=HOURGLASS, margin_m=margin_m)
    (fault,) = caught.value.faults
    assert fault.path == "airspace.margin_m"
    tried_m = float(fault.message.split("try ")[1].split(",")[0])
    assert scene(geofence_m=HOURGLASS, margin_m=tried_m).airspace.allows([-30.0, 0.0, 20.0])
    assert tried_m > 3.7


def test_a_closed_pocket_is_forbidden() -> None:
    """A yard whose gate is narrower than two margins cannot be flown into."""
    yard = [[-20, -20], [20, -20], [20, 20], [2, 20], [2, 15], [15, 15], [15, -15], [-15, -15], [-15, 15]]
    yard += [[-2, 15], [-2, 20], [-20, 20]]
    zones = {"no_fly": [{"polygon_m": yard}]}
    assert Airspace(altitude_m=ALTITUDE_M, margin_m=1.5, **zones).allows([0.0, 0.0, 20.0])
    assert not Airspace(altitude_m=ALTITUDE_M, margin_m=2.0, **zones).allows([0.0, 0.0, 20.0])
