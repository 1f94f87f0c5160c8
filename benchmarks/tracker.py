"""How long a step of a tracker takes while jammers move at 5 to 8 m/s and places come 100 times a second."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pandas as pd

from benchmarks.machine import Progress
from nullpose.scenario import Scenario
from nullpose.solver import Tracker

TITLE = "Tracker"
ABOUT = """Steps of `nullpose.Tracker` on one thread, each certified to 1e-3: the whole Python call, as a
clock on the wall and as the thread's processor time has it, which other processes delay less. *Circle*: two
nodes 50 m apart, a jammer that goes round between them at 5 m/s, places 100 times a second. *Cross*: the
same nodes, a jammer that passes by, and the best pose jumps. *Crowd*: a random field whose jammers go round
at 5 m/s. Jumps are steps in which the pose moves by more than 5 m: these are certified like any other."""

GAP = 1e-3
STEP_S = 0.01
_LIMITS_MS = {2: (2.0, 10.0), 10: (40.0, np.inf)}  # by nodes: of the median, and of 999 steps in 1,000
_JUMP_M = 5.0
_Places = Callable[[float], np.ndarray]


def measure(quick: bool, progress: Progress) -> list[dict[str, Any]]:
    """Follow every scene, a row each."""
    many, few = (200, 20) if quick else (10_000, 1_000)
    return [
        _followed(name, scene, jammers_m, many if len(scene.nodes) == 2 else few)
        for name, scene, jammers_m in progress(list(_scenes()))
    ]


def _scenes() -> Iterator[tuple[str, Scenario, _Places]]:
    """Yield the scenes by name, with where the jammers are at a time."""
    pair_m, rng = np.array([[0.0, 0.0, 0.0], [0.0, 50.0, 0.0]]), np.random.default_rng(0)
    field_m = np.column_stack([rng.uniform(0.0, 100.0, (10, 2)), np.zeros(10)])
    centres_m = np.column_stack([rng.uniform(0.0, 100.0, (3, 2)), np.full(3, 4.0)])
    tracks: dict[str, tuple[np.ndarray, _Places]] = {
        "circle": (pair_m, lambda t_s: _round(np.array([[0.0, 25.0, 4.0]]), t_s)),
        "cross": (pair_m, lambda t_s: np.array([[7.727 * (t_s - 30.0), 20.0 + 2.071 * (t_s - 30.0), 4.0]])),
        "crowd": (field_m, lambda t_s: _round(centres_m, t_s)),
    }
    for name, (nodes_m, jammers_m) in tracks.items():
        for ratio in (1.0, 100.0):
            scene = Scenario.from_arrays(
                nodes_m, jammers_m(0.0), jammer_power_w=ratio, noise_w=1e-3, altitude_m=(8.0, 30.0)
            )
            yield f"{name}, P_M/P = {ratio:g}", scene, jammers_m


def _round(centres_m: np.ndarray, t_s: float) -> np.ndarray:
    angle = 0.25 * t_s + np.arange(len(centres_m))
    return centres_m + 20.0 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])


def _followed(name: str, scene: Scenario, jammers_m: _Places, steps: int) -> dict[str, Any]:
    tracker, walls, threads = Tracker(scene, GAP), [], []
    certified, places_m = 0, [tracker.update().pose.position_m]  # the first step loads what is compiled
    for step in range(steps):
        at_m = jammers_m(STEP_S * step * (6000 / steps if name.startswith("cross") else 1.0))
        wall, thread = time.perf_counter(), time.thread_time()
        result = tracker.update(jammers_m=at_m)
        threads.append(1e3 * (time.thread_time() - thread))
        walls.append(1e3 * (time.perf_counter() - wall))
        certified += result.status == "certified"
        places_m.append(result.pose.position_m)
    return {
        "scene": name,
        "nodes": len(scene.nodes),
        "jammers": len(scene.jammers),
        "steps": steps,
        "certified": certified,
        "jumps": int(np.sum(np.linalg.norm(np.diff(places_m, axis=0), axis=1) > _JUMP_M)),
        "median_ms": float(np.median(walls)),
        "p99.9_ms": float(np.percentile(walls, 99.9)),
        "median_thread_ms": float(np.median(threads)),
        "p99.9_thread_ms": float(np.percentile(threads, 99.9)),
    }


def tables(rows: list[dict[str, Any]]) -> dict[str, pd.DataFrame]:
    """Lay the rows out as they are."""
    return {"Steps": pd.DataFrame(rows)}


def faults(rows: list[dict[str, Any]]) -> list[str]:
    """Name scenes with a step that is not certified, or whose steps take a thread too long."""
    return [
        f"{row['scene']}: {row['certified']} of {row['steps']} certified, {row['median_thread_ms']:.2f} ms "
        f"in the median, {row['p99.9_thread_ms']:.1f} ms at the 99.9th percentile"
        for row in rows
        if row["certified"] < row["steps"]
        or row["median_thread_ms"] > _LIMITS_MS[row["nodes"]][0]
        or row["p99.9_thread_ms"] > _LIMITS_MS[row["nodes"]][1]
    ]
