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

_WATCH = """name => {
  if (window.npInput) { npInput.length = npPose.length = npPanel.length = npFrames.length = 0; return; }
  window.npInput = []; window.npPose = []; window.npPanel = []; window.npFrames = [];
  const epoch = () => performance.timeOrigin + performance.now();
  addEventListener('pointermove', event => npInput.push(performance.timeOrigin + event.timeStamp), true);
  let at = '', drawn = [], told = -1, painted = [], before = 0;
  // what is posted in a frame is handled when all of that frame has been drawn
  const after = new MessageChannel();
  after.port1.onmessage = () => {
    const position = window.__viserMutable.nodeRefFromName[name]?.position.toArray() ?? [];
    if (position.join() !== at) { at = position.join(); drawn.push(position); }
  };
  const next = now => {
    for (const position of drawn) npPose.push([epoch(), position]);  // the next frame begins: theirs is over
    for (const version of painted) npPanel.push([epoch(), version]);
    drawn = []; painted = [];
    const version = +(document.querySelector('[data-np=numbers-0]')?.dataset.version ?? -1);
    if (version > told) { told = version; painted.push(version); }  // painted in the frame that begins here
    npFrames.push(now - before); before = now;
    after.port2.postMessage(0);
    requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
}"""
_SAME_M = 1e-3  # places as near as this are the same, metres


@dataclass
class Marks:
    """What a server noted: when, in seconds since 1970, and with which version of the scene.

    Args:
        heard: a handle's move.
        solved: an answer, and where it puts the drone, (3,) metres.
    """

    heard: list[tuple[float, int]] = field(default_factory=list)
    solved: list[tuple[float, int, Any]] = field(default_factory=list)


def dragged(
    page: Any, camera: Any, grip_m: Any, to_m: Any, marks: Marks, steps: int, how: str, drone: str
) -> dict[str, Any]:
    """Return the times from a move of the mouse to the end of the frame with its pose, and of its parts.

    A frame is over when the browser begins the next. The numbers in the panel are waited for as well.

    Args:
        page: the browser's page.
        camera: the same page's camera as the server knows it.
        grip_m: (3,) where the handle is taken, metres.
        to_m: (3,) where it goes and comes back from, metres.
        marks: what the server notes meanwhile.
        steps: how many moves.
        how: of ``STEPS``.
        drone: what is watched, by its name in the scene.
    """
    (x, y), (to_x, to_y) = on_screen(page, camera, grip_m), on_screen(page, camera, to_m)
    page.mouse.move(x, y)
    page.wait_for_timeout(1000)
    page.mouse.down()
    page.mouse.move(x + 1, y)
    page.wait_for_timeout(1000)
    page.evaluate(_WATCH, drone)
    marks.heard.clear()
    marks.solved.clear()
    for step in range(steps):
        share = 0.5 - 0.5 * np.cos(2.0 * np.pi * (step + 1) / steps)
        page.mouse.move(x + share * (to_x - x), y + share * (to_y - y))
        page.wait_for_timeout(STEPS[how])
    page.wait_for_timeout(300)
    page.mouse.up()
    inputs, poses, panels, frames = page.evaluate("() => [npInput, npPose, npPanel, npFrames]")
    page.wait_for_timeout(3000)
    return _parts(inputs, poses, panels, marks) | {"frame_ms": round(float(np.median(frames[1:])), 1)}


def _parts(inputs: list[float], poses: list[Any], panels: list[Any], marks: Marks) -> dict[str, Any]:
    names = ("end to end", "to the server", "server", "to the screen", "with the numbers")
    parts: dict[str, list[float]] = {name: [] for name in names}
    for began_ms in inputs:
        began = 1e-3 * began_ms
        heard = next(((at, version) for at, version in marks.heard if at >= began), None)
        if heard is None:
            continue
        solved = next((at for at, version, _ in marks.solved if version >= heard[1]), None)
        wanted = [position for _, version, position in marks.solved if version >= heard[1]]
        shown = [place for at, place in poses if 1e-3 * at <= heard[0]]
        if wanted and shown and _is_one_of(shown[-1], wanted[:1]):
            continue  # the best place is the same: there is no new pose to wait for
        posed = next(
            (1e-3 * at for at, place in poses if 1e-3 * at > heard[0] and _is_one_of(place, wanted)), None
        )
        told = next((1e-3 * at for at, version in panels if version >= heard[1]), None)
        if solved is None or posed is None or told is None:
            continue
        spans = (posed - began, heard[0] - began, solved - heard[0], posed - solved, max(posed, told) - began)
        for name, span in zip(names, spans, strict=True):
            parts[name].append(span)
    return {name: summary(seconds) for name, seconds in parts.items()} | {"moves": len(inputs)}


def _is_one_of(place_m: Any, wanted_m: list[Any]) -> bool:
    return any(np.allclose(place_m, wanted, rtol=0.0, atol=_SAME_M) for wanted in wanted_m)


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
