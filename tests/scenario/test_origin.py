"""Points by latitude and longitude, and the origin from which they get their metres."""

import json
import tomllib
from typing import Any

import numpy as np
import pytest

from nullpose.scenario import Origin, Scenario
from nullpose.scenario.geodesy import enu_from_geodetic
from scenes import require_fault, small

ORIGIN = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 230.0}
HERE = {"lat_deg": 50.001, "lon_deg": 14.502, "alt_m": 232.0}
THERE = {"lat_deg": 50.002, "lon_deg": 14.501, "alt_m": 231.0}
NAN = float("nan")


def data(**changes: Any) -> dict[str, Any]:
    """Returns a scenario with two nodes and a jammer by latitude and longitude; None takes a key away."""
    whole = {"origin": ORIGIN, "nodes": [{"power_w": 1.0} | HERE, {"power_w": 2.0} | THERE]}
    jammer = {"power_w": 3.0, "lat_deg": 50.0015, "lon_deg": 14.503, "alt_m": 230.0}
    return small(**whole | {"jammers": [jammer]} | changes)


def without(table: dict[str, Any], key: str) -> dict[str, Any]:
    """Return a table less one of its keys."""
    return {other: value for other, value in table.items() if other != key}


def test_positions_follow_from_the_origin() -> None:
    """Every point has its position in metres from the origin, and keeps what was stated."""
    scenario = Scenario.from_dict(data())
    places = [[50.001, 14.502, 232.0], [50.002, 14.501, 231.0]]
    expected = enu_from_geodetic(places, [50.0, 14.5, 230.0])
    np.testing.assert_array_equal(scenario.node_positions_m, expected)
    assert scenario.jammer_positions_m[0] == pytest.approx([215.1, 166.8, 0.0], abs=0.1)
    assert (scenario.nodes[0].lat_deg, scenario.nodes[0].alt_m) == (50.001, 232.0)
    assert scenario.origin == Origin(**ORIGIN)


def test_written_and_read_back() -> None:
    """What is written holds both the metres and the latitude, and loads as an equal scenario."""
    scenario = Scenario.from_dict(data())
    assert Scenario.from_dict(json.loads(json.dumps(scenario.to_dict(), allow_nan=False))) == scenario
    assert Scenario.from_dict(tomllib.loads(scenario.to_toml())) == scenario
    assert scenario.to_dict()["nodes"][0].keys() == {"name", "position_m", *HERE, "power_w"}
    assert scenario.to_dict()["origin"] == ORIGIN
    assert scenario.model_copy(update={"name": "again"}).nodes == scenario.nodes


def test_a_position_that_was_written_is_kept_to_the_last_bit() -> None:
    """A position that differs from its latitude in the last digits only is taken as it stands."""
    written = Scenario.from_dict(data()).to_dict()
    written["nodes"][0]["position_m"][0] += 1e-9
    moved = Scenario.from_dict(written)
    assert list(moved.nodes[0].position_m) == written["nodes"][0]["position_m"]


LOCAL = {"power_w": 1.0, "position_m": [1.0, 2.0, 3.0]}
FIRST, SECOND = {"power_w": 1.0} | HERE, {"power_w": 1.0} | THERE
PLACE = enu_from_geodetic([50.001, 14.502, 232.0], [50.0, 14.5, 230.0])
NUMBERS = [
    ("lat_deg", 91.0, "got 91.0, must be a latitude in degrees from -90 to 90"),
    ("lat_deg", NAN, "got NaN, must be a latitude"),
    ("lon_deg", 180.5, "got 180.5, must be a longitude in degrees from -180 to 180"),
    ("lon_deg", "14.5", "write it without quotes"),
    ("alt_m", 2e5, "must be an altitude in m over the WGS-84 ellipsoid from -10000 to 100000"),
    ("alt_m", [1.0], "got a list of one value, must be a number"),
]


APART = FIRST | {"position_m": (PLACE + np.array([3.0, 4.0, 0.0])).tolist()}
EXCHANGED = FIRST | {"lat_deg": 14.5, "lon_deg": 50.0}


@pytest.mark.parametrize(
    ("changes", "path", "words"),
    [
        *(({"origin": ORIGIN | {key: value}}, f"origin.{key}", words) for key, value, words in NUMBERS),
        *(({"nodes": [FIRST, SECOND | {k: value}]}, f"nodes[1].{k}", words) for k, value, words in NUMBERS),
        ({"origin": None}, "origin", "missing, but nodes[0] is stated by lat_deg, lon_deg and alt_m"),
        ({"jammers": [LOCAL]}, "jammers[0]", "by position_m, but nodes[0] by lat_deg, lon_deg and alt_m"),
        ({"nodes": [LOCAL]}, "jammers[0]", "by lat_deg, lon_deg and alt_m, but nodes[0] by position_m"),
        ({"nodes": [APART]}, "nodes[0]", "are 5 m apart, must be one place"),
        ({"nodes": [EXCHANGED]}, "nodes[0]", "km from the origin, must be within 100 km"),
        ({"nodes": [EXCHANGED]}, "nodes[0]", "are latitude and longitude exchanged"),
        ({"nodes": [without(FIRST, "lat_deg")]}, "nodes[0]", "without lat_deg; add it, or position_m"),
        ({"nodes": [without(FIRST, "lon_deg")]}, "nodes[0]", "without lon_deg; add it, or position_m"),
        ({"nodes": [without(FIRST, "alt_m")]}, "nodes[0]", "add it, or position_m"),
        ({"origin": without(ORIGIN, "lat_deg")}, "origin.lat_deg", "missing; it must be given"),
        ({"origin": without(ORIGIN, "lon_deg")}, "origin.lon_deg", "missing; it must be given"),
        ({"origin": without(ORIGIN, "alt_m")}, "origin", "neither alt_m nor alt_msl_m is given"),
    ],
)
def test_faults_of_places(changes: dict[str, Any], path: str, words: str) -> None:
    """Numbers out of range, a key left out, no origin, mixed points and exchanges are one fault each."""
    require_fault(lambda: Scenario.from_dict(data(**changes)), path, words)


def test_both_ways_in_one_point() -> None:
    """A point may be stated both ways if they agree."""
    assert Scenario.from_dict(data(nodes=[FIRST | {"position_m": PLACE}])).nodes[0].lat_deg == 50.001


def test_a_copy_with_another_position_has_no_latitude() -> None:
    """A point that is moved in metres forgets its place on the Earth; any other copy keeps it."""
    scenario = Scenario.from_dict(data())
    moved = scenario.jammers[0].model_copy(update={"position_m": (1.0, 2.0, 3.0)})
    assert (moved.lat_deg, moved.lon_deg, moved.alt_m) == (None, None, None)
    assert scenario.model_copy(update={"jammers": [moved]}).jammers[0].position_m == (1.0, 2.0, 3.0)
    assert scenario.jammers[0].model_copy(update={"power_w": 9.0}).lat_deg == 50.0015
