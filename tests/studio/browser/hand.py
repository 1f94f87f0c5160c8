"""What the tests of the page share: a hand that uses it, and a browser that opens it."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from benchmarks.chromium import pixels
from matplotlib.image import imread
from numpy.typing import NDArray
from playwright.sync_api import Browser, Locator, Page

from nullpose import Scenario, load
from nullpose.studio.server import Studio
from nullpose.studio.session import Session
from scenes import EXAMPLES

PAPER = load(EXAMPLES / "paper.toml")
CERTIFIED = "document.querySelector('[data-np=overlay-status-0]')?.innerText.includes('Proved optimal')"
DESK: dict[str, Any] = {"viewport": {"width": 1280, "height": 800}, "device_scale_factor": 0.5}
PHONE: dict[str, Any] = {
    "viewport": {"width": 390, "height": 844},
    "device_scale_factor": 2,
    "has_touch": True,
    "is_mobile": True,
}


class Hand:
    """What a user does in a page and sees of it.

    Args:
        page: the browser's side.
        running: the studio that the page is of.
        ours: the server's side; the only or latest page of the studio if left out.
    """

    def __init__(self, page: Page, running: Studio, ours: Any = None) -> None:
        self.page, self.running = page, running
        self.ours = ours or next(reversed(running.pages.values()))

    @property
    def session(self) -> Session:
        """The server's side of the scene."""
        return self.ours.session

    @property
    def scenario(self) -> Scenario:
        """The scene now."""
        return self.session.state.scenario

    @property
    def camera(self) -> Any:
        """The camera as the server knows it."""
        return self.ours._client.camera

    def until(self, met: Callable[[], object], seconds: float = 300.0) -> None:
        """Wait until something holds."""
        until = time.monotonic() + seconds
        while not met():
            assert time.monotonic() < until, "it did not happen in time"
            self.page.wait_for_timeout(50)

    def after(self) -> Hand:
        """Wait for the page that comes after this one, and follow it."""
        self.until(lambda: len(self.running.pages) == 1 and self.ours not in self.running.pages.values())
        return Hand(self.page, self.running)

    def certified(self) -> float:
        """Wait for the proof of the present scene or a later one; return the value that the page shows."""
        version = self.session.state.version
        self.page.wait_for_function(
            f"+document.querySelector('[data-np=readout]')?.dataset.version >= {version} && {CERTIFIED}"
        )
        return self.shown("overlay-value-0")

    def solved(self, before: int) -> float:
        """Wait for the proof of a later version than one, and return the value that the page shows."""
        self.until(lambda: self.session.state.version > before)
        return self.certified()

    def shown(self, where: str) -> float:
        """Return the number that stands in the page at a name."""
        return float(self.page.locator(f"[data-np={where}]").last.get_attribute("data-value") or "nan")

    def tab(self, name: str) -> None:
        """Bring a tab to the front."""
        self.page.get_by_role("tab", name=name).click()

    def press(self, name: str) -> None:
        """Press a button of the panel."""
        self.page.get_by_role("button", name=name, exact=True).click()

    def take_tool(self, name: str) -> None:
        """Take up a tool, and wait until the page says what a click does now."""
        self.tab("Edit")
        self.press(name)
        self.page.locator("[data-np=tool]", has_text="lick").wait_for()

    def choose(self, place: int, option: str) -> None:
        """Choose from one of the lists of the tab in front."""
        self.page.locator("input.mantine-Select-input:visible").nth(place).click()
        self.page.get_by_role("option", name=option, exact=True).click()

    def field(self, label: str) -> Locator:
        """Return the field of the panel that stands beside a label."""
        found = f"xpath=//label[.='{label}']/ancestor::*[.//input][1]//input"
        return self.page.locator(found).locator("visible=true").first

    def type(self, label: str, text: str, delay_ms: float = 0.0, ends: str = "Enter") -> Locator:
        """Type a text over what stands in a field, key by key, and press the key that ends it."""
        field = self.field(label)
        field.click()
        field.press("Control+A")
        field.press("Delete")
        field.press_sequentially(text, delay=delay_ms)
        field.press(ends)
        return field

    def refused(self, words: str) -> None:
        """Wait for a fault in the panel."""
        self.page.locator("[data-np=faults]", has_text=words).wait_for()

    def noticed(self, words: str) -> None:
        """Wait for a notice."""
        self.page.locator(".mantine-Notification-root", has_text=words).wait_for()

    def download(self, button: str, path: Path) -> Path:
        """Press a button in the tab of files, and keep what comes."""
        self.tab("Files")
        with self.page.expect_download() as download:
            self.press(button)
        download.value.save_as(path)
        return path

    def upload(self, path: Path) -> None:
        """Load a scenario file."""
        self.tab("Files")
        with self.page.expect_file_chooser() as chooser:
            self.press("Load scenario")
        chooser.value.set_files(path)

    def screen(self, point_m: Any) -> tuple[float, float]:
        """Return where a point of the scene is on the page."""
        canvas = self.page.locator("canvas").first.bounding_box()
        assert canvas is not None
        right, down, _ = pixels(self.camera, [point_m])[0]
        assert 0.0 < right < canvas["width"], "it is out of sight"
        assert 0.0 < down < canvas["height"], "it is out of sight"
        return canvas["x"] + float(right), canvas["y"] + float(down)

    def click(self, *point_m: float) -> None:
        """Click where a point of the scene is drawn."""
        self.page.mouse.click(*self.screen(point_m))
        self.page.wait_for_timeout(300)

    def picture(self) -> NDArray[np.float64]:
        """Return the canvas without what the page lays over it, a pixel for each of the page's."""
        hidden = self.page.add_style_tag(content="#np-overlay { visibility: hidden }")
        found = imread(io.BytesIO(self.page.locator("canvas").first.screenshot(scale="css")))[..., :3]
        hidden.evaluate("element => element.remove()")
        return np.asarray(found, dtype=float)


def drawn_share(picture: NDArray[np.float64]) -> float:
    """Return the share of a picture that is not of the background's colour."""
    return float(np.mean(np.abs(picture - picture[0, -1]).max(axis=-1) > 0.08))


@contextmanager
def opened(browser: Browser, running: Studio, script: str = "", **more: Any) -> Iterator[Hand]:
    """Open a studio in a browser of its own, up to the first proof."""
    context = browser.new_context(**DESK | more)
    page = context.new_page()
    page.set_default_timeout(300_000)
    page.add_init_script(f"localStorage.setItem('np-explained', '1'); {script}")
    page.goto(running.address)
    page.wait_for_function(CERTIFIED)
    for button in page.locator("button.mantine-Notification-closeButton").all():
        button.click()  # the notice that there is no graphics card
    try:
        yield Hand(page, running)
    finally:
        context.close()
