"""The proof in a real browser: its bar, and the replay of its boxes."""

from __future__ import annotations

import io
import re
import threading

import numpy as np
import pytest
from matplotlib.image import imread
from playwright.sync_api import Page

from nullpose.studio.session import Session

WORDS = "document.querySelector('[data-np=proof-words]').innerText"
PLAYING = f"{WORDS}.startsWith('Replay')"
AT_REST = f"{WORDS}.startsWith('Gap 1e-6: proved in')"
COLLECT = """() => { window.told = []; new MutationObserver(() => {
  const words = document.querySelector('[data-np=proof-words]')?.innerText;
  if (words && words !== window.told.at(-1)) window.told.push(words);
}).observe(document.body, {subtree: true, childList: true, characterData: true}) }"""


def _pink(page: Page) -> int:
    """Returns how many pixels of the canvas have the boxes' colour, lit or not."""
    pixels = imread(io.BytesIO(page.locator("canvas").first.screenshot()))[..., :3]
    red, green, blue = np.moveaxis(pixels, -1, 0)
    return int(np.sum((red > 0.6) & (red > green + 0.3) & (blue > green + 0.15) & (red > blue + 0.1)))


def _press_replay(page: Page) -> None:
    page.wait_for_function(AT_REST)
    page.get_by_role("tab", name="Map and view").click()
    page.get_by_role("button", name="Replay the proof").click()
    page.wait_for_function(PLAYING)


def test_the_replay_shows_boxes_that_close_in_on_the_drone_and_go(
    page: Page, session: Session, caplog: pytest.LogCaptureFixture
) -> None:
    """What is told falls with the bound, boxes are seen on the canvas, and none is there at the end."""
    page.wait_for_function(AT_REST)
    before = _pink(page)
    page.evaluate(COLLECT)
    _press_replay(page)
    page.wait_for_function("+document.querySelector('[data-np=proof]').dataset.gap < 0.3")
    assert _pink(page) > before + 50
    page.wait_for_function(AT_REST)
    told = [words for words in page.evaluate("window.told") if words.startswith("Replay")]
    assert len(told) > 10
    within_m = [float(found) for words in told for found in re.findall(r"within ([0-9.e-]+) m", words)]
    assert within_m == sorted(within_m, reverse=True)
    assert within_m[-1] < 0.01 * within_m[0]
    assert told[-1] == "Replay, bound 1e-6 above: no box left"
    page.wait_for_timeout(1500)
    assert _pink(page) <= before + 20
    assert not caplog.records


def test_a_change_of_the_scene_ends_the_replay_at_once(
    page: Page, session: Session, caplog: pytest.LogCaptureFixture
) -> None:
    """No box of an outdated scene stays, and no thread."""
    _press_replay(page)
    session.change(lambda view: view.with_power_db(3.0))
    page.wait_for_function(f"!{PLAYING}", timeout=5_000)
    page.wait_for_function(AT_REST)
    assert "nullpose-studio-replay" not in [thread.name for thread in threading.enumerate()]
    assert not caplog.records


def test_the_button_stops_a_replay(page: Page, session: Session) -> None:
    """Pressed again, it brings the proof's own bar back."""
    _press_replay(page)
    page.get_by_role("button", name="Replay the proof").click()
    page.wait_for_function(AT_REST, timeout=5_000)
