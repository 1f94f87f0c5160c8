"""Every number of the page is the one that ``nullpose solve --json`` prints, and the map's best the value."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
from tests.studio.browser.hand import EXAMPLES, Hand
from typer.testing import CliRunner

from nullpose import load
from nullpose.cli.app import app
from nullpose.scenario import Scenario
from nullpose.studio.state import State


def _solved(scenario: Scenario, folder: Path) -> dict[str, Any]:
    """Return what the command line prints of a scenario that the page has saved."""
    path = folder / "scene.toml"
    path.write_text(scenario.to_toml(), encoding="utf-8")
    result = CliRunner().invoke(app, ["solve", str(path), "--json"])
    assert result.exit_code == 0, result.stderr
    return dict(json.loads(result.stdout))


def _expected(solved: dict[str, Any], scenario: Scenario) -> list[str]:
    """Return the numbers in the order of the panel, printed as it prints them."""
    is_rate, numbers = scenario.objective == "secrecy-rate", []
    for link in solved["links"]:
        numbers.append(f"{link['sinr_db']:.2f}")
        numbers += [f"{link['margin_db']:.2f}"] if "margin_db" in link else []
        numbers += [f"{link['secrecy_rate_bps_hz']:.3f}"] if is_rate else []
    pose = solved["pose"]
    numbers += [f"{metres:.2f}" for metres in pose["position_m"]]
    numbers += [f"{math.degrees(pose[key]):.1f}" for key in ("roll_rad", "pitch_rad", "yaw_rad", "tilt_rad")]
    return [re.sub(r"^-(0\.0*)$", r"\1", number) for number in numbers]


def _shown(hand: Hand) -> list[str]:
    """Return the numbers of the panel, in their order, without those that are parts of names."""
    text, scenario = (
        hand.page.locator("[data-np=numbers-0]").inner_text().replace("\u2212", "-"),
        hand.scenario,
    )
    names = (*scenario.node_names, *scenario.jammer_names, *scenario.eavesdropper_names)
    for name in sorted(names, key=len, reverse=True):
        text = text.replace(name, "")
    return re.findall(r"-?\d+\.\d+", text)


@pytest.mark.parametrize("name", ["array", "eavesdropper", "field", "frame", "geodetic", "requirements"])
def test_the_page_has_the_numbers_of_the_command_line(name: str, hand: Hand, tmp_path: Path) -> None:
    """To the printed digits: every node and the pose; and the map's best to .01 dB."""
    scenario = load(EXAMPLES / f"{name}.toml", allow_outside=True)
    hand.session.change(lambda view: State(scenario=scenario))
    value = hand.certified()
    one_antenna = scenario.model_copy(update={"array": None})  # the page shows no array, and says so
    solved = _solved(one_antenna, tmp_path)
    assert _shown(hand) == _expected(solved, one_antenna)
    assert value == pytest.approx(solved["objective"]["value"], rel=1e-12)
    assert hand.shown("overlay-value-0") == value
    hand.until(lambda: hand.session.state.field_map is not None, 90.0)
    state = hand.session.state
    assert state.field_map.best.best[0] == pytest.approx(state.current(state.case).shown_value, abs=0.01)
