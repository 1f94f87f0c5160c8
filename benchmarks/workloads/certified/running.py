"""The clock: nullpose, then every prover in a process of its own, at one jamming power."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.environment import ROOT
from benchmarks.provers import FINISHED, NOT_CLOSED, Claim, Problem, Prover
from benchmarks.summaries import median
from benchmarks.workloads.certified.record import Record
from nullpose.physics import Pose, min_sinr
from nullpose.scenario import Scenario, apply_overrides, load
from nullpose.solver import solve

if TYPE_CHECKING:
    from nullpose.solver import Result

__all__ = ["GAP", "NULLPOSE", "certify", "missing", "paper_scene", "run_nullpose", "run_prover"]

NULLPOSE = "nullpose"
GAP = 1e-4

_EXAMPLE = ROOT / "examples" / "paper.toml"
_NULLPOSE_REPEATS = 21
_GRACE_S = 60.0  # beyond its own limit, for imports and for a last step that looks at no clock
_CERTIFIED = "certified"


def paper_scene(jamming_ratio: float) -> Scenario:
    """Return the paper's scene with a jamming power, given over the power of a node."""
    scene = load(_EXAMPLE)
    power_w = jamming_ratio * scene.nodes[0].power_w
    return apply_overrides(scene, [f"jammers.M.power_w={power_w!r}"])


def certify(scene: Scenario) -> Result:
    """Return nullpose's solution with its proof: all that the workload asks of nullpose."""
    return solve(scene, gap=GAP)


def missing(prover: Prover) -> str:
    """Return why a prover cannot run here; empty if it can."""
    if find_spec(prover.package) is None:
        return f"{prover.label} left out: no package {prover.package}; pip install {prover.package}"
    return ""


def run_nullpose(jamming_ratio: float) -> tuple[Record, Pose]:
    """Return nullpose's record, the median of several calls, and its pose, the start of every prover.

    Args:
        jamming_ratio: jamming power over the power of a node.
    """
    scene = paper_scene(jamming_ratio)
    solution = certify(scene)  # compiles or loads
    times = []
    for _ in range(_NULLPOSE_REPEATS):
        began = time.perf_counter()
        solution = certify(scene)
        times.append(time.perf_counter() - began)
    value = min_sinr(scene, solution.pose)
    bound = solution.objective.upper_bound
    record = Record(
        method=NULLPOSE,
        jamming_ratio=jamming_ratio,
        status=FINISHED if solution.status == _CERTIFIED else NOT_CLOSED,
        claimed_value=solution.objective.value,
        claimed_bound=float("inf") if bound is None else bound,
        value=value,
        seconds=median(times),
        nodes=solution.stats.boxes,
        known=value,
        gap=GAP,
    )
    return record, solution.pose


def run_prover(prover: Prover, jamming_ratio: float, start: Pose, *, cap_s: float, repeats: int) -> Record:
    """Return a prover's record, its pose evaluated by nullpose's physics.

    Args:
        prover: the solver with its formulation.
        jamming_ratio: jamming power over the power of a node.
        start: the best pose known.
        cap_s: seconds that it has.
        repeats: runs to take the median of; a slow one is run once.
    """
    scene = paper_scene(jamming_ratio)
    problem = _problem(scene, start, cap_s)
    claim = _claim_of(prover, problem, repeats)
    value = float("nan")
    if claim.position_m and any(claim.axis):
        value = min_sinr(scene, Pose.from_axis(claim.position_m, claim.axis))
    return Record(
        method=prover.name,
        jamming_ratio=jamming_ratio,
        status=claim.status,
        claimed_value=claim.value,
        claimed_bound=claim.bound,
        value=value,
        seconds=claim.seconds,
        nodes=claim.nodes,
        known=problem.start_value,
        gap=GAP,
        cap_s=cap_s,
    )


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
                input=json.dumps(problem.to_dict()),
                capture_output=True,
                text=True,
                timeout=problem.cap_s * repeats + _GRACE_S,
            )
        except subprocess.TimeoutExpired:
            return Claim(status="did not stop", seconds=problem.cap_s)
        if done.returncode != 0 or not answer.exists():
            lines = done.stderr.strip().splitlines()
            return Claim(status=f"failed: {lines[-1] if lines else f'exit code {done.returncode}'}")
        return Claim(**json.loads(answer.read_text(encoding="utf-8")))
