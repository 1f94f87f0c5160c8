"""Editing in a real browser: points and zones added, selected, typed and deleted; what is typed is solved."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.studio.browser.hand import PAPER, Hand

from nullpose import Scenario, load, solve
from nullpose.scenario import Node, NoFlyZone
from nullpose.studio.edits import Entry, entries_of
from nullpose.studio.state import Key, State

JAMMER: Key = ("jammers", 0)


def _add(hand: Hand, name: str, east_m: float, north_m: float) -> None:
    """Add a point or a zone with a click on the ground."""
    hand.take_tool(name)
    version = hand.session.state.version
    hand.click(east_m, north_m, 0.0)
    hand.until(lambda: hand.session.state.version > version)


def _select(hand: Hand, key: Key | None) -> None:
    """Show the values of a point or a zone, as a click on it does; those of the vehicle without one."""
    hand.ours.change(lambda state: replace(state, selected=key))
    hand.tab("Edit")
    hand.page.wait_for_timeout(300)


def _entry(state: State, key: Key | None, label: str) -> Entry:
    return next(entry for entry in entries_of(state, key) if entry.label == label)


def _agree(hand: Hand, key: Key | None, label: str, text: str) -> None:
    """Wait for a typed value to be solved, and check field, scenario and solved scenario."""
    case = hand.session.state.case
    hand.until(lambda: _entry(hand.session.state, key, label).text == text)
    hand.until(lambda: hand.session.state.current(case))
    answer = hand.session.state.current(case)
    assert answer is not None
    assert _entry(State(scenario=answer.result.scenario), key, label).text == text
    hand.until(lambda: hand.field(label).input_value() == text)


def test_a_click_selects_and_only_the_selected_has_values(hand: Hand) -> None:
    """Its name heads the fields; a click beside everything, or Escape, ends the selection."""
    hand.click(*PAPER.nodes[1].position_m)
    hand.page.get_by_text("Selected: S2").wait_for()
    hand.click(*PAPER.jammers[0].position_m)
    hand.page.get_by_text("Selected: M").wait_for()
    assert hand.field("power (W)").input_value() == "1"
    hand.page.keyboard.press("Escape")
    hand.page.get_by_text("Selected: M").wait_for(state="hidden")


def test_points_and_zones_are_added_and_deleted_with_undo(hand: Hand) -> None:
    """Each click adds one; Delete takes it out; Ctrl+Z and Ctrl+Shift+Z go back and forth, not in fields."""
    keyboard = hand.page.keyboard
    _add(hand, "node", 25.0, 30.0)
    hand.page.get_by_text("Selected: S3").wait_for()
    _add(hand, "jammer", -12.0, 30.0)
    _add(hand, "no-fly zone", 15.0, 40.0)
    after = hand.scenario
    assert (len(after.nodes), len(after.jammers), len(after.airspace.no_fly)) == (3, 2, 1)
    assert after.nodes[2].position_m[:2] == pytest.approx((25.0, 30.0), abs=0.7)
    assert hand.certified() == pytest.approx(solve(after).objective.value, rel=1e-9)
    for keys, scenario in (("Control+z", PAPER), ("Control+Shift+z", after)):
        for _ in range(3):
            keyboard.press(keys)
            hand.page.wait_for_timeout(300)
        assert hand.scenario == scenario
    hand.click(*after.jammers[1].position_m)
    hand.page.get_by_text(f"Selected: {after.jammer_names[1]}").wait_for()
    hand.field("name").click()
    keyboard.press("Control+z")
    hand.page.wait_for_timeout(300)
    assert hand.scenario == after
    hand.press("Delete")
    hand.until(lambda: len(hand.scenario.jammers) == 1)
    hand.page.get_by_text("Selected:").wait_for(state="hidden")


def test_a_scene_built_with_the_mouse_alone_is_solved_alike(hand: Hand, tmp_path: Path) -> None:
    """Two nodes, a jammer and a fence; saved, and solved from the file: the same value."""
    hand.tab("Files")
    hand.press("New scene")
    hand.tab("Edit")
    hand.until(lambda: len(hand.scenario.nodes) == 1)
    hand.page.wait_for_timeout(1500)
    size_m = hand.ours.stage.size_m
    _add(hand, "node", 0.3 * size_m, 0.0)
    _add(hand, "jammer", 0.2 * size_m, 0.15 * size_m)
    hand.take_tool("fence")
    corners = size_m * np.array([[-0.2, -0.15], [0.38, -0.15], [0.38, 0.4], [-0.2, 0.4], [-0.2, -0.15]])
    for east_m, north_m in corners:
        hand.click(east_m, north_m, 0.0)
    hand.until(lambda: hand.scenario.airspace.geofence_m is not None)
    assert (len(hand.scenario.nodes), len(hand.scenario.jammers)) == (2, 1)
    assert len(hand.scenario.airspace.geofence_m or ()) == 4
    shown, saved = hand.certified(), hand.download("Save scenario", tmp_path / "built.toml")
    assert solve(load(saved)).objective.value == pytest.approx(shown, rel=1e-9)


@pytest.mark.parametrize("delay_ms", [0, 20])
def test_a_power_is_solved_as_it_was_typed(hand: Hand, delay_ms: float) -> None:
    """Several powers of a jammer at each speed, the last one with its proof; an antenna is chosen."""
    _select(hand, JAMMER)
    for text in ("36", "7", "12.5", "0.75", "5.125", "23"):
        hand.type("power (W)", text, delay_ms)
        _agree(hand, JAMMER, "power (W)", text)
    assert hand.scenario.jammers[0].power_w == 23.0
    assert hand.certified() == pytest.approx(solve(hand.scenario).objective.value, rel=1e-9)
    hand.field("antenna").click()
    hand.page.get_by_role("option", name="dipole").click()
    hand.until(lambda: hand.scenario.jammers[0].antenna == "dipole")


FIELDS: dict[Key | None, dict[str, str]] = {
    ("nodes", 0): {"east (m)": "-12.25", "north (m)": "31", "up (m)": "1.5", "power (dBm)": "27.5"},
    ("jammers", 0): {"east (m)": "21", "power (W)": "1e-05", "position error (m)": "2.5"},
    ("no_fly", 0): {"centre (m)": "[35, -12.5]", "radius (m)": "11", "altitudes (m)": "[0, 25]"},
    ("no_fly", 1): {"west, east (m)": "[50, 61]", "south, north (m)": "[10, 20.5]"},
    None: {
        "tilt limit (deg)": "22.5",
        "antenna mount (deg)": "36",
        "lowest altitude (m)": "10",
        "highest altitude (m)": "45",
        "fence corners (m)": "[[-40, -40], [60, -40], [60, 60], [-40, 60]]",
        "distance to points (m)": "4.5",
    },
}


def _everything() -> Scenario:
    """Return the paper's scene with every kind of field that a page has for numbers."""
    first, second = PAPER.nodes
    node = Node(name=first.name, position_m=first.position_m, power_dbm=30.0)
    zones = (
        NoFlyZone(name="Z1", centre_m=(40.0, -10.0), radius_m=5.0),
        NoFlyZone(name="Z2", x_m=(50.0, 60.0), y_m=(0.0, 10.0)),
    )
    airspace = PAPER.airspace.model_copy(update={"no_fly": zones})
    return PAPER.model_copy(update={"nodes": (node, second), "airspace": airspace})


