"""What is around the picture, at a desk and on a phone: colours, loading again, the card, the connection."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from benchmarks.chromium import pixels
from playwright.sync_api import Browser
from tests.studio.browser.hand import DESK, PAPER, PHONE, Hand, opened

from nullpose.studio.camera import PHONE_CARD_PX
from nullpose.studio.server import Studio, studio

CONTRAST = (Path(__file__).parent / "contrast.js").read_text(encoding="utf-8")
DARK = "document.documentElement.dataset.mantineColorScheme"
WATCH = """
window.seen = new Set();
(function watch() {
  for (const each of document.querySelectorAll("input, svg, p, button, a, label")) {
    const own = each.value?.startsWith?.("ws:") ? each.value
      : /-(share|adjustments|arrow-back)\\b/.test(each.getAttribute("class")) ? each.getAttribute("class")
      : /^(Scene tree|Save Canvas|Reset View|Dev Settings)$/.test(each.textContent) ? each.textContent
      : each.title === "About Viser" ? each.title : undefined;
    if (own && each.checkVisibility()) window.seen.add(own);
  }
  requestAnimationFrame(watch);
})();
"""
"""Looks for what is viser's own in each frame."""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_has_the_systems_colours_and_every_text_can_be_read(
    browser: Browser, alone: Studio, scheme: str
) -> None:
    """A contrast of 4.5 to 1 in the panel, tab by tab, and on the card."""
    with opened(browser, alone, color_scheme=scheme) as hand:
        assert hand.page.evaluate(DARK) == scheme
        hand.ours.change(lambda state: replace(state, selected=("jammers", 0)))
        for tab in ("Scene", "Edit", "Map and view", "Files"):
            hand.tab(tab)
            hand.page.wait_for_timeout(400)
            found = hand.page.evaluate(CONTRAST)
            assert len(found) > 30
            assert [text for text in found if text["ratio"] < 4.5] == []


def test_a_page_that_comes_again_shows_the_scene_of_the_start(browser: Browser, alone: Studio) -> None:
    """Loaded again, or by itself when its connection was dropped; the address stays as it was printed.

    Before it is loaded the browser asks if the scene was changed, and only then.
    """
    questions: list[str] = []

    def changed(hand: Hand) -> None:
        hand.tab("Edit")  # a browser asks nothing of a page that was not touched
        hand.session.change(lambda state: state.moved(("nodes", 0), (12.0, 3.0, 0.0)))
        hand.page.wait_for_function("document.querySelector('[data-np=overlay]').dataset.version == 2")

    with opened(browser, alone) as hand:
        hand.page.on("dialog", lambda dialog: (questions.append(dialog.type), dialog.accept()))
        hand.tab("Edit")
        hand.page.reload()
        hand = hand.after()
        hand.certified()
        assert questions == []
        for come_again in (hand.page.reload, alone._server._websock_server.disconnect_all_clients):
            changed(hand)
            come_again()
            hand = hand.after()
            hand.certified()
            assert questions == ["beforeunload"]
            assert hand.scenario == PAPER
            assert hand.session.history.past == ()
        assert urlsplit(hand.page.url).query == urlsplit(alone.address).query
        hand.page.wait_for_selector("#np-overlay[data-state=connected]")
        assert hand.page.locator("[data-np=connection]").inner_text() == "connected"


def test_a_touch_phone_shows_the_scene_first(browser: Browser, alone: Studio) -> None:
    """The panel is folded until its title is tapped; points and drone are in sight, below the card."""
    with opened(browser, alone, **PHONE) as hand:
        readout, title = hand.page.locator("[data-np=readout]"), hand.page.get_by_text("nullpose studio")
        readout.wait_for(state="hidden")
        hand.until(lambda: (hand.camera.image_width, hand.camera.image_height) == (390, 844))
        pose = hand.session.state.answer(hand.session.state.case).result.pose
        points = [*(point.position_m for point in (*PAPER.nodes, *PAPER.jammers)), pose.position_m]

        def are_in_sight() -> bool:
            seen = pixels(hand.camera, points)[:, :2]
            return bool(np.all((seen > [0.0, PHONE_CARD_PX[1]]) & (seen < [390.0, 616.0])))

        hand.until(are_in_sight)
        card = hand.page.locator("#np-overlay").bounding_box()
        assert card is not None
        assert card["x"] >= 0.0
        assert (card["x"] + card["width"], card["y"] + card["height"]) < PHONE_CARD_PX
        title.tap()
        readout.wait_for(state="visible")
        sheet = hand.page.locator(".mantine-Paper-root", has=readout).bounding_box()
        assert sheet is not None
        assert (sheet["x"], sheet["width"]) == (0.0, 390.0)
        title.tap()
        readout.wait_for(state="hidden")
        hand.ours._notify("A title", "A text")
        notice = hand.page.locator(".mantine-Notification-root", has_text="A title")
        hand.until(lambda: (notice.bounding_box() or {"y": 0.0})["y"] >= card["y"] + card["height"])


@pytest.mark.parametrize("device", [PHONE, DESK], ids=["phone", "desk"])
def test_the_end_of_a_studio_is_told(browser: Browser, device: dict[str, Any], words: Any) -> None:
    """Also that another has taken its place, with another address; the panel of viser never shows."""
    words.expected = ["ERR_CONNECTION_REFUSED", "Forbidden", "WebSocket connection", "403"]
    with studio(PAPER, port=0) as first, opened(browser, first, WATCH, **device) as hand:
        first._server._websock_server.disconnect_all_clients()
        hand = hand.after()
        hand.certified()
        first.close()
        line = hand.page.locator("[data-np=connection]")
        hand.page.wait_for_selector("#np-overlay[data-state=ended]")
        assert "not connected: the studio was ended" in line.inner_text()
        with studio(PAPER, port=urlsplit(first.address).port or 0):
            hand.page.wait_for_selector("#np-overlay[data-state=restarted]")
            assert "open the address that the new one prints" in line.inner_text()
        assert hand.page.evaluate("[...window.seen]") == []
