"""Makes the loop on the studio's page of the manual; needs the extra ``studiotest``, Chromium, and minutes.

Some seconds of the paper's scene in the studio: the jammer's power rises from 0.01 to 100 times a node's, and
the SINR falls while the null is off the jammer, until it is on it; then the jammer is dragged in an arc and
back. Each frame waits for the proof of its own scene: every number in it is certified.
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

import nullpose.studio.camera  # noqa: E402
from nullpose import load  # noqa: E402
from nullpose.physics import rotation_world_from_body  # noqa: E402
from nullpose.report.numbers import MINUS  # noqa: E402
from nullpose.studio.server import studio  # noqa: E402

LOOP = ROOT / "docs" / "images" / "studio-loop.webp"
WIDTH, HEIGHT = 960, 540
VIEWPORT = {"width": WIDTH + 40, "height": HEIGHT}  # the folded panel is cut off
EACH_MS = 80
RISES, HOLDS, DRAGS = 28, 6, 34  # frames of 80 ms
LEAST_DB, MOST_DB = -20.0, 20.0
TURN_RAD = np.radians(10.0)  # of the camera, forth and back
QUALITY = 62
NEARER, BELOW = 0.88, 0.06  # of the camera's distance; of the scene's size, for the captions
MOST_BYTES = 4_000_000
CAPTIONS = (
    "The jammer M grows. The null, orange, is still off it, and the SINR falls.",
    "The null turns onto M: now 100 times the power costs less than 0.2 dB.",
    "M is dragged. Position and attitude follow; each pose is proved best.",
)
CAPTION = """([value, words]) => {
  let line = document.getElementById('loop-caption');
  if (!line) {
    const hidden = document.createElement('style');
    hidden.textContent = '#np-overlay{display:none!important}';
    document.head.append(hidden);
    line = document.createElement('div');
    line.id = 'loop-caption';
    line.style = 'position:fixed;left:0;bottom:0;width:960px;box-sizing:border-box;z-index:9;color:#f2f2f2;'
      + 'background:#14181ed8;padding:11px 24px;font:500 19px/1.3 sans-serif;display:flex;gap:22px;'
      + 'align-items:center';
    line.innerHTML = '<b style="font-size:27px;min-width:130px;white-space:nowrap"></b><span></span>';
    document.body.append(line);
  }
  line.firstChild.textContent = value;
  line.lastChild.textContent = words;
}"""


def frames(page: Any, ours: Any) -> Iterator[Image.Image]:
    """Yield the frames."""
    session, client = ours.session, ours._client
    start = np.array(session.state.scenario.jammers[0].position_m)
    look_at, eye = np.array(client.camera.look_at), np.array(client.camera.position)
    total, taken = RISES + HOLDS + DRAGS, 0

    def shot(caption: str) -> Image.Image:
        nonlocal taken
        settle(page, session)
        value_db = session.state.current(session.state.case).shown_value
        page.evaluate(CAPTION, [f"{value_db:.2f} dB".replace("-", MINUS), caption])
        turn = rotation_world_from_body(0.0, 0.0, TURN_RAD * np.sin(2.0 * np.pi * taken / total))
        taken += 1
        with client.atomic():
            client.camera.position = look_at + turn @ (eye - look_at)
            client.camera.look_at = look_at
        page.wait_for_timeout(700)
        return Image.open(BytesIO(page.screenshot(clip={"x": 0, "y": 0, "width": WIDTH, "height": HEIGHT})))

    for power_db in np.append(np.linspace(LEAST_DB, MOST_DB, RISES), HOLDS * [MOST_DB]):
        session.change(lambda view, power_db=float(power_db): view.with_power_db(power_db))
        yield shot(CAPTIONS[int(power_db > 0.0)])
    for i in range(DRAGS):
        turn = np.sin(np.pi * (i + 1) / DRAGS)
        place = start + turn * np.array([4.0, 17.0, 0.0]) + (1.0 - turn) * turn * np.array([14.0, 0.0, 0.0])
        session.change(lambda view, place=place: view.moved(("jammers", 0), place))
        yield shot(CAPTIONS[2])


def nearer(client: Any, size_m: float) -> None:
    """Bring the scene nearer: it fills the picture above the captions."""
    camera = client.camera
    look_at, eye = np.array(camera.look_at), np.array(camera.position)
    lower = look_at - [0.0, 0.0, BELOW * size_m]
    with client.atomic():
        camera.position, camera.look_at = lower + NEARER * (eye - look_at), lower


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
        nullpose.studio.camera.CARD_PX = (0.0, 0.0)  # the captions stand for the card
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
