"""One drag in a browser, with the time at which each step of its way there and back was reached."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from benchmarks.studio.chromium import on_screen

__all__ = ["STEPS", "Marks", "dragged", "summary"]

STEPS = MappingProxyType({"a step every 300 ms": 300, "a hand that moves 30 times a second": 33})
"""How the hand moves, and what lies between two of its moves, milliseconds; proofs begin after 350."""

_WATCH = """() => {
  if (window.npInput) { npInput.length = npShown.length = npFrames.length = 0; return; }
  window.npInput = []; window.npShown = []; window.npFrames = [];
  const epoch = () => performance.timeOrigin + performance.now();
  addEventListener('pointermove', event => npInput.push(performance.timeOrigin + event.timeStamp), true);
  const told = () => +(document.querySelector('[data-np=numbers-0]')?.dataset.version ?? -1);
  let last = -1;
  new MutationObserver(() => {
    const version = told();
    if (version <= last) return;
    last = version;
    // the frame that draws it begins at the first of these, and is over before the second
    requestAnimationFrame(() => requestAnimationFrame(() => npShown.push([epoch(), version])));
  }).observe(document.body, {childList: true, subtree: true, attributes: true, characterData: true});
  let before = 0;
  const next = now => { npFrames.push(now - before); before = now; requestAnimationFrame(next); };
  requestAnimationFrame(next);
}"""


@dataclass
class Marks:
    """What a server noted: when, in seconds since 1970, and with which version of the scene.

    Args:
        heard: a handle's move.
        solved: an answer.
    """

    heard: list[tuple[float, int]] = field(default_factory=list)
    solved: list[tuple[float, int]] = field(default_factory=list)


def dragged(
    page: Any, camera: Any, grip_m: Any, to_m: Any, marks: Marks, steps: int, how: str
) -> dict[str, Any]:
    """Return the times from a move of the mouse to the frame with its answer, and of the parts of that way.

    Args:
        page: the browser's page.
        camera: the same page's camera as the server knows it.
        grip_m: (3,) where the handle is taken, metres.
        to_m: (3,) where it goes and comes back from, metres.
        marks: what the server notes meanwhile.
        steps: how many moves.
        how: of ``STEPS``.
    """
    (x, y), (to_x, to_y) = on_screen(page, camera, grip_m), on_screen(page, camera, to_m)
    page.mouse.move(x, y)
    page.wait_for_timeout(1000)
    page.mouse.down()
    page.mouse.move(x + 1, y)
    page.wait_for_timeout(1000)
    page.evaluate(_WATCH)
    marks.heard.clear()
    marks.solved.clear()
    for step in range(steps):
        share = 0.5 - 0.5 * np.cos(2.0 * np.pi * (step + 1) / steps)
        page.mouse.move(x + share * (to_x - x), y + share * (to_y - y))
        page.wait_for_timeout(STEPS[how])
    page.wait_for_timeout(300)
    page.mouse.up()
    inputs, shown, frames = page.evaluate("() => [npInput, npShown, npFrames]")
    page.wait_for_timeout(3000)
    return _parts(inputs, shown, marks) | {"frame_ms": round(float(np.median(frames[1:])), 1)}


def _parts(inputs: list[float], shown: list[list[float]], marks: Marks) -> dict[str, Any]:
    parts: dict[str, list[float]] = {"end to end": [], "to the server": [], "server": [], "to the screen": []}
    for began_ms in inputs:
        began = 1e-3 * began_ms
        heard = next(((at, version) for at, version in marks.heard if at >= began), None)
        if heard is None:
            continue
        solved = next((at for at, version in marks.solved if version >= heard[1]), None)
        seen = next(
            (1e-3 * at for at, version in shown if version >= heard[1] and 1e-3 * at > heard[0]), None
        )
        if solved is None or seen is None:
            continue
        for name, begin, end in (
            ("end to end", began, seen),
            ("to the server", began, heard[0]),
            ("server", heard[0], solved),
            ("to the screen", solved, seen),
        ):
            parts[name].append(end - begin)
    return {name: summary(seconds) for name, seconds in parts.items()} | {"moves": len(inputs)}


def summary(seconds: list[float]) -> dict[str, float]:
    """Return the count, the median and the 95th percentile in milliseconds.

    Args:
        seconds: what was measured.
    """
    if not seconds:
        return {"count": 0}
    milliseconds = 1e3 * np.array(seconds)
    return {
        "count": len(seconds),
        "median_ms": round(float(np.median(milliseconds)), 1),
        "p95_ms": round(float(np.percentile(milliseconds, 95.0)), 1),
    }
