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


def test_buildings_have_a_table() -> None:
    """A row for each, up to twelve; more are counted, with their extent; and what a blocked link loses."""
    from rich.console import Console

    town = load("examples/town.toml")
    many = [
        {"polygon_m": [[x, 20.0], [x + 5.0, 20.0], [x, 40.0]], "height_m": 6.0 + x, "base_m": 3.0}
        for x in range(0, 130, 10)
    ]
    texts = []
    for scenario in (town, Scenario.from_dict(town.to_dict() | {"buildings": many})):
        console = Console(width=160, file=io.StringIO())
        console.print(scenario_view(scenario))
        texts.append(console.file.getvalue())
    assert all(building.name in texts[0] for building in town.buildings)
    assert "x -34 to -14, y 12 to 40" in texts[0]
    assert "9 to 11" in texts[0]
    assert "base (m)" not in texts[0]
    for text in texts:
        assert re.search(r"loss of a blocked link \(dB\) +19\b", text)
    assert re.search(r"all 13 +x 0 to 125, y 20 to 40 +6 to 126 +3\b", texts[1])


def test_tables_name_everything(field: Scenario) -> None:
    """Every node and jammer has its row, even where a name looks like markup."""
    from rich.console import Console

    data = field.to_dict()
    data["nodes"][0]["name"] = "[bold]gate[/]"
    console = Console(width=160, file=io.StringIO())
    console.print(scenario_view(Scenario.from_dict(data)))
    text = console.file.getvalue()
    assert "[bold]gate[/]" in text
    assert all(name in text for name in (*field.node_names[1:], *field.jammer_names))
