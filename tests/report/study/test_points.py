"""Combinations of swept values in words."""

import copy
from typing import Any

import pytest

from nullpose.report.study.points import SweptPoints
from nullpose.study.monte_carlo import StudySpec

SPEC: dict[str, Any] = {
    "scenes": 1,
    "scene": {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [
            {"position_m": [0.0, 0.0, 0.0], "power_w": 2.0},
            {"position_m": [9.0, 0.0, 0.0], "power_w": 2.0},
        ],
        "jammers": [{"name": "M", "position_m": [0.0, 9.0, 0.0], "power_w": 2.0}],
    },
}


def _points(sweep: dict[str, Any], **changes: Any) -> SweptPoints:
    return SweptPoints.of(StudySpec.from_dict(copy.deepcopy(SPEC) | {"sweep": sweep} | changes))


def test_one_jammers_power_is_a_ratio() -> None:
    """Written as in the paper where all nodes send with the same power."""
    points = _points({"jammers.M.power_w": [0.2, 200.0]})
    assert [points.words(point) for point in (0, 1)] == ["P_M/P = 0.1", "P_M/P = 100"]
    assert points.axis_label("jammers.M.power_w").startswith("$P_M / P$")
    drawn = {"layout": "disc", "count": 1, "centre_m": [0.0, 0.0], "radius_m": 9.0, "power_dbm": 30.0}
    assert _points({"jammers.M.power_w": [10.0]}, nodes=drawn).words(0) == "P_M/P = 10"


@pytest.mark.parametrize(
    "nodes",
    [
        {"layout": "disc", "count": 2, "centre_m": [0, 0], "radius_m": 9, "power_w": {"uniform": [1, 2]}},
        {"layout": "disc", "count": 2, "centre_m": [0, 0], "radius_m": 9, "power_w": {"choice": [1, 2]}},
    ],
)
def test_no_ratio_of_nodes_that_differ(nodes: dict[str, Any]) -> None:
    """Then the path stands with its unit."""
    assert _points({"jammers.M.power_w": [5.0]}, nodes=nodes).words(0) == "jammers.M.power_w = 5 W"


def test_no_ratio_of_several_jammers() -> None:
    """Of more than one jammer, one's power over a node's would say too little."""
    jammers = {"layout": "disc", "count": [1, 2], "centre_m": [0, 0], "radius_m": 9, "power_w": 1}
    assert _points({"jammers.M1.power_w": [5.0]}, jammers=jammers).words(0) == "jammers.M1.power_w = 5 W"


def test_grids() -> None:
    """Values stand side by side; curves run along the longest path, at the last values of the others."""
    points = _points({"receiver.noise_w": [1e-3, 1e-2], "jammers.M.power_w": [2.0, 4.0, 8.0]})
    assert points.words(5) == "receiver.noise_w = 0.01 W, P_M/P = 4"
    assert (points.longest, points.along) == ("jammers.M.power_w", (3, 4, 5))
    assert points.shown == (0, 1, 2, 3, 4, 5)


def test_few_of_many_are_shown() -> None:
    """The first and the last are always among them."""
    points = _points({"jammers.M.power_w": {"from": 1.0, "to": 100.0, "points": 37, "spacing": "log"}})
    assert len(points.shown) == 6
    assert (points.shown[0], points.shown[-1]) == (0, 36)
    nothing = _points({})
    assert (nothing.words(0), nothing.longest, nothing.shown, nothing.along) == ("", "", (0,), (0,))
