"""From a drag to the new pose: what the server takes, and what the hand sees in a browser."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.studio.chromium import opened
from benchmarks.studio.drag import STEPS, Marks, dragged, summary
from benchmarks.studio.floor import empty_page
from nullpose import load
from nullpose.scenario import Jammer, Scenario
from nullpose.studio.answer import Answer
from nullpose.studio.server import studio
from nullpose.studio.session import Session

__all__ = ["latency"]

_EXAMPLES = Path(__file__).parents[2] / "examples"


def latency(steps: int) -> dict[str, Any]:
    """Return the times of the paper's scene, of ten nodes and three jammers, and of fifty and five, ms.

    Beside them stands the floor: a page with nothing but a handle and a box, whose server answers at once.

    Args:
        steps: drag steps of each.
    """
    scenes = {"paper": load(_EXAMPLES / "paper.toml"), "ten nodes, three jammers": _ten_and_three()}
    scenes["fifty nodes, five jammers"] = _fifty_and_five()
    found: dict[str, Any] = {"a handle and a box, no solver": _floor(steps)}
    for name, scene in scenes.items():
        found[name] = {"server": _server(scene, 3 * steps), **_browser(scene, steps)}
    return found


def _ten_and_three() -> Scenario:
    field = load(_EXAMPLES / "field.toml")
    third = Jammer(name="third", position_m=(-20.0, 60.0, 3.0), power_w=1.0)
    jammers = (*field.jammers, third)[:3]
    assert (len(field.nodes), len(jammers)) == (10, 3)
    return field.model_copy(update={"jammers": jammers})


def _fifty_and_five() -> Scenario:
    rng = np.random.default_rng(0)
    return Scenario.from_arrays(
        np.column_stack([rng.uniform(0.0, 300.0, (50, 2)), np.zeros(50)]),
        np.column_stack([rng.uniform(0.0, 300.0, (5, 2)), np.full(5, 2.0)]),
        noise_w=1e-6,
        altitude_m=(20.0, 120.0),
    )


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
        place = start + np.array([0.05 * (step + 1), 0.0, 0.0])
        session.change(lambda view, place=place: view.moved(("jammers", 0), place), "drag")
        while session.version not in answered:
            time.sleep(0.0005)
        took.append(answered[session.version] - began)
    session.close()
    return summary(took)


def _browser(scene: Scenario, steps: int) -> dict[str, Any]:
    with studio(scene, port=0) as running, opened(running.address, scale=1.0) as page:
        page.wait_for_timeout(6000)
        ours = next(iter(running.pages.values()))
        ours._editor.selected = ("jammers", 0)  # which has arrows then
        ours._refresh()
        page.wait_for_timeout(2000)
        marks = Marks()
        change, told = ours.session.change, ours.session._on_event

        def changed(*arguments: Any) -> None:
            heard = time.time()
            change(*arguments)
            marks.heard.append((heard, ours.session.version))

        def tell(event: Any) -> None:
            if isinstance(event, Answer):
                marks.solved.append((time.time(), event.version, event.result.pose.position_m))
            told(event)

        ours.session.change, ours.session._on_event = changed, tell
        start = np.array(scene.jammers[0].position_m)
        grip = start + np.array([0.06 * ours.stage.size_m, 0.0, 0.0])
        to = grip + np.array([0.1 * ours.stage.size_m, 0.0, 0.0])
        return {
            how: dragged(page, ours._client.camera, grip, to, marks, steps, how, "/drone-a/body")
            for how in STEPS
        }


def _floor(steps: int) -> dict[str, Any]:
    marks = Marks()
    with empty_page(marks) as (address, camera, grip, to), opened(address, scale=1.0) as page:
        page.wait_for_timeout(3000)
        return {how: dragged(page, camera(), grip, to, marks, steps, how, "/box") for how in STEPS}
