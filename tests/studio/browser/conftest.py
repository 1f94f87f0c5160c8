"""A studio and a Chromium for the tests of the page, all without a word in log and console.

Run with ``make test-studio``.
"""

from __future__ import annotations

import logging
import re
import shutil
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, sync_playwright
from tests.studio.browser.hand import PAPER, Hand, opened

from nullpose.studio.server import Studio, studio
from nullpose.studio.state import State

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

NOT_OURS = re.compile(
    r"THREE\.Clock: This module has been deprecated|GL Driver Message|software WebGL|swiftshader"
    r"|inside passive event listener",
    re.IGNORECASE,
)
"""What viser and a Chromium without a graphics card say by themselves."""


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
def alone() -> Iterator[Studio]:
    """A studio that no other test uses."""
    with studio(PAPER, port=0) as running:
        yield running


@pytest.fixture(scope="session")
def shared(browser: Browser, running: Studio) -> Iterator[Hand]:
    """The page that most tests share, since opening one takes long."""
    with opened(browser, running) as hand:
        yield hand


@pytest.fixture
def hand(shared: Hand) -> Hand:
    """A hand on the shared page: the paper's scene with its proof, nothing selected, in the first tab."""
    page = shared.page
    page.bring_to_front()  # one behind another draws nothing, and waits of it never end
    page.keyboard.press("Escape")
    shared.session.change(lambda view: State(scenario=PAPER))
    shared.certified()
    shared.tab("Scene")
    page.mouse.move(400, 20)
    shared.ours.aim()  # another test may have turned the camera
    page.wait_for_timeout(500)
    return shared
