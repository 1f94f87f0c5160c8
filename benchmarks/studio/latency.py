"""From a drag to the new pose: what the server takes, and what the hand sees in a browser."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.studio.chromium import on_screen, opened
from nullpose import load
from nullpose.scenario import Jammer, Scenario
from nullpose.studio.answer import Answer
from nullpose.studio.server import studio
from nullpose.studio.session import Session

__all__ = ["latency"]

_EXAMPLES = Path(__file__).parents[2] / "examples"
_PAUSE_S = 0.3  # below the rest after which a proof begins

_WATCH = """() => {
  window.moves = []; window.news = [];
  const version = () => +(document.querySelector('[data-np=readout]')?.dataset.version ?? 0);
  addEventListener('pointermove', () => moves.push([performance.now(), version()]), true);
  new MutationObserver(() => {
    const status = document.querySelector('[data-np=status-0]')?.innerText ?? 'solving';
    if (!status.includes('solving')) {
      const seen = version();
      requestAnimationFrame(() => news.push([performance.now(), seen]));
    }
  }).observe(document.body, {childList: true, subtree: true, attributes: true, characterData: true});
}"""

_FRAMES = """() => new Promise(resolve => {
  const at = [];
  const next = now => { at.push(now); at.length < 40 ? requestAnimationFrame(next) : resolve(at); };
  requestAnimationFrame(next);
})"""


def latency(steps: int) -> dict[str, Any]:
    """Return the times of the paper's scene, and of ten nodes and three jammers, milliseconds.

    Args:
        steps: drag steps of each.
    """
    scenes = {"paper": load(_EXAMPLES / "paper.toml"), "ten nodes, three jammers": _ten_and_three()}
    return {
        name: {
            "server": _server(scene, 3 * steps),
            "browser": _browser(scene, steps, 0.5),
            "browser, few pixels": _browser(scene, steps, 0.1),
        }
        for name, scene in scenes.items()
    }


def _ten_and_three() -> Scenario:
    field = load(_EXAMPLES / "field.toml")
    third = Jammer(name="third", position_m=(-20.0, 60.0, 3.0), power_w=1.0)
    jammers = (*field.jammers, third)[:3]
    assert (len(field.nodes), len(jammers)) == (10, 3)
    return field.model_copy(update={"jammers": jammers})


def _server(scene: Scenario, steps: int) -> dict[str, float]:
    """Return the times from a point's move to its answer, without any page."""
    answered: dict[int, float] = {}
    session = Session(
        scene,
        on_event=lambda event: (
            answered.setdefault(event.version, time.perf_counter()) if isinstance(event, Answer) else None
        ),
        rest_s=10.0,
    )
    start = np.array(scene.jammers[0].position_m)
    session.start()
    while 1 not in answered:
        time.sleep(0.05)
    took = []
    for step in range(steps):
        began = time.perf_counter()
        session.move(("jammers", 0), start + np.array([0.05 * (step + 1), 0.0, 0.0]), "drag")
        while session.version not in answered:
            time.sleep(0.0005)
        took.append(answered[session.version] - began)
    session.close()
    return _summary(took)


def _browser(scene: Scenario, steps: int, scale: float) -> dict[str, float]:
    """Return the times from a move of the mouse to the frame with the new answer, in the browser's clock.

    Beside them stands how long the browser takes from one frame to the next by itself: without a graphics
    card that is most of the rest.
    """
    with studio(scene, port=0) as running, opened(running.port, scale=scale) as page:
        page.wait_for_timeout(6000)
        ours = next(iter(running.pages.values()))
        start = np.array(scene.jammers[0].position_m)
        grip = start + np.array([0.06 * ours._size_m, 0.0, 0.0])
        camera = ours._client.camera
        x, y = on_screen(page, camera, grip)
        to = on_screen(page, camera, grip + np.array([0.1 * ours._size_m, 0.0, 0.0]))
        page.mouse.move(x, y)
        page.wait_for_timeout(1000)
        page.mouse.down()
        page.evaluate(_WATCH)
        for step in range(steps):
            share = 0.5 - 0.5 * np.cos(np.pi * (step + 1) / steps)
            page.mouse.move(x + share * (to[0] - x), y + share * (to[1] - y))
            page.wait_for_timeout(1000 * _PAUSE_S)
        page.mouse.up()
        moves, news = page.evaluate("() => [moves, news]")
        frames = page.evaluate(_FRAMES)
    took = []
    for began, version in moves:
        seen = [at for at, shown in news if at > began and shown > version]
        if seen:
            took.append(1e-3 * (seen[0] - began))
    frame_ms = round(float(np.median(np.diff(frames))), 1)
    return _summary(took) | {"moves": len(moves), "frame_ms": frame_ms}


def _summary(seconds: list[float]) -> dict[str, float]:
    milliseconds = 1e3 * np.array(seconds)
    return {
        "count": len(seconds),
        "median_ms": round(float(np.median(milliseconds)), 1),
        "p95_ms": round(float(np.percentile(milliseconds, 95.0)), 1),
    }
