"""On a touch phone and elsewhere: what is in sight, what never is, and whether it can be read."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.chromium import pixels
from playwright.sync_api import Browser, Page

from nullpose.scenario import Scenario
from nullpose.studio.camera import CARD_PX
from nullpose.studio.server import Studio, studio

CERTIFIED = "document.querySelector('[data-np=overlay-status-0]')?.innerText.includes('certified to')"
DESK: dict[str, Any] = {"viewport": {"width": 1280, "height": 800}, "device_scale_factor": 1}
PHONE: dict[str, Any] = {
    "viewport": {"width": 390, "height": 844},
    "device_scale_factor": 2,
    "has_touch": True,
    "is_mobile": True,
}
WATCH = """
window.seen = new Set();
(function watch() {
  for (const one of document.querySelectorAll("input, svg, p, button, a, label")) {
    const own = one.value?.startsWith?.("ws:") ? one.value
      : /-(share|adjustments|arrow-back)\\b/.test(one.getAttribute("class")) ? one.getAttribute("class")
      : /^(Scene tree|Save Canvas|Reset View|Dev Settings)$/.test(one.textContent) ? one.textContent
      : one.title === "About Viser" ? one.title : undefined;
    if (own && one.checkVisibility()) window.seen.add(own);
  }
  requestAnimationFrame(watch);
})();
"""


@contextmanager
def _opened(browser: Browser, alone: Studio, **more: Any) -> Iterator[tuple[Page, Any]]:
    """Opens the studio in a browser of its own, up to the first proof, and yields both its sides."""
    context = browser.new_context(**more)
    page = context.new_page()
    page.set_default_timeout(90_000)
    page.add_init_script(WATCH)
    page.goto(alone.address)
    page.wait_for_function(CERTIFIED)
    page.wait_for_timeout(1500)
    for button in page.locator("button.mantine-Notification-closeButton").all():
        button.click()  # the notice that there is no graphics card
    (ours,) = alone.pages.values()
    try:
        yield page, ours
    finally:
        context.close()


def _drone_is_in_sight(page: Page, ours: Any) -> bool:
    answer = ours.session.state.answer(ours.session.state.case)
    x, y, ahead = pixels(ours._client.camera, [answer.result.pose.position_m])[0]
    size = page.viewport_size
    card = page.locator("#np-overlay").bounding_box()
    assert size is not None
    assert card is not None
    under = x < card["x"] + card["width"] and y < card["y"] + card["height"]
    return bool(ahead > 0.0 and 0.0 < x < size["width"] and 0.0 < y < size["height"] and not under)


def test_a_touch_phone_shows_the_scene_first(browser: Browser, alone: Studio) -> None:
    """The panel is folded until its title is tapped; points and drone are in sight, below the card."""
    with _opened(browser, alone, **PHONE) as (page, ours):
        readout, title = page.locator("[data-np=readout]"), page.get_by_text("nullpose studio")
        assert not readout.is_visible()
        scenario, camera = ours.session.state.scenario, ours._client.camera
        assert (camera.image_width, camera.image_height) == (390, 844)
        points = pixels(camera, [point.position_m for point in (*scenario.nodes, *scenario.jammers)])
        assert np.all((points[:, :2] > [0.0, CARD_PX[1]]) & (points[:, :2] < [390.0, 844.0]))
        assert _drone_is_in_sight(page, ours)
        card = page.locator("#np-overlay").bounding_box()
        assert card is not None
        assert (card["x"] + card["width"], card["y"] + card["height"]) < (CARD_PX[0], CARD_PX[1] + 16)
        title.tap()
        readout.wait_for(state="visible")
        title.tap()
        readout.wait_for(state="hidden")


@pytest.mark.parametrize("device", [PHONE, DESK], ids=["phone", "desk"])
def test_the_panel_of_viser_never_shows(
    browser: Browser, paper: Scenario, device: dict[str, Any], words: Any
) -> None:
    """Not while the page is loaded, nor while it connects again, nor when the studio has ended."""
    words.expected = ["ERR_CONNECTION_REFUSED", "WebSocket connection"]
    with studio(paper, port=0) as alone, _opened(browser, alone, **device) as (page, first):
        alone._server._websock_server.disconnect_all_clients()
        while list(alone.pages.values()) in ([], [first]):
            page.wait_for_timeout(100)
        page.wait_for_timeout(2000)
        alone._server.stop()
        page.wait_for_selector("#np-overlay[data-state=ended]")
        page.wait_for_timeout(500)
        assert page.evaluate("[...window.seen]") == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_text_can_be_read(browser: Browser, alone: Studio, scheme: str) -> None:
    """A contrast of 4.5 to 1 in the panel, tab by tab, and on the card."""
    script = (Path(__file__).parent / "contrast.js").read_text(encoding="utf-8")
    with _opened(browser, alone, color_scheme=scheme, **DESK) as (page, ours):
        ours.change(lambda state: replace(state, selected=("jammers", 0)))
        for tab in ("Scene", "Edit", "Map and view", "Files"):
            page.get_by_role("tab", name=tab).click()
            page.wait_for_timeout(400)
            found = page.evaluate(script)
            assert len(found) > 30
            assert [one for one in found if one["ratio"] < 4.5] == []
