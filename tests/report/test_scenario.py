"""What a scenario amounts to before it is solved."""

import io
import math
import re

import pytest

from nullpose import Scenario, load
from nullpose.report.scenario import scenario_view, summarise


def test_powers_in_both_units(paper: Scenario, field: Scenario) -> None:
    """Watts and dBm agree, whichever was stated."""
    for scenario in (paper, field):
        summary = summarise(scenario)
        for point in (*summary["nodes"], *summary["jammers"]):
            assert point["power_dbm"] == pytest.approx(10.0 * math.log10(1e3 * point["power_w"]))
        assert summary["noise_dbm"] == pytest.approx(10.0 * math.log10(1e3 * summary["noise_w"]))


def test_no_pose_beats_the_best_ratio(field: Scenario) -> None:
    """Each node's link at the optimum stays below what the summary says it can carry."""
    from nullpose import solve

    summary = summarise(field)
    for link, node in zip(solve(field).links, summary["nodes"], strict=True):
        assert link.sinr_db <= node["best_power_to_noise_db"] + 1e-9


def test_nearest_point_respects_airspace_and_keep_out(paper: Scenario) -> None:
    """The closest the drone may come is set by the sides of the airspace, or by the keep-out radius."""
    data = paper.to_dict() | {"airspace": {"altitude_m": [0.0, 30.0], "x_m": [3.0, 9.0], "keep_out_m": 2.0}}
    summary = summarise(Scenario.from_dict(data))
    assert [node["nearest_m"] for node in summary["nodes"]] == [3.0, 3.0]
    wide = paper.to_dict() | {"airspace": {"altitude_m": [0.0, 30.0], "keep_out_m": 2.0}}
    assert [node["nearest_m"] for node in summarise(Scenario.from_dict(wide))["nodes"]] == [2.0, 2.0]


def test_many_buildings_are_counted() -> None:
    """More than twelve have one row, with their extent."""
    from rich.console import Console

    town = load("examples/town.toml")
    many = [
        {"polygon_m": [[x, 20.0], [x + 5.0, 20.0], [x, 40.0]], "height_m": 6.0 + x, "base_m": 3.0}
        for x in range(0, 130, 10)
    ]
    console = Console(width=160, file=io.StringIO())
    console.print(scenario_view(Scenario.from_dict(town.to_dict() | {"buildings": many})))
    assert re.search(r"all 13 +x 0 to 125, y 20 to 40 +6 to 126 +3\b", console.file.getvalue())
