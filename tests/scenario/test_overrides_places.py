"""Overrides of places: a position in metres, a latitude, and the origin itself."""

import numpy as np
import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario, apply_overrides
from nullpose.scenario.geodesy import enu_from_geodetic

ORIGIN = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 230.0}
POINT = {"lat_deg": 50.001, "lon_deg": 14.502, "alt_m": 232.0, "power_w": 1.0}
EARTHLY = Scenario.from_dict(
    {
        "origin": ORIGIN,
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [POINT, POINT | {"lat_deg": 50.002}],
    }
)


def test_a_latitude_moves_its_point_alone() -> None:
    """A new latitude gives its point a new position; the others keep theirs to the last bit."""
    changed = apply_overrides(EARTHLY, ["nodes.S1.lat_deg=50.003"])
    place = enu_from_geodetic([50.003, 14.502, 232.0], list(ORIGIN.values()))
    np.testing.assert_array_equal(changed.node_positions_m[0], place)
    np.testing.assert_array_equal(changed.node_positions_m[1], EARTHLY.node_positions_m[1])


@pytest.mark.parametrize("override", ["nodes.S1.position_m=[5, 222, 2]", "nodes.S1.position_m[0]=5"])
def test_metres_replace_the_latitude(override: str) -> None:
    """A position in metres, or one of its numbers, replaces the place on the Earth."""
    changed = apply_overrides(EARTHLY, [override])
    assert changed.nodes[0].position_m[0] == 5.0
    assert changed.nodes[0].lat_deg is None
    assert changed.nodes[1] == EARTHLY.nodes[1]


@pytest.mark.parametrize(
    "override", ["origin.lat_deg=50.001", "origin={lat_deg = 50.001, lon_deg = 14.5, alt_m = 230.0}"]
)
def test_the_points_stay_on_the_earth_when_the_origin_moves(override: str) -> None:
    """Positions in metres change with the origin, latitudes do not."""
    changed = apply_overrides(EARTHLY, [override])
    place = enu_from_geodetic([50.001, 14.502, 232.0], [50.001, 14.5, 230.0])
    np.testing.assert_array_equal(changed.node_positions_m[0], place)
    assert changed.nodes[0].lat_deg == 50.001


@pytest.mark.parametrize(
    ("override", "path", "words"),
    [
        ("nodes.S1.lat_deg=95", "nodes[0].lat_deg", "got 95, must be a latitude"),
        ("origin.lat_deg=20", "nodes[0]", "km from the origin"),
        ("origin.lat=20", "origin.lat", "did you mean origin.lat_deg?"),
        ("nodes_from=nodes.csv", "nodes_from", "only a scenario file on this machine may name"),
    ],
)
def test_what_cannot_be(override: str, path: str, words: str) -> None:
    """An override of a place is judged as the scenario would be with it."""
    with pytest.raises(ScenarioError) as caught:
        apply_overrides(EARTHLY, [override])
    assert caught.value.faults[0].path == path
    assert words in caught.value.faults[0].message
