"""The workload "kernels": microseconds of the four steps that a solve is made of."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.markdown import table
from benchmarks.metric import TIMING, Direction, Metric
from benchmarks.summaries import median
from benchmarks.workload import Progress, Row, Section
from benchmarks.workloads.fields.scenes import ALTITUDE_M, SIDE_M, Scene
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.solver import solve
from nullpose.solver.kernels.axis import best_axis
from nullpose.solver.kernels.jit import heap_kernel
from nullpose.solver.kernels.links import min_log_ratio
from nullpose.solver.kernels.polish import polish

__all__ = ["Kernels"]

NODES = (2, 10, 100)
STEPS = {
    "min_log_ratio": "smallest SINR of a pose",
    "best_axis": "best axis at a position",
    "polish": "local search from a position with its best axis",
    "solve": "the whole call of `solve`, without a proof",
}
_POSES = 64
_REPEATS = 7

FloatArray = NDArray[np.float64]


@heap_kernel
def evaluate_all(family, ps, us, rounds):
    """Return the sum of the smallest log ratio over poses, so that no evaluation can be left out."""
    logs, f = np.empty(family.denominator_isotropic.shape[0]), np.empty(family.numerator_isotropic.shape[0])
    total = 0.0
    for _ in range(rounds):
        for m in range(ps.shape[0]):
            total += min_log_ratio(family, ps[m], us[m], logs, f)
    return total


@heap_kernel
def turn_all(family, ps, us):
    """Fill the best axis of every position."""
    for m in range(ps.shape[0]):
        best_axis(family, ps[m], us[m])


@heap_kernel
def polish_all(family, domain, axis_field, ps, us, mu_start, max_steps):
    """Polish every pose, on copies."""
    multipliers = np.empty(family.numerator_isotropic.shape[0])
    for m in range(ps.shape[0]):
        polish(family, domain, axis_field, ps[m].copy(), us[m].copy(), mu_start, max_steps, multipliers)


class Kernels:
    """One scene per size: 1 jammer, P_M/P = 1; 64 positions at random; the median of seven timings."""

    name = "kernels"
    title = "Kernels"

    def measure(self, *, quick: bool, progress: Progress) -> list[Row]:
        """Return a row per step and number of nodes."""
        repeats = 3 if quick else _REPEATS
        progress.begin(len(NODES) * len(STEPS))
        rows: list[Row] = []
        for nodes in NODES:
            for step, timed in _steps(Scene(nodes=nodes, jammers=1, jamming_ratio=1.0, seed=0)).items():
                rows.append({"step": step, "nodes": nodes, "microseconds": timed(repeats)})
                progress.step(f"{step}, {nodes} nodes")
        return rows

    def metrics(self, rows: Sequence[Row]) -> tuple[Metric, ...]:
        """Return a time per row."""
        return tuple(
            Metric(
                key=f"kernels.{row['step']}.n{row['nodes']}_us",
                value=row["microseconds"],
                unit="us",
                direction=Direction.LOWER,
                tolerance=TIMING,
                about=f"{STEPS[row['step']]}, {row['nodes']} nodes",
            )
            for row in rows
        )

    def section(self, rows: Sequence[Row], images: Path) -> Section:
        """Return the table of times."""
        times = {(row["step"], row["nodes"]): row["microseconds"] for row in rows}
        cells = [
            (f"`{step}`", what, *(_microseconds(times[step, nodes]) for nodes in NODES))
            for step, what in STEPS.items()
        ]
        header = ("step", "what it does", *(f"N = {nodes}" for nodes in NODES))
        text = "Microseconds a call, called from compiled code except for `solve`.\n\n" + table(
            header, cells, text_columns=2
        )
        return Section(
            text=text,
            settings=(
                (self.title, "one jammer, P_M/P = 1; 64 random positions; the median of seven timings"),
            ),
        )


def _microseconds(value: float) -> str:
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.3g}"


def _steps(scene: Scene) -> dict[str, Callable[[int], float]]:
    """Return, for each step, what times it: from the number of repeats to microseconds a call."""
    scenario = scene.scenario(boxed=False)
    family = build_family(scenario)
    draws = np.random.default_rng(0)
    low, high = (0.0, 0.0, ALTITUDE_M[0]), (SIDE_M, SIDE_M, ALTITUDE_M[1])
    ps = draws.uniform(low, high, size=(_POSES, 3))
    us = draws.normal(size=(_POSES, 3))
    us /= np.linalg.norm(us, axis=1, keepdims=True)
    best = np.empty_like(us)
    turn_all(family.arrays, ps, best)
    field = AxisField.free().arrays
    rounds = 200
    return {
        "min_log_ratio": _timer(lambda: evaluate_all(family.arrays, ps, us, rounds), rounds * _POSES),
        "best_axis": _timer(lambda: turn_all(family.arrays, ps, us.copy()), _POSES),
        "polish": _timer(lambda: polish_all(family.arrays, family.domain, field, ps, best, 0.1, 200), _POSES),
        "solve": _timer(lambda: solve(scenario, certify=False), 1),
    }


def _timer(call: Callable[[], object], calls: int) -> Callable[[int], float]:
    def microseconds(repeats: int) -> float:
        call()  # compiles or loads
        times = []
        for _ in range(repeats):
            began = time.perf_counter()
            call()
            times.append(time.perf_counter() - began)
        return 1e6 * median(times) / calls

    return microseconds
