"""A solution as GeoJSON: valid by RFC 7946, every place where the scenario has it, and readable again."""

import json
import math
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely

from nullpose import Link, Pose, Result, evaluate, solve
from nullpose.errors import UsageError
from nullpose.report.export.geojson import geojson_file, solution_geojson
from nullpose.report.export.places import require_origin
from nullpose.scenario import Scenario
from nullpose.scenario.geodesy import enu_from_geodetic

ORIGIN = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 230.0}
AIRSPACE = {
    "altitude_m": [8.0, 30.0],
    "x_m": [-60.0, 60.0],
    "y_m": [-40.0, 90.0],
    "geofence_m": [[-50.0, 80.0], [50.0, 80.0], [0.0, -30.0]],  # clockwise
    "no_fly": [
        {"name": "mast", "centre_m": [30.0, 40.0], "radius_m": 10.0, "altitude_m": [0.0, 20.0]},
        {"x_m": [-30.0, -20.0], "y_m": [50.0, 60.0]},
    ],
}


@pytest.fixture(scope="module")
def solution(paper: Scenario) -> Result:
    """The paper's solution, told of an origin and a richer airspace afterwards: neither moves a number."""
    scenario = Scenario.from_dict(paper.to_dict() | {"origin": ORIGIN, "airspace": AIRSPACE})
    return replace(solve(paper, certify=False), scenario=scenario)


def features(solution: Result, kind: str) -> list[dict[str, Any]]:
    """Returns the features of a kind, as JSON has them."""
    collection = json.loads(json.dumps(solution_geojson(solution), allow_nan=False))
    assert collection["type"] == "FeatureCollection"
    return [each for each in collection["features"] if each["properties"]["kind"] == kind]


def local_m(coordinates: list[float], alt_m: float = 238.0) -> np.ndarray:
    """Returns GeoJSON coordinates in metres from the origin."""
    lon_deg, lat_deg, *height = coordinates
    return enu_from_geodetic([lat_deg, lon_deg, *(height or [alt_m])], list(ORIGIN.values()))


def test_every_part_is_there(solution: Result) -> None:
    """One feature for each point and each outline, each of the type that its kind has."""
    found = Counter(
        (each["properties"]["kind"], each["geometry"]["type"])
        for each in json.loads(json.dumps(solution_geojson(solution)))["features"]
    )
    assert found == {
        ("pose", "Point"): 1,
        ("node", "Point"): 2,
        ("jammer", "Point"): 1,
        ("airspace", "Polygon"): 1,
        ("geofence", "Polygon"): 1,
        ("no-fly", "Polygon"): 2,
    }


def test_points_are_where_the_scenario_has_them(solution: Result) -> None:
    """Longitude, latitude and altitude, in this order, lead back to the positions within a millimetre."""
    (pose,) = features(solution, "pose")
    np.testing.assert_allclose(
        local_m(pose["geometry"]["coordinates"]), solution.pose.position_m, rtol=0, atol=1e-3
    )
    for kind, points in (("node", solution.scenario.nodes), ("jammer", solution.scenario.jammers)):
        for feature, point in zip(features(solution, kind), points, strict=True):
            place = local_m(feature["geometry"]["coordinates"])
            np.testing.assert_allclose(place, point.position_m, rtol=0, atol=1e-3)
            assert feature["properties"]["name"] == point.name
            assert feature["properties"]["position_m"] == list(point.position_m)


def test_the_antennas_bearing_is_clockwise_from_north(solution: Result) -> None:
    """A dipole that leans to the east bears 90 degrees, one that leans to the north 0."""
    for axis, bearing in (((0.6, 0.0, 0.8), 90.0), ((0.0, 0.6, 0.8), 0.0), ((-0.6, 0.0, 0.8), 270.0)):
        pose = Pose.from_axis(solution.pose.position_m, axis)
        properties = features(replace(solution, pose=pose), "pose")[0]["properties"]
        assert properties["antenna_bearing_deg"] == pytest.approx(bearing, abs=1e-9)
        assert properties["antenna_tilt_deg"] == pytest.approx(math.degrees(math.acos(0.8)))


