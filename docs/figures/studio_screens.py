"""Takes the pictures of the studio in the documentation; needs the extra ``studiotest`` and Chromium."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))  # benchmarks are not installed: hence imports below this line

from benchmarks.chromium import opened  # noqa: E402

from nullpose import load  # noqa: E402
from nullpose.studio.answer import TiltNotice  # noqa: E402
from nullpose.studio.case import case_named  # noqa: E402
from nullpose.studio.server import studio  # noqa: E402
from nullpose.studio.session import Session  # noqa: E402

IMAGES = ROOT / "docs" / "images"

# name: example, what is done first
SCREENS: dict[str, tuple[str, Callable[[Session], None]]] = {
    "studio-weak": ("paper", lambda session: session.change(lambda view: view.with_power_db(-20.0))),
    "studio-strong": ("paper", lambda session: session.change(lambda view: view.with_power_db(20.0))),
    "studio-ten-nodes": ("field", lambda session: None),
    "studio-comparison": (
        "paper",
        lambda session: session.change(lambda view: replace(view, compared=case_named("Vertical"))),
    ),
    "studio-robust": (
        "robust",
        lambda session: session.change(lambda view: view.with_case(case_named("Robust pose"))),
    ),
}
_QUIET_MS = 1500  # without a graphics card a frame takes long
_MOST_LOOKS = 12


def at_rest(page: Any, session: Session) -> None:
    """Wait until all of a scene is found and the page changes no more.

    Args:
        page: the browser's side.
        session: the server's side.
    """
    page.mouse.move(300, 30)  # away from what would show its help
    while session.state.present(TiltNotice) is None:  # the last that is worked out
        page.wait_for_timeout(200)
    before, now = b"", page.screenshot()
    for _ in range(_MOST_LOOKS):
        if before == now:
            return
        page.wait_for_timeout(_QUIET_MS)
        before, now = now, page.screenshot()


def take(name: str) -> None:
    """Take one picture."""
    example, change = SCREENS[name]
    with (
        studio(load(ROOT / "examples" / f"{example}.toml"), port=0) as running,
        opened(running.address, scale=1.0) as page,
    ):
        ours: Any = next(iter(running.pages.values()))
        session: Any = ours.session
        change(session)
        at_rest(page, session)
        page.screenshot(path=IMAGES / f"{name}.png")


if __name__ == "__main__":
    for each in sys.argv[1:] or SCREENS:
        take(each)