def test_every_field_takes_the_number_that_stands_in_it(hand: Hand) -> None:
    """Of points, zones, vehicle and airspace: numbers and lists, with Enter and by leaving the field."""
    hand.session.change(lambda view: view.with_scenario(_everything()))
    for key, texts in FIELDS.items():
        _select(hand, key)
        for i, (label, text) in enumerate(texts.items()):
            hand.type(label, text, 5.0, ends="Tab" if i % 2 else "Enter")
            _agree(hand, key, label, text)
    assert hand.certified() == pytest.approx(solve(hand.scenario).objective.value, rel=1e-9)


def test_the_jamming_power_is_the_one_in_its_field(hand: Hand) -> None:
    """In decibels, to a millionth: no keystroke takes it, but Enter, leaving, and a click into the scene."""
    session, field = hand.session, hand.field("typed (dB)")
    texts = {"36": "36", "-12.3456789": "-12.345679", "1e1": "10", "\N{MINUS SIGN}7.5": "-7.5", "+7.0e0": "7"}
    for text, taken in texts.items():
        hand.type("typed (dB)", text)
        hand.until(lambda taken=taken: session.state.power_text == field.input_value() == taken)
        assert session.state.power_db == pytest.approx(float(taken), abs=1e-9)
    hand.type("typed (dB)", "+7.0e0")  # nothing changes, and it is written back all the same
    hand.until(lambda: field.input_value() == "7")
    hand.type("typed (dB)", "17", ends="Escape")
    hand.until(lambda: field.input_value() == "7")
    field.press("Tab")
    version = session.state.version
    field.click()
    field.press("Control+A")
    field.press_sequentially("25", delay=120)
    hand.page.wait_for_timeout(500)
    assert session.state.version == version
    hand.page.mouse.click(500, 400)
    hand.until(lambda: session.state.power_text == "25")
    assert hand.scenario.jammers[0].power_w == pytest.approx(10.0**2.5, rel=1e-9)


@pytest.mark.parametrize("text", ["abc", "", "-3"])
def test_what_is_no_power_is_refused_in_words(hand: Hand, text: str) -> None:
    """The value that holds is put back, for a jammer and for the whole scene, and nothing is solved anew."""
    _select(hand, JAMMER)
    version = hand.session.state.version
    field = hand.type("power (W)", text)
    hand.refused("jammers[0]")
    hand.until(lambda: field.input_value() == "1")
    hand.tab("Scene")
    field = hand.type("typed (dB)", text.replace("-3", "-99"))
    hand.refused("allowed: a number from")
    hand.until(lambda: field.input_value() == "0")
    assert hand.session.state.version == version


def test_a_change_from_elsewhere_leaves_what_is_being_typed(hand: Hand) -> None:
    """It is taken with Enter, as it stands there."""
    _select(hand, JAMMER)
    field = hand.field("power (W)")
    field.click()
    field.press("Control+A")
    field.press_sequentially("36")
    hand.session.change(lambda view: view.with_power_db(13.0))
    hand.page.wait_for_timeout(700)
    assert field.input_value() == "36"
    field.press("Enter")
    _agree(hand, JAMMER, "power (W)", "36")
