"""200 random scenes: does the search of ``solve`` find the best optimum, how fast, beside other solvers?"""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pandas as pd

from benchmarks.five_pose import FivePose
from benchmarks.machine import Progress
from benchmarks.peers import PEERS, Budget
from benchmarks.scenes import Scene, field_scenes
from nullpose.physics import Pose, min_sinr
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.solver import solve
from nullpose.solver.multistart import SearchSettings, multistart

TITLE = "Random fields against general-purpose solvers"
ABOUT = """Nodes and jammers at random in a square of 100 m. The peers minimise the compiled function
that nullpose maximises over (x, y, z, roll, pitch), on one thread, after a warm-up; their last stage
ends with a local search that uses nullpose's slopes. A *hit* is within 1e-6 of the best value that any
method, or a reference search with 20 times the work, finds in the scene. All poses are evaluated by the
physics."""

_FULL = Budget(evaluations=50_000, starts=128)
_QUICK = Budget(evaluations=5_000, starts=32)
_REFERENCE = SearchSettings(coarse=1920, polished=480, rounds=12, patience=4)
_HIT = 1e-6


def measure(quick: bool, progress: Progress) -> list[dict[str, Any]]:
    """Measure every method at each of its stages, a row each."""
    scenes = list(field_scenes(quick=quick))
    budget = _QUICK if quick else _FULL
    list(_rows(scenes[0], _QUICK))  # compiles, and imports what the peers import
    return [row for scene in progress(scenes) for row in _rows(scene, budget)]


def _rows(scene: Scene, budget: Budget) -> Iterator[dict[str, Any]]:
    scenario = scene.scenario()

    def row(method: str, stage: str, seconds: float, pose: Pose) -> dict[str, Any]:
        found = {"seconds": seconds, "value": min_sinr(scenario, pose)}
        return {"scene": str(scene), "nodes": scene.nodes, "method": method, "stage": stage} | found

    for method, certify in (("nullpose, search alone", False), ("nullpose, certified", True)):
        start = time.perf_counter()
        result = solve(scenario, certify=certify, seed=0)
        yield row(method, "solve", time.perf_counter() - start, result.pose)
    start = time.perf_counter()
    reference = multistart(build_family(scenario), AxisField.free(), seed=1, settings=_REFERENCE)
    seconds = time.perf_counter() - start
    yield row("reference", "search", seconds, Pose.from_axis(reference.position_m, reference.axis))
    for method, answers in PEERS.items():
        problem, seconds, start = FivePose.of(scenario), 0.0, time.perf_counter()
        for stage, x in answers(problem, budget, 0):
            seconds += time.perf_counter() - start
            yield row(method, stage, seconds, problem.pose(x))
            start = time.perf_counter()  # the clock stands still while an answer is evaluated


def tables(rows: list[dict[str, Any]]) -> dict[str, pd.DataFrame]:
    """Summarise the hits, times and shortfalls of each method and stage."""
    frame = pd.DataFrame(rows)
    best = frame.groupby("scene")["value"].transform("max")
    frame["shortfall"] = (best - frame["value"]) / best
    frame["hit"] = frame["shortfall"] <= _HIT
    groups = frame[frame["method"] != "reference"].groupby(["method", "stage"], sort=False)
    table = groups.agg(
        scenes=("hit", "size"),
        hits=("hit", "sum"),
        median_ms=("seconds", lambda s: 1e3 * s.median()),
        p95_ms=("seconds", lambda s: 1e3 * s.quantile(0.95)),
        worst_shortfall=("shortfall", "max"),
    ).reset_index()
    table["times_nullpose"] = table["median_ms"] / table["median_ms"].iloc[0]
    last = frame.groupby(["method", "scene"], sort=False).last().reset_index()
    times = last.groupby(["method", "nodes"], sort=False)["seconds"].median()
    sizes = times.mul(1e3).unstack().add_prefix("N = ")
    return {"Hits and times": table, "Median time, ms": sizes.drop(index="reference").reset_index()}


def faults(rows: list[dict[str, Any]]) -> list[str]:
    """Name what breaks a promise: 99.5 % hits, and no general solver as good in ten times the time."""
    table = tables(rows)["Hits and times"]
    nullpose = table.iloc[0]
    found = [] if nullpose.hits >= 0.995 * nullpose.scenes else [f"{nullpose.hits} of {nullpose.scenes} hits"]
    general = table[~table["method"].str.contains("nullpose|SLSQP")]
    rivals = general[(general["hits"] >= nullpose.hits) & (general["times_nullpose"] < 10.0)]
    return found + [f"{method} hits as often in less than ten times the time" for method in rivals["method"]]
