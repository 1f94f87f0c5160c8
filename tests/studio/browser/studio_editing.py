"""Editing in a real browser: points and zones added, selected, typed, dragged and deleted; undo and redo."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.chromium import pixels
from playwright.sync_api import Locator, Page

from nullpose import load, solve
from nullpose.studio.server import Studio
from nullpose.studio.session import Session

CERTIFIED = "document.querySelector('[data-np=status-0]')?.innerText.includes('certified to')"
_TOOL = "document.querySelector('[data-np=tool]')?.innerText"


class Hand:
    """What a user does in a page: clicks in the scene, presses, types.

    Args:
        page: the browser's side.
        ours: the server's side.
    """

    def __init__(self, page: Page, ours: Any) -> None:
        self.page, self.ours, self.session = page, ours, ours.session

    def _screen(self, point_m: Any) -> tuple[float, float]:
        canvas = self.page.locator("canvas").first.bounding_box()
        assert canvas is not None
        right, down, _ = pixels(self.ours._client.camera, [point_m])[0]
        x, y = canvas["x"] + float(right), canvas["y"] + float(down)
        assert canvas["x"] < x < canvas["x"] + canvas["width"], "it is out of sight"
        assert canvas["y"] < y < canvas["y"] + canvas["height"], "it is out of sight"
        return x, y

    def click(self, *point_m: float) -> None:
        """Click where a point of the scene is drawn."""
        self.page.mouse.click(*self._screen(point_m))
        self.page.wait_for_timeout(300)

    def tool(self, name: str) -> None:
        """Take up what the next click adds."""
        self.page.get_by_role("tab", name="Edit").click()
        self.page.get_by_role("button", name=name, exact=True).click()
        self.page.wait_for_function(f"{_TOOL}?.includes('lick')")

    def add(self, name: str, east_m: float, north_m: float) -> None:
        """Add a point or a zone with a click on the ground."""
        self.tool(name)
        before = self.session.state.version
        self.click(east_m, north_m, 0.0)
        self.until(lambda: self.session.state.version > before)

    def field(self, label: str) -> Locator:
        """Return the field of the panel that stands beside a label."""
        return self.page.locator(f"xpath=//*[text()='{label}']/ancestor::*[.//input][1]//input").first

    def typed(self, label: str, text: str) -> None:
        """Type a value into a field of the panel, key by key, and take it with Enter."""
        field = self.field(label)
        field.click()
        field.press("Control+A")
        field.press_sequentially(text, delay=60)
        field.press("Enter")

    def until(self, met: Callable[[], object]) -> None:
        """Wait until something holds."""
        for _ in range(200):
            if met():
                return
            self.page.wait_for_timeout(50)
        raise AssertionError("it did not happen in time")

    def certified(self) -> float:
        """Wait for the proof, and return the value that the page shows."""
        shown = (
            f"+document.querySelector('[data-np=readout]').dataset.version == {self.session.state.version}"
        )
        self.page.wait_for_function(f"{shown} && {CERTIFIED}")
        return float(self.page.locator("[data-np=value-0]").get_attribute("data-value") or "nan")


@pytest.fixture
def hand(page: Page, session: Session, running: Studio) -> Hand:
    """A hand on the shared page, which shows the paper's scene, nothing selected."""
    page.wait_for_timeout(500)
    page.mouse.move(400, 20)
    hand = Hand(page, next(one for one in running.pages.values() if one.session is session))
    page.keyboard.press("Escape")
    hand.ours.aim()  # another test may have turned the camera
    page.wait_for_timeout(1000)
    return hand


def test_a_click_selects_and_only_the_selected_has_values(hand: Hand) -> None:
    """Its name heads the fields; a click beside everything, or Escape, ends the selection."""
    scenario = hand.session.state.scenario
    hand.click(*scenario.nodes[1].position_m)
    hand.page.get_by_text("Selected: S2").wait_for()
    hand.click(*scenario.jammers[0].position_m)
    hand.page.get_by_text("Selected: M").wait_for()
    assert hand.field("power (W)").input_value() == "1"
    hand.page.keyboard.press("Escape")
    hand.page.get_by_text("Selected: M").wait_for(state="hidden")


