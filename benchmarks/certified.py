"""The paper's scene proved to 1e-4 at ten jamming powers, beside SCIP and MAiNGO: times, and true claims."""

from __future__ import annotations

import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import Any

import pandas as pd

from benchmarks.machine import ROOT, Progress
from benchmarks.provers import FINISHED, NOT_CLOSED, PROVERS, Claim, Problem, Prover
from nullpose.physics import Pose, min_sinr
from nullpose.scenario import Scenario, apply_overrides, load
from nullpose.solver import solve

TITLE = "The paper's scene proved, beside global solvers"
ABOUT = """The optimum of `examples/paper.toml` and a bound that no pose exceeds, to a relative gap of
1e-4, on one thread. The general solvers get lengths in units of 25 m, the optimum as a start and only
the part of space that its value leaves open; nullpose is timed from the scenario alone. Their
formulations are the best of about a dozen tried for each. A claim is *true* if it is closed, its pose
reaches its value and no method's pose is above its bound, a tenth of the gap being left to a solver's
tolerance."""

GAP = 1e-4
_RATIOS = tuple(10.0**exponent for exponent in range(-3, 7))
_REPEATS = 21
_GRACE_S = 60.0  # beyond a prover's own limit, for imports and a last step that looks at no clock
_SLACK = 0.1 * GAP


def paper_scene(jamming_ratio: float) -> Scenario:
    """Load the paper's scene with a jamming power, given over the power of a node."""
    scene = load(ROOT / "examples" / "paper.toml")
    return apply_overrides(scene, [f"jammers.M.power_w={jamming_ratio * scene.nodes[0].power_w!r}"])


def measure(quick: bool, progress: Progress) -> list[dict[str, Any]]:
    """Measure nullpose, then every installed prover in a process of its own, at each jamming power."""
    ratios = _RATIOS[3:4] if quick else _RATIOS
    cap_s, repeats = (10.0, 1) if quick else (100.0, 3)
    provers = [prover for prover in PROVERS if find_spec(prover.package) is not None]
    rows: list[dict[str, Any]] = []
    for ratio, prover in progress(list(product(ratios, (None, *provers)))):
        if prover is None:
            row, pose = _nullpose_row(ratio)
            rows.append(row)
        else:
            rows.append(_prover_row(prover, ratio, pose, cap_s, repeats))
    return rows


def _nullpose_row(ratio: float) -> tuple[dict[str, Any], Pose]:
    scene, times = paper_scene(ratio), []
    result = solve(scene, gap=GAP)  # compiles or loads
    for _ in range(_REPEATS):
        start = time.perf_counter()
        result = solve(scene, gap=GAP)
        times.append(time.perf_counter() - start)
    status = FINISHED if result.status == "certified" else NOT_CLOSED
    claim = Claim(
        status=status,
        value=result.objective.value,
        bound=result.objective.upper_bound or math.inf,
        nodes=result.stats.boxes,
        seconds=statistics.median(times),
    )
    return _row("nullpose", ratio, claim, min_sinr(scene, result.pose)), result.pose


def _prover_row(prover: Prover, ratio: float, start: Pose, cap_s: float, repeats: int) -> dict[str, Any]:
    scene = paper_scene(ratio)
    claim = _claim_of(prover, _problem(scene, start, cap_s), repeats)
    value = math.nan
    if claim.position_m and any(claim.axis):
        value = min_sinr(scene, Pose.from_axis(claim.position_m, claim.axis))
    return _row(prover.label, ratio, claim, value)


def _row(method: str, ratio: float, claim: Claim, value: float) -> dict[str, Any]:
    found = {"jamming_ratio": ratio, "method": method, "value": value, "seconds": claim.seconds}
    claimed = {"status": claim.status, "claimed_value": claim.value, "bound": claim.bound}
    return found | claimed | {"boxes": claim.nodes}


