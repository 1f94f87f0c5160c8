"""What is around the picture: colours, loading again, the card and the connection."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from nullpose.scenario import Scenario
from nullpose.studio.server import Studio, studio

CERTIFIED = "document.querySelector('[data-np=overlay-status-0]')?.innerText.includes('certified to')"
DARK = "document.documentElement.dataset.mantineColorScheme == 'dark'"
WIDE, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}


@contextmanager
def _opened(browser: Browser, address: str, **more: Any) -> Iterator[Page]:
    """Opens an address in a browser of its own, up to the first proof."""
    context = browser.new_context(**{"viewport": WIDE, "device_scale_factor": 0.5} | more)
    page = context.new_page()
    page.set_default_timeout(90_000)
    page.goto(address)
    page.wait_for_function(CERTIFIED)
    try:
        yield page
    finally:
        context.close()


def _notices_are_below_the_card(page: Page) -> bool:
    card = page.locator("#np-overlay").bounding_box()
    notices = [notice.bounding_box() for notice in page.locator(".mantine-Notification-root").all()]
    return card is not None and all(one is None or one["y"] >= card["y"] + card["height"] for one in notices)


def _until(met: Callable[[], object], seconds: float = 30.0) -> None:
    until = time.monotonic() + seconds
    while not met():
        assert time.monotonic() < until, "it did not happen in time"
        time.sleep(0.05)


def _only(running: Studio) -> Any:
    """Returns the server's side of the only page."""
    _until(lambda: len(running.pages) == 1)
    return next(iter(running.pages.values()))


def _after(running: Studio, before: Any) -> Any:
    """Returns the server's side of the page that came after another."""
    _until(lambda: len(running.pages) == 1 and _only(running) is not before)
    return _only(running)


def _value(page: Page, where: str) -> str:
    return page.locator(f"[data-np={where}]").get_attribute("data-value") or ""


def _ink_on_ground(page: Page, selector: str) -> float:
    """Returns the contrast (WCAG) of a text in the card with the card.

    The browser finds and reads the text in one step, since the card may be written anew between two.
    """
    colours = page.evaluate(
        """text => [[text, 'color'], ['#np-overlay', 'backgroundColor']].map(
            ([one, what]) => getComputedStyle(document.querySelector(one))[what])""",
        selector,
    )
    share = [np.array([float(part) for part in re.findall(r"[\d.]+", one)[:3]]) / 255 for one in colours]
    linear = [np.where(one <= 0.04045, one / 12.92, ((one + 0.055) / 1.055) ** 2.4) for one in share]
    low, high = sorted(float(one @ (0.2126, 0.7152, 0.0722)) for one in linear)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_has_the_systems_colours(browser: Browser, alone: Studio, scheme: Any) -> None:
    """The panel as the card, whose letters stand out from it."""
    with _opened(browser, alone.address, color_scheme=scheme) as page:
        page.wait_for_function(f"({DARK}) == {'true' if scheme == 'dark' else 'false'}")
        parts = (".np-value", ".np-label", ".np-bound", ".np-status", "[data-np=connection]")
        assert min(_ink_on_ground(page, f"#np-overlay {part}") for part in parts) > 4.5


def test_a_page_loaded_again_shows_the_scene_of_the_start(
    browser: Browser, alone: Studio, paper: Scenario
) -> None:
    """The browser asks first if the scene was changed, and only then; the address stays as it was printed."""
    with _opened(browser, alone.address) as page:
        questions: list[str] = []
        page.on("dialog", lambda dialog: (questions.append(dialog.type), dialog.accept()))
        page.get_by_role("tab", name="Edit").click()  # a browser asks nothing of a page that was not touched
        first = _only(alone)
        page.reload()
        page.wait_for_function(CERTIFIED)
        second = _after(alone, first)
        assert questions == []
        page.get_by_role("tab", name="Edit").click()
        second.session.change(lambda view: view.moved(("nodes", 0), (12.0, 3.0, 0.0)))
        page.wait_for_function("document.querySelector('[data-np=overlay]').dataset.version == 2")
        page.reload()
        page.wait_for_function(CERTIFIED)
        third = _after(alone, second)
        assert questions == ["beforeunload"]
        assert third.session.state.scenario == paper
        assert third.session.history.past == ()
        assert urlsplit(page.url).query == urlsplit(alone.address).query