def test_values_are_typed_and_refused_by_path(hand: Hand) -> None:
    """Enter takes a new place and a new power; what is not allowed is told and put back."""
    hand.click(*hand.session.state.scenario.jammers[0].position_m)
    hand.page.get_by_text("Selected: M").wait_for()
    hand.typed("east (m)", "20")
    hand.until(lambda: hand.session.state.scenario.jammers[0].position_m == (20.0, 15.0, 4.0))
    hand.typed("power (W)", "10")
    hand.until(lambda: hand.session.state.scenario.jammers[0].transmit_power_w == 10.0)
    assert hand.certified() == pytest.approx(solve(hand.session.state.scenario).objective.value, rel=1e-9)
    version = hand.session.state.version
    hand.typed("power (W)", "-3")
    hand.page.wait_for_function(
        "document.querySelector('[data-np=faults]').innerText.includes('jammers[0].power_w')"
    )
    hand.until(lambda: hand.field("power (W)").input_value() == "10")
    assert hand.session.state.version == version
    hand.field("antenna").click()
    hand.page.get_by_role("option", name="dipole").click()
    hand.until(lambda: hand.session.state.scenario.jammers[0].antenna == "dipole")


def test_points_and_zones_are_added_and_deleted_with_undo(hand: Hand) -> None:
    """Each click adds one; Delete takes it out; Ctrl+Z and Ctrl+Shift+Z go back and forth, not in fields."""
    before = hand.session.state.scenario
    hand.add("node", 25.0, 30.0)
    hand.page.get_by_text("Selected: S3").wait_for()
    hand.add("jammer", -12.0, 30.0)
    hand.add("no-fly zone", 15.0, 40.0)
    after = hand.session.state.scenario
    assert (len(after.nodes), len(after.jammers), len(after.airspace.no_fly)) == (3, 2, 1)
    assert after.nodes[2].position_m[:2] == pytest.approx((25.0, 30.0), abs=0.7)
    assert hand.certified() == pytest.approx(solve(after).objective.value, rel=1e-9)
    for _ in range(3):
        hand.page.keyboard.press("Control+z")
        hand.page.wait_for_timeout(300)
    assert hand.session.state.scenario == before
    for _ in range(3):
        hand.page.keyboard.press("Control+Shift+z")
        hand.page.wait_for_timeout(300)
    assert hand.session.state.scenario == after
    hand.click(*after.jammers[1].position_m)
    hand.page.get_by_text(f"Selected: {after.jammer_names[1]}").wait_for()
    hand.field("name").click()
    hand.page.keyboard.press("Control+z")
    hand.page.wait_for_timeout(300)
    assert hand.session.state.scenario == after
    hand.page.get_by_role("button", name="Delete", exact=True).click()
    hand.until(lambda: len(hand.session.state.scenario.jammers) == 1)
    hand.page.get_by_text("Selected:").wait_for(state="hidden")


def test_the_vehicle_and_its_airspace_are_typed(hand: Hand) -> None:
    """Tilt, mount and altitudes; the vehicle then keeps within its limit."""
    hand.page.get_by_role("tab", name="Edit").click()
    for label, text in (
        ("tilt limit (deg)", "20"),
        ("antenna mount (deg)", "90"),
        ("lowest altitude (m)", "10"),
    ):
        before = hand.session.state.version
        hand.typed(label, text)
        hand.until(lambda before=before: hand.session.state.version > before)
    scenario = hand.session.state.scenario
    assert scenario.airframe is not None
    assert (scenario.airframe.tilt_max_deg, scenario.airframe.mount_deg) == (20.0, 90.0)
    assert scenario.airspace.altitude_m == (10.0, 30.0)
    assert hand.certified() == pytest.approx(solve(scenario).objective.value, rel=1e-9)


def test_a_scene_built_with_the_mouse_alone_is_solved_alike(hand: Hand, tmp_path: Path) -> None:
    """Three nodes, two jammers and a fence; saved, and solved from the file: the same value."""
    page = hand.page
    page.get_by_role("tab", name="Edit").click()
    page.get_by_role("button", name="New scene").click()
    hand.until(lambda: len(hand.session.state.scenario.nodes) == 1)
    page.wait_for_timeout(1500)
    size_m = hand.ours.stage.size_m
    hand.add("node", 0.3 * size_m, 0.0)
    hand.add("node", 0.0, 0.3 * size_m)
    hand.add("jammer", 0.2 * size_m, 0.15 * size_m)
    hand.add("jammer", -0.1 * size_m, 0.1 * size_m)
    hand.tool("fence")
    corners = size_m * np.array([[-0.2, -0.15], [0.38, -0.15], [0.38, 0.4], [-0.2, 0.4], [-0.2, -0.15]])
    for east_m, north_m in corners:
        hand.click(east_m, north_m, 0.0)
    hand.until(lambda: hand.session.state.scenario.airspace.geofence_m is not None)
    scenario = hand.session.state.scenario
    assert (len(scenario.nodes), len(scenario.jammers)) == (3, 2)
    assert len(scenario.airspace.geofence_m or ()) == 4
    shown = hand.certified()
    page.get_by_role("tab", name="Files").click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Save scenario").click()
    saved = tmp_path / "built.toml"
    download.value.save_as(saved)
    assert solve(load(saved)).objective.value == pytest.approx(shown, rel=1e-9)
