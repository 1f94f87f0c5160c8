"""Makes the loop that README shows; needs the extra ``studiotest`` and Chromium, and some minutes.

Some seconds of the paper's scene in the studio: the jammer's power rises from 1 to 100 times a node's, then
the jammer is dragged in an arc and back. Each frame waits for the proof of its own scene:
every number in it is certified.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))  # benchmarks are not installed: hence imports below this line

from benchmarks.chromium import opened  # noqa: E402

from nullpose import load  # noqa: E402
from nullpose.physics import rotation_world_from_body  # noqa: E402
from nullpose.studio.server import studio  # noqa: E402

LOOP = ROOT / "docs" / "images" / "studio-loop.webp"
WIDTH, HEIGHT = 960, 540
VIEWPORT = {"width": WIDTH + 40, "height": HEIGHT}  # the folded panel is cut off
EACH_MS = 80
RISES, DRAGS, HOLDS = 26, 40, 6  # frames: 72 of 80 ms
MOST_DB = 20.0
TURN_RAD = np.radians(14.0)  # of the camera, forth and back
QUALITY = 62
NEARER = 0.92  # of the camera's distance
ASIDE, ABOVE = 0.14, 0.05  # of the scene's size
MOST_BYTES = 4_000_000
CAPTIONS = (  # until which frame
    (
        RISES,
        "1  The jammer M becomes 100 times as strong as a node. The drone turns its null, orange, to it.",
    ),
    (RISES + DRAGS + HOLDS, "2  M is moved. Position and attitude follow; each pose is proved best."),
)
CAPTION = """words => {
  let line = document.getElementById('loop-caption');
  if (!line) {
    line = document.createElement('div');
    line.id = 'loop-caption';
    line.style = 'position:fixed;left:12px;bottom:12px;width:230px;z-index:9;color:#f2f2f2;'
      + 'background:#14181eeb;padding:8px 12px;border-radius:8px;'
      + 'font:600 15px/1.35 sans-serif';
    document.body.append(line);
  }
  line.textContent = words;
}"""


def frames(page: Any, ours: Any) -> Iterator[Image.Image]:
    """Yield the frames."""
    session, client = ours.session, ours._client
    start = np.array(session.state.scenario.jammers[0].position_m)
    look_at, eye = np.array(client.camera.look_at), np.array(client.camera.position)
    total = RISES + DRAGS + HOLDS

    def shot(frame: int) -> Image.Image:
        told = next(words for last, words in CAPTIONS if frame < last)
        page.evaluate(CAPTION, told)
        turn = rotation_world_from_body(0.0, 0.0, TURN_RAD * np.sin(2.0 * np.pi * frame / total))
        with client.atomic():
            client.camera.position = look_at + turn @ (eye - look_at)
            client.camera.look_at = look_at
        page.wait_for_timeout(700)
        return Image.open(BytesIO(page.screenshot(clip={"x": 0, "y": 0, "width": WIDTH, "height": HEIGHT})))

    for i in range(RISES):
        session.change(lambda view, i=i: view.with_power_db(MOST_DB * i / (RISES - 1)))
        settle(page, session)
        yield shot(i)
    for i in range(DRAGS):
        turn = np.sin(np.pi * (i + 1) / DRAGS)
        place = start + turn * np.array([4.0, 17.0, 0.0]) + (1.0 - turn) * turn * np.array([14.0, 0.0, 0.0])
        session.change(lambda view, place=place: view.moved(("jammers", 0), place))
        settle(page, session)
        yield shot(RISES + i)
    for i in range(HOLDS):
        yield shot(RISES + DRAGS + i)


def nearer(client: Any, size_m: float) -> None:
    """Bring the scene nearer, and to the right of the card."""
    camera = client.camera
    look_at, eye = np.array(camera.look_at), np.array(camera.position)
    ahead = look_at - eye
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    aside = size_m * np.array([-ASIDE * right[0], -ASIDE * right[1], ABOVE])
    with client.atomic():
        camera.position, camera.look_at = look_at + aside - NEARER * ahead, look_at + aside


def settle(page: Any, session: Any) -> None:
    """Wait for the proof and the maps of the present scene."""
    while session.state.field_map is None or not session.state.status(session.state.case).startswith(
        "Proved"
    ):
        page.wait_for_timeout(50)


def main() -> None:
    """Write the loop."""
    with (
        studio(load(ROOT / "examples" / "paper.toml"), port=0) as running,
        opened(running.address, scale=1.0, viewport=VIEWPORT, color_scheme="dark") as page,
    ):
        ours: Any = next(iter(running.pages.values()))
        ours._client.gui.main_panel.minimize()
        page.wait_for_timeout(3000)
        ours.aim()
        nearer(ours._client, ours.stage.size_m)
        page.mouse.move(600, 20)
        page.wait_for_timeout(3000)
        first, *others = frames(page, ours)
    more = {"duration": EACH_MS, "loop": 0, "quality": QUALITY, "method": 6}
    first.save(LOOP, save_all=True, append_images=others, **more)
    size = LOOP.stat().st_size
    print(f"{LOOP.relative_to(ROOT)}: {1 + len(others)} frames, {size / 1e6:.2f} MB")
    assert size < MOST_BYTES


if __name__ == "__main__":
    main()
