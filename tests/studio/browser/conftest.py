"""A studio and a Chromium for the tests of the page; run with ``make test-studio``."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from nullpose import load
from nullpose.studio.server import Studio, studio

ROOT = Path(__file__).parents[3]
PATIENCE_MS = 90_000
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
CERTIFIED = "document.querySelector('[data-np=status-0]')?.innerText.includes('certified to')"

Open = Callable[[], Page]


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Debian's Chromium, drawing without a graphics card."""
    path = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert path is not None, "Chromium is needed: apt-get install chromium"
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture(scope="session")
def running() -> Iterator[Studio]:
    """A studio of the paper's scene."""
    with studio(load(ROOT / "examples" / "paper.toml"), port=0) as one:
        yield one


@pytest.fixture
def open_page(browser: Browser, running: Studio) -> Iterator[Open]:
    """Opens a page of its own, waits for its first proof, and closes it in the end."""
    contexts = []

    def opened() -> Page:
        context = browser.new_context(viewport={"width": 1280, "height": 800}, accept_downloads=True)
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(f"http://127.0.0.1:{running.port}")
        page.wait_for_function(CERTIFIED)
        for button in page.locator("button.mantine-Notification-closeButton").all():
            button.click()  # the notice that there is no graphics card
        return page

    yield opened
    for context in contexts:
        context.close()


@pytest.fixture
def session_of(running: Studio) -> Callable[[], Any]:
    """Returns the server's side of the page that was opened last."""
    return lambda: running.pages[max(running.pages)].session