def test_outlines_are_rings(solution: Result) -> None:
    """Each outline is closed and runs counter-clockwise, as RFC 7946 asks for an outer ring."""
    for kind in ("airspace", "geofence", "no-fly"):
        for feature in features(solution, kind):
            (ring,) = feature["geometry"]["coordinates"]
            assert ring[0] == ring[-1]
            assert len(ring) >= 4
            assert sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(ring)) > 0.0


def test_buildings_are_on_the_map(solution: Result) -> None:
    """Outer ring counter-clockwise, courtyards clockwise, with their heights; the pose tells the channel."""
    yard = {"polygon_m": [[0, 0], [0, 9], [9, 9], [9, 0]], "courtyards_m": [[[3, 3], [6, 3], [6, 6], [3, 6]]]}
    plain = {"polygon_m": [[20, 0], [29, 0], [29, 9]], "height_m": [7.0, 9.0], "base_m": 3.0, "name": "arch"}
    changes = {
        "channel": {"model": "power-law", "exponent": 3.0},
        "buildings": [yard | {"height_m": 7}, plain],
    }
    scenario = Scenario.from_dict(solution.scenario.to_dict() | changes)
    inside = replace(solution, scenario=scenario)
    hollow, arch = features(inside, "building")
    outer, inner = (np.array(ring) for ring in hollow["geometry"]["coordinates"])
    assert shapely.LinearRing(outer).is_ccw
    assert not shapely.LinearRing(inner).is_ccw
    assert local_m(inner[0].tolist(), 230.0)[:2] == pytest.approx([3.0, 6.0], abs=1e-3)
    assert arch["properties"] == {"kind": "building", "name": "arch", "height_m": [7.0, 9.0], "base_m": 3.0}
    (pose,) = features(inside, "pose")
    assert pose["properties"]["channel"].startswith("power-law, exponent 3.0")
    assert "channel" not in features(solution, "pose")[0]["properties"]


def test_who_listens_in_is_on_the_map(solution: Result, paper: Scenario) -> None:
    """Eavesdroppers are points too, with how far they may be from there; nodes tell their secrecy rate."""
    listener = {"name": "E", "position_m": [17.0, 15.0, 4.0], "uncertainty_m": 3.0}
    threat = {"objective": "secrecy-rate", "transmitter": {"power_w": 1.0}, "eavesdroppers": [listener]}
    scenario = Scenario.from_dict(paper.to_dict() | {"origin": ORIGIN, "jammers": []} | threat)
    secret = replace(solution, scenario=scenario, links=evaluate(scenario, solution.pose))
    (feature,) = features(secret, "eavesdropper")
    np.testing.assert_allclose(local_m(feature["geometry"]["coordinates"]), [17, 15, 4], rtol=0, atol=1e-3)
    assert feature["properties"]["uncertainty_m"] == 3.0
    rates = [each["properties"]["secrecy_rate_bps_hz"] for each in features(secret, "node")]
    assert rates == [link.secrecy_rate_bps_hz for link in secret.links]
    assert features(secret, "jammer") == []


def test_without_an_origin(solution: Result, paper: Scenario) -> None:
    """A scenario that lies nowhere on the Earth is refused, with what to add."""
    nowhere = replace(solution, scenario=paper)
    for refused in (lambda: require_origin(paper), lambda: geojson_file(nowhere)):
        with pytest.raises(UsageError, match=r"has no origin.*add a table headed \[origin\]"):
            refused()


def test_a_file_is_the_collection(solution: Result) -> None:
    """The file holds the same, a feature a line; a number that JSON lacks is null."""
    silent = replace(solution, links=(Link("S1", {"sinr": 0.0, "sinr_db": -math.inf}), solution.links[1]))
    text = geojson_file(silent).decode()
    collection = json.loads(text)
    assert len(text.splitlines()) == len(collection["features"]) + 2
    values = [each["properties"].get("sinr_db") for each in collection["features"]]
    assert values[1:3] == [None, solution.links[1].sinr_db]
    assert collection["features"][3:] == json.loads(json.dumps(solution_geojson(solution)))["features"][3:]