def test_another_tab_begins_with_the_file(browser: Browser, alone: Studio, paper: Scenario) -> None:
    """What one tab changes is not another's."""
    with _opened(browser, alone.address):
        first = _only(alone)
        first.session.change(lambda view: view.moved(("nodes", 0), (12.0, 3.0, 0.0)))
        with _opened(browser, alone.address):
            (second,) = (page for page in alone.pages.values() if page is not first)
            assert second.session.state.scenario == paper


def test_a_dropped_connection_comes_back(browser: Browser, alone: Studio, paper: Scenario) -> None:
    """By itself, with the scene of the start, and the card says when it is there again."""
    with _opened(browser, alone.address) as page:
        first = _only(alone)
        first.session.change(lambda view: view.moved(("nodes", 0), (12.0, 3.0, 0.0)))
        alone._server._websock_server.disconnect_all_clients()
        second = _after(alone, first)
        assert second.session.state.scenario == paper
        page.wait_for_selector("#np-overlay[data-state=connected]")
        page.wait_for_function(CERTIFIED)
        assert page.locator("[data-np=connection]").inner_text() == "connected"


def test_the_card_stays_when_the_panel_is_folded(browser: Browser, alone: Studio) -> None:
    """It goes on telling what is solved, and no click ends on it."""
    with _opened(browser, alone.address) as page:
        ours = _only(alone)
        assert _value(page, "overlay-value-0") == _value(page, "value-0")
        page.get_by_label("Collapse panel area").click()
        page.wait_for_selector("[data-np=readout]", state="hidden")
        before = _value(page, "overlay-value-0")
        ours.session.change(lambda view: view.with_power_db(20.0))
        page.wait_for_function(
            f"document.querySelector('[data-np=overlay]').dataset.version == 2 && {CERTIFIED}"
        )
        assert _value(page, "overlay-value-0") != before
        card = page.locator("#np-overlay").bounding_box()
        assert card is not None
        assert card["width"] <= 340
        under = page.evaluate("document.elementFromPoint(40, 40).closest('#np-overlay') === null")
        assert under is True


def test_a_phone_shows_the_scene_first(browser: Browser, alone: Studio) -> None:
    """The panel is folded, and unfolds with a tap; the card is inside the screen, clear of the notices."""
    with _opened(browser, alone.address, viewport=PHONE) as page:
        readout = page.locator("[data-np=readout]")
        readout.wait_for(state="hidden")
        value = page.locator("[data-np=overlay-value-0]")
        assert value.is_visible()
        card = page.locator("#np-overlay").bounding_box()
        assert card is not None
        assert card["x"] >= 0
        assert card["x"] + card["width"] <= PHONE["width"]
        _until(lambda: _notices_are_below_the_card(page))
        page.get_by_text("nullpose studio").click()
        readout.wait_for(state="visible")
        assert _value(page, "value-0") == _value(page, "overlay-value-0")


def test_the_end_of_a_studio_is_told(browser: Browser, paper: Scenario, words: Any) -> None:
    """Also that another one has taken its place, whose address is another."""
    words.expected = ["ERR_CONNECTION_REFUSED", "Forbidden", "WebSocket connection", "403"]
    with studio(paper, port=0) as first:
        port = urlsplit(first.address).port
        context = browser.new_context(viewport=WIDE, device_scale_factor=0.5)
        page = context.new_page()
        page.set_default_timeout(60_000)
        page.goto(first.address)
        page.wait_for_function(CERTIFIED)
    told = page.locator("[data-np=connection]")
    page.wait_for_selector("#np-overlay[data-state=ended]")
    assert "not connected: the studio was ended" in told.inner_text()
    with studio(paper, port=port or 0):
        page.wait_for_selector("#np-overlay[data-state=restarted]")
        assert "open the address that the new one prints" in told.inner_text()
    context.close()