def _problem(scene: Scenario, start: Pose, cap_s: float) -> Problem:
    axis = start.antenna_axis if start.antenna_axis[2] >= 0.0 else -start.antenna_axis
    gain = scene.receiver.reference_gain
    return Problem(
        nodes_m=tuple(map(tuple, scene.node_positions_m.tolist())),
        powers_w=tuple((gain * scene.node_powers_w).tolist()),
        jammer_m=tuple(scene.jammer_positions_m[0].tolist()),
        jamming_w=float(gain * scene.jammer_powers_w[0]),
        noise_w=scene.receiver.noise_power_w,
        altitude_m=(float(scene.airspace.lower_m[2]), float(scene.airspace.upper_m[2])),
        gap=GAP,
        cap_s=cap_s,
        start_value=min_sinr(scene, start),
        start_position_m=tuple(start.position_m.tolist()),
        start_axis=tuple(axis.tolist()),
    )


def _claim_of(prover: Prover, problem: Problem, repeats: int) -> Claim:
    with tempfile.TemporaryDirectory(prefix="nullpose-bench-") as folder:
        answer = Path(folder) / "claim.json"
        command = [sys.executable, "-m", "benchmarks.provers", prover.name, str(answer), str(repeats)]
        try:
            done = subprocess.run(
                command,
                cwd=ROOT,
                input=json.dumps(asdict(problem)),
                capture_output=True,
                text=True,
                timeout=problem.cap_s * repeats + _GRACE_S,
            )
        except subprocess.TimeoutExpired:
            return Claim(status="did not stop", seconds=problem.cap_s)
        if done.returncode != 0 or not answer.exists():
            return Claim(status=f"failed: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
        return Claim(**json.loads(answer.read_text(encoding="utf-8")))


def verdict(row: dict[str, Any], best: float) -> str:
    """Judge a claim by the poses: "true", or all that is wrong with it."""
    if row["status"] not in (FINISHED, NOT_CLOSED):
        return str(row["status"])
    wrong = {
        NOT_CLOSED: row["status"] == NOT_CLOSED,
        "value above the optimum": row["claimed_value"] > best * (1.0 + _SLACK),
        "pose below its value": not row["claimed_value"] <= row["value"] * (1.0 + _SLACK),
        "bound below a pose": row["bound"] < best * (1.0 - 1e-9),
        "wider than the gap": row["status"] == FINISHED
        and not row["bound"] <= row["value"] * (1.0 + GAP + _SLACK),
    }
    return ", ".join(words for words, holds in wrong.items() if holds) or "true"


def _judged(rows: list[dict[str, Any]]) -> pd.DataFrame:
    frame = pd.DataFrame(rows)
    best = frame.groupby("jamming_ratio")["value"].transform("max")
    frame["verdict"] = [verdict(row, value) for row, value in zip(rows, best, strict=True)]
    return frame


def tables(rows: list[dict[str, Any]]) -> dict[str, pd.DataFrame]:
    """Summarise times in ms, verdicts of claims that are not true, and the lead over the fastest true one."""
    frame = _judged(rows)
    is_true = frame["verdict"] == "true"
    frame["cell"] = (1e3 * frame["seconds"]).map("{:.1f}".format).where(is_true, frame["verdict"])
    times = frame.pivot(index="jamming_ratio", columns="method", values="cell")[frame["method"].unique()]
    proofs = frame[is_true].set_index("jamming_ratio")
    rival = proofs[proofs["method"] != "nullpose"].groupby("jamming_ratio")["seconds"].min()
    times["times nullpose"] = rival / proofs[proofs["method"] == "nullpose"]["seconds"]
    return {"Time of a true claim, ms": times.reset_index()}


def faults(rows: list[dict[str, Any]]) -> list[str]:
    """Name the jamming powers at which nullpose's own claim is not true."""
    frame = _judged(rows)
    wrong = frame[(frame["method"] == "nullpose") & (frame["verdict"] != "true")]
    return [f"P_M/P = {row.jamming_ratio:g}: nullpose's claim is {row.verdict}" for row in wrong.itertuples()]
