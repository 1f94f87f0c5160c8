"""A Chromium that draws without a graphics card, and where a point of the scene is on its screen."""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

_PROVED = "/Proved|At most/.test(document.querySelector('[data-np=overlay-status-0]')?.innerText)"
_FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_VIEWPORT = {"width": 1280, "height": 800}


@contextmanager
def opened(address: str, *, scale: float = 0.5, **more: Any) -> Iterator[Any]:
    """Give a page of the studio, its first proof being there.

    Args:
        address: what the studio says to open, with its token.
        scale: pixels along each side for one of the page's; without a graphics card they take the time.
        more: of what Playwright takes for a page, as ``viewport``.
    """
    from playwright.sync_api import sync_playwright

    path = shutil.which("chromium")
    if path is None:
        raise SystemExit("Chromium is needed: apt-get install chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=_FLAGS)
        page = browser.new_page(**{"viewport": _VIEWPORT, "device_scale_factor": scale} | more)
        page.set_default_timeout(120_000)
        page.add_init_script("localStorage.setItem('np-explained', '1')")
        page.goto(address)
        page.wait_for_function(_PROVED)
        for button in page.locator("button.mantine-Notification-closeButton").all():
            button.click()  # the notice that there is no graphics card
        yield page
        browser.close()


def pixels(camera: Any, points_m: Any) -> Any:
    """Return where points are on a canvas, (n, 3): pixels to the right and down, and metres ahead.

    Args:
        camera: viser's.
        points_m: (n, 3) metres.
    """
    ahead = np.subtract(camera.look_at, camera.position)
    ahead = ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(right, ahead), ahead])
    aside, up, depth = axes @ np.subtract(points_m, camera.position).T
    scale = 0.5 * camera.image_height / math.tan(0.5 * camera.fov) / depth
    across, down = 0.5 * camera.image_width + scale * aside, 0.5 * camera.image_height - scale * up
    return np.stack([across, down, depth], -1)
