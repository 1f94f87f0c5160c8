"""Random scenes of 2 to 100 nodes with their proofs: what closes, in which time, with how many boxes."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pandas as pd

from benchmarks.machine import Progress
from benchmarks.scenes import field_scenes
from nullpose.physics import min_sinr
from nullpose.solver import solve

TITLE = "Random fields proved"
ABOUT = """Each scene is solved and proved to a relative gap of 1e-3 in at most 10 s, kernels loaded, the
whole Python call timed; the drone may go anywhere horizontally. The exponent is that of the median time
against the number of nodes, a straight line fitted to the logarithms."""

GAP = 1e-3


def measure(quick: bool, progress: Progress) -> list[dict[str, Any]]:
    """Solve every scene with its proof, a row each."""
    nodes, jammers = ((2, 3, 5, 10), (1, 3)) if quick else ((2, 3, 5, 10, 30, 100), (1, 3, 10))
    scenes = list(field_scenes(quick=quick, nodes=nodes, jammers=jammers))
    solve(scenes[0].scenario(boxed=False), gap=GAP)  # compiles or loads
    rows = []
    for scene in progress(scenes):
        scenario = scene.scenario(boxed=False)
        start = time.perf_counter()
        result = solve(scenario, gap=GAP, time_limit_s=10.0)
        seconds = time.perf_counter() - start
        found = {"value": min_sinr(scenario, result.pose), "bound": result.objective.upper_bound}
        made = {"seconds": seconds, "boxes": result.stats.boxes, "status": str(result.status)} | found
        rows.append({"scene": str(scene), "nodes": scene.nodes, "jammers": scene.jammers} | made)
    return rows


def tables(rows: list[dict[str, Any]]) -> dict[str, pd.DataFrame]:
    """Summarise times and boxes by size, and the growth with the number of nodes."""
    frame = pd.DataFrame(rows)
    groups = frame.groupby(["nodes", "jammers"])
    table = groups.agg(
        scenes=("status", "size"),
        certified=("status", lambda s: (s == "certified").sum()),
        median_ms=("seconds", lambda s: 1e3 * s.median()),
        worst_ms=("seconds", lambda s: 1e3 * s.max()),
        median_boxes=("boxes", "median"),
        worst_boxes=("boxes", "max"),
    ).reset_index()
    exponents = [
        {"jammers": jammers, "exponent": np.polyfit(np.log(group["nodes"]), np.log(group["median_ms"]), 1)[0]}
        for jammers, group in table.groupby("jammers")
    ]
    return {"Proofs": table, "Growth with the number of nodes": pd.DataFrame(exponents)}


def faults(rows: list[dict[str, Any]]) -> list[str]:
    """Name certified scenes whose two numbers are further apart than the gap, or the wrong way round."""
    return [
        f"{row['scene']}: value {row['value']!r}, bound {row['bound']!r}"
        for row in rows
        if row["bound"] < row["value"] * (1.0 - 1e-12)
        or (row["status"] == "certified" and row["bound"] > row["value"] * (1.0 + 1.001 * GAP))
    ]
