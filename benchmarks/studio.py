"""How long the studio takes from a moved jammer to its answer, and whether random edits make it grow."""

from __future__ import annotations

import statistics
import time
from typing import Any

import numpy as np
import pandas as pd
import psutil

from benchmarks.machine import ROOT, Progress
from nullpose.scenario import Scenario, load
from nullpose.studio.answer import Answer
from nullpose.studio.session import Session
from nullpose.studio.state import State

TITLE = "Studio"
ABOUT = """From a jammer's move in the server to the answer that is drawn for it, without a browser,
which adds some 60 ms for each frame without a graphics card; and the growth of the process over the
moves."""


def measure(quick: bool, progress: Progress) -> list[dict[str, Any]]:
    """Move the first jammer of each scene step by step, a row each."""
    scenes = {"paper's scene": load(ROOT / "examples" / "paper.toml"), "50 nodes, 5 jammers": _crowd()}
    return [_moved(name, scene, 20 if quick else 200) for name, scene in progress(list(scenes.items()))]


def _crowd() -> Scenario:
    rng = np.random.default_rng(0)
    return Scenario.from_arrays(
        np.column_stack([rng.uniform(0.0, 300.0, (50, 2)), np.zeros(50)]),
        np.column_stack([rng.uniform(0.0, 300.0, (5, 2)), np.full(5, 2.0)]),
        noise_w=1e-6,
        altitude_m=(20.0, 120.0),
    )


def _moved(name: str, scene: Scenario, steps: int) -> dict[str, Any]:
    answered: dict[int, float] = {}

    def note(event: object) -> None:
        if isinstance(event, Answer):
            answered.setdefault(event.version, time.perf_counter())

    session = Session(State(scenario=scene), on_event=note, rest_s=10.0)
    session.start()
    while 1 not in answered:
        time.sleep(0.05)
    place, times, process = np.array(scene.jammers[0].position_m), [], psutil.Process()
    before_mb = process.memory_info().rss / 1e6
    for step in range(1, steps + 1):
        start = time.perf_counter()
        moved = place + np.array([0.05 * step, 0.0, 0.0])
        session.change(lambda state, moved=moved: state.moved(("jammers", 0), moved), "drag")
        while session.state.version not in answered:
            time.sleep(0.0005)
        times.append(1e3 * (answered[session.state.version] - start))
    session.close()
    return {
        "scene": name,
        "moves": steps,
        "median_ms": statistics.median(times),
        "p95_ms": float(np.percentile(times, 95.0)),
        "grown_mb": process.memory_info().rss / 1e6 - before_mb,
    }


def tables(rows: list[dict[str, Any]]) -> dict[str, pd.DataFrame]:
    """Lay the rows out as they are."""
    return {"From a move to its answer": pd.DataFrame(rows)}


def faults(rows: list[dict[str, Any]]) -> list[str]:
    """Name scenes whose answer takes longer than 350 ms in the median."""
    return [f"{row['scene']}: {row['median_ms']:.0f} ms" for row in rows if row["median_ms"] > 350.0]
