"""Other solvers of the five-dimensional problem, each with sensible settings; a crippled peer proves nothing.

A peer is a generator of (stage, (5,) scaled numbers): its answer at each point at which it could have been
stopped. All but the multistart see values only, and their last stage is a local search on the epigraph form.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray
from scipy import optimize
from scipy.stats import qmc

from benchmarks.five_pose import DIMENSIONS, FivePose

FloatArray = NDArray[np.float64]
Answers = Iterator[tuple[str, FloatArray]]

_UNIT_BOX = [(0.0, 1.0)] * DIMENSIONS
_FREE_ANGLES = [(0.0, 1.0)] * 3 + [(None, None)] * 3  # position; roll, pitch and the level are free


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """Cost that a peer may spend on one scene: evaluations, or starts of a multistart."""

    evaluations: int
    starts: int


def climb(problem: FivePose, start: FloatArray) -> FloatArray:
    """Run SLSQP on the epigraph form from a start; the start itself where nothing better is found."""
    level_up = np.append(np.zeros(DIMENSIONS), -1.0)

    def slack(y: FloatArray) -> FloatArray:
        return problem.ratios_and_slopes(y[:DIMENSIONS])[0] - y[DIMENSIONS]

    def slack_slopes(y: FloatArray) -> FloatArray:
        slopes = problem.ratios_and_slopes(y[:DIMENSIONS])[1]
        return np.hstack([slopes, np.full((len(slopes), 1), -1.0)])

    result = optimize.minimize(
        lambda y: -y[DIMENSIONS],
        np.append(start, -problem.cost(start)),
        jac=lambda _: level_up,
        method="SLSQP",
        bounds=_FREE_ANGLES,
        constraints={"type": "ineq", "fun": slack, "jac": slack_slopes},
        options={"ftol": 1e-12, "maxiter": 100},
    )
    end = np.array(result.x[:DIMENSIONS])
    end[:3] = np.clip(end[:3], 0.0, 1.0)
    better = np.all(np.isfinite(end)) and problem.cost(end) < problem.cost(start)
    return end if better else np.asarray(start)


def _polished(problem: FivePose, x: FloatArray) -> Answers:
    yield "search", np.asarray(x)
    yield "polished", climb(problem, np.asarray(x))


def multistart_slsqp(problem: FivePose, budget: Budget, seed: int) -> Answers:
    """Climb from the best of many Sobol points, with slopes of nullpose's kernels: made for this problem."""
    sample = qmc.Sobol(DIMENSIONS, rng=seed).random(128 * budget.starts)
    starts = sample[np.argsort(problem.costs(sample))[: budget.starts]]
    best = starts[0]
    for count, start in enumerate(starts, start=1):
        best = min(best, climb(problem, start), key=problem.cost)
        if count >= 8 and count & (count - 1) == 0:
            yield f"{count} starts", best


def dual_annealing(problem: FivePose, budget: Budget, seed: int) -> Answers:
    """Anneal with SciPy's local search, the successor of the paper's method."""
    limits = {"maxfun": budget.evaluations, "maxiter": budget.evaluations}
    yield from _polished(problem, optimize.dual_annealing(problem.cost, _UNIT_BOX, rng=seed, **limits).x)


def differential_evolution(problem: FivePose, budget: Budget, seed: int) -> Answers:
    """Evolve 300 members, a whole generation a call of the kernel."""
    found = optimize.differential_evolution(
        lambda columns: problem.costs(np.ascontiguousarray(columns.T)),
        _UNIT_BOX,
        popsize=60,
        init="sobol",
        recombination=0.9,
        maxiter=max(1, budget.evaluations // (60 * DIMENSIONS) - 1),
        tol=0.0,
        atol=1e-9,
        polish=False,
        updating="deferred",
        vectorized=True,
        rng=seed,
    )
    yield from _polished(problem, found.x)


def cma_es(problem: FivePose, budget: Budget, seed: int) -> Answers:
    """Adapt a covariance matrix with BIPOP restarts, a whole population a call of the kernel."""
    import cma

    options = {"bounds": [0.0, 1.0], "maxfevals": budget.evaluations, "tolfun": 1e-11, "tolx": 1e-10}
    found, _ = cma.fmin2(
        None,
        np.full(DIMENSIONS, 0.5),
        0.3,
        options | {"seed": seed + 1, "verbose": -9},  # seed 0 is the time of day
        restarts=50,
        bipop=True,
        parallel_objective=lambda population: list(problem.costs(np.asarray(population))),
    )
    yield from _polished(problem, found)


PEERS: dict[str, Callable[[FivePose, Budget, int], Answers]] = {
    "multistart SLSQP": multistart_slsqp,
    "SciPy dual_annealing": dual_annealing,
    "SciPy differential_evolution": differential_evolution,
} | ({"CMA-ES (BIPOP)": cma_es} if find_spec("cma") else {})
