"""The solves, in a process of their own: its peak of memory is theirs alone."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from benchmarks.environment import ROOT
from benchmarks.workload import Progress, Row
from benchmarks.workloads.certified_fields.record import Memory, Purpose, Record, to_row
from benchmarks.workloads.fields.scenes import Scene
from nullpose.physics import min_sinr
from nullpose.solver import solve

__all__ = ["FULL", "QUICK", "Plan", "measure_apart", "run_all"]

_MODULE = "benchmarks.workloads.certified_fields"


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """Which scenes are solved, and with what.

    Args:
        nodes: numbers of nodes.
        jammers: numbers of jammers.
        jamming_ratios: total jamming powers over the power of a node, P_M / P.
        seeds: how many of the positions.
        gap: relative gap of the proofs.
        tight_gap: relative gap of the proofs with ``tight_nodes`` nodes and one jammer.
        tight_nodes: how many nodes those have.
        cap_s: seconds that each solve has.
        hurry_s: seconds that a solve in a hurry has, in the scenes with most nodes and jammers.
    """

    nodes: tuple[int, ...] = (2, 3, 5, 10, 30, 100)
    jammers: tuple[int, ...] = (1, 3, 10)
    jamming_ratios: tuple[float, ...] = (0.1, 1.0, 10.0, 100.0)
    seeds: int = 5
    gap: float = 1e-3
    tight_gap: float = 1e-4
    tight_nodes: int = 10
    cap_s: float = 10.0
    hurry_s: float = 0.05

    def solves(self) -> Iterator[tuple[Purpose, Scene, float, float]]:
        """Yield purpose, scene, gap and time limit of every solve."""
        each = list(product(self.jamming_ratios, range(self.seeds)))
        asked = (
            (Purpose.FIELD, product(self.nodes, self.jammers), self.gap, self.cap_s),
            (Purpose.TIGHT, ((self.tight_nodes, 1),), self.tight_gap, self.cap_s),
            (Purpose.HURRIED, ((max(self.nodes), max(self.jammers)),), self.gap, self.hurry_s),
        )
        for purpose, sizes, gap, limit_s in asked:
            for (nodes, jammers), (ratio, seed) in product(sizes, each):
                yield (
                    purpose,
                    Scene(nodes=nodes, jammers=jammers, jamming_ratio=ratio, seed=seed),
                    gap,
                    limit_s,
                )


FULL = Plan()
QUICK = Plan(nodes=(2, 3, 5, 10), jamming_ratios=(10.0,), seeds=1)


def measure_apart(*, quick: bool, progress: Progress) -> list[Row]:
    """Return all rows, measured in a process of their own.

    Args:
        quick: the small sample.
        progress: told of every solve.

    Raises:
        RuntimeError: the process failed.
    """
    plan = QUICK if quick else FULL
    progress.begin(len(list(plan.solves())))
    command = [sys.executable, "-m", _MODULE, *(["--quick"] if quick else [])]
    # once for the kernels alone: what compiling takes is no part of a solve's memory
    subprocess.run([*command, "--warm-up"], cwd=ROOT, check=False, stdout=subprocess.DEVNULL)
    rows: list[Row] = []
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
        for line in process.stdout or ():
            row = json.loads(line)
            rows.append(row)
            if "scene" in row:
                progress.step(f"{row['purpose']}: {Scene(**row['scene'])}")
    if process.returncode != 0:
        raise RuntimeError(f"{_MODULE} ended with exit code {process.returncode}")
    return rows


def run_all(plan: Plan) -> Iterator[Row]:
    """Yield a row per solve, then the memory of this process."""
    warm_up()
    loaded_mb = peak_memory_mb()
    for purpose, scene, gap, limit_s in plan.solves():
        yield to_row(run(purpose, scene, gap, limit_s))
    yield to_row(Memory(loaded_mb=loaded_mb, peak_mb=peak_memory_mb()))


def warm_up() -> None:
    """Load the kernels, or compile them."""
    solve(Scene(nodes=2, jammers=1, jamming_ratio=1.0, seed=0).scenario(boxed=False), gap=1e-3)


def run(purpose: Purpose, scene: Scene, gap: float, time_limit_s: float) -> Record:
    """Return the record of one solve; whatever it raises is its status.

    Args:
        purpose: which of the workload's questions it answers.
        scene: the scene.
        gap: relative gap asked for.
        time_limit_s: seconds that it has.
    """
    scenario = scene.scenario(boxed=False)
    began = time.perf_counter()
    try:
        solution = solve(scenario, gap=gap, time_limit_s=time_limit_s)
    except Exception as error:  # a failure is a row, and the other scenes go on
        return Record(
            purpose=purpose,
            scene=scene,
            gap=gap,
            time_limit_s=time_limit_s,
            seconds=time.perf_counter() - began,
            status=f"{type(error).__name__}: {error}",
        )
    seconds = time.perf_counter() - began
    bound = solution.objective.upper_bound
    return Record(
        purpose=purpose,
        scene=scene,
        gap=gap,
        time_limit_s=time_limit_s,
        seconds=seconds,
        boxes=solution.stats.boxes,
        status=solution.status.value,
        value=min_sinr(scenario, solution.pose),
        bound=float("inf") if bound is None else bound,
    )


def peak_memory_mb() -> float:
    """Return the most resident memory that this process has had, in 1e6 B; NaN where nothing tells.

    Linux's own figure for the address space comes first: ``ru_maxrss`` of a process begins with what its
    parent had when it started it.
    """
    status = Path("/proc/self/status")
    if status.is_file():
        for line in status.read_text(encoding="ascii").splitlines():
            if line.startswith("VmHWM:"):
                return float(line.split()[1]) * 1024.0 / 1e6
    try:
        import resource
    except ImportError:  # not on Windows
        return float("nan")
    unit = 1.0 if sys.platform == "darwin" else 1024.0
    return float(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) * unit / 1e6
