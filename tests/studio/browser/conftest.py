"""A studio and a Chromium for the tests of the page, all without a word in log and console.

Run with ``make test-studio``.
"""

from __future__ import annotations

import logging
import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, sync_playwright

from nullpose import Scenario, load
from nullpose.studio.case import OPTIMUM
from nullpose.studio.server import Studio, studio
from nullpose.studio.session import Session
from nullpose.studio.state import State

PAPER = load(Path(__file__).parents[3] / "examples" / "paper.toml")
PATIENCE_MS = 90_000
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
CERTIFIED = "document.querySelector('[data-np=status-0]')?.innerText.includes('certified to')"

NOT_OURS = re.compile(
    r"THREE\.Clock: This module has been deprecated|GL Driver Message|software WebGL|swiftshader",
    re.IGNORECASE,
)
"""What viser and a Chromium without a graphics card say by themselves."""

Open = Callable[[], Page]


class Words(logging.Handler):
    """What servers write into their log and browsers into their console, warnings and worse.

    A test that ends a server or asks for what is refused names what the browser says of that.
    """

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.said: list[str] = []
        self.expected: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep what is logged."""
        self.said.append(f"log: {self.format(record)}")

    def listen(self, context: BrowserContext) -> None:
        """Keep what the pages of a context say."""
        context.on("console", self._console)
        context.on("weberror", lambda error: self.said.append(f"page: {error.error}"))

    def _console(self, message: ConsoleMessage) -> None:
        if message.type in ("error", "warning") and not NOT_OURS.search(message.text):
            self.said.append(f"console: {message.text}")

    def unexpected(self) -> list[str]:
        """Return what was said since the last call and that no test expects."""
        said, self.said = self.said, []
        return [one for one in said if not any(text in one for text in self.expected)]


@pytest.fixture(scope="session", autouse=True)
def words() -> Iterator[Words]:
    """What is said during all tests."""
    words = Words()
    logging.getLogger().addHandler(words)
    yield words
    logging.getLogger().removeHandler(words)
    words.expected = ["ERR_CONNECTION_REFUSED"]  # pages are open for a moment after their studio has ended
    assert words.unexpected() == []


@pytest.fixture(autouse=True)
def _silence(words: Words) -> Iterator[None]:
    """Nothing is said that the test does not expect."""
    words.expected = []
    yield
    assert words.unexpected() == []


@pytest.fixture(scope="session")
def browser(words: Words) -> Iterator[Browser]:
    """Debian's Chromium, drawing without a graphics card."""
    path = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert path is not None, "Chromium is needed: apt-get install chromium"
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, args=FLAGS)
        new_context = chromium.new_context

        def heard(**more: Any) -> BrowserContext:
            context = new_context(**more)
            words.listen(context)
            return context

        chromium.new_context = heard  # type: ignore[method-assign]
        yield chromium
        chromium.close()


@pytest.fixture(scope="session")
def running() -> Iterator[Studio]:
    """A studio of the paper's scene."""
    with studio(PAPER, port=0) as one:
        yield one


@pytest.fixture
def alone(paper: Scenario) -> Iterator[Studio]:
    """A studio that no other test uses."""
    with studio(paper, port=0) as running:
        yield running


@pytest.fixture(scope="session")
def open_page(browser: Browser, running: Studio) -> Open:
    """Opens a page of its own and waits for its first proof."""

    def opened() -> Page:
        # a quarter of the pixels: without a graphics card it is they that take the time
        context = browser.new_context(viewport={"width": 1280, "height": 800}, device_scale_factor=0.5)
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(running.address)
        page.wait_for_function(CERTIFIED)
        for button in page.locator("button.mantine-Notification-closeButton").all():
            button.click()  # the notice that there is no graphics card
        return page

    return opened


@pytest.fixture(scope="session")
def first_page(open_page: Open, running: Studio) -> tuple[Page, Session]:
    """The page that most tests share, since opening one takes long, with the server's side of it."""
    page = open_page()
    (ours,) = running.pages.values()
    return page, ours.session


@pytest.fixture
def session(first_page: tuple[Page, Session]) -> Session:
    """The server's side of the shared page, back at the paper's scene."""
    page, session = first_page
    session.change(lambda view: State(scenario=PAPER, case=OPTIMUM))
    page.bring_to_front()  # one behind another draws nothing, and waits of it never end
    page.wait_for_function(
        f"+document.querySelector('[data-np=readout]').dataset.version == {session.state.version}"
    )
    page.wait_for_function(CERTIFIED)
    return session


@pytest.fixture
def page(first_page: tuple[Page, Session], session: Session) -> Page:
    """The shared page, showing the paper's scene with its proof, its first tab in front."""
    page, _ = first_page
    page.get_by_role("tab", name="Scene").click()
    return page
