"""SciPy's differential evolution."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.optimize import differential_evolution

from benchmarks.peers.epigraph import climb
from benchmarks.peers.five_pose import DIMENSIONS, FivePose
from benchmarks.peers.peer import Answer, Budget

__all__ = ["DifferentialEvolution"]

_PER_DIMENSION = 60


class DifferentialEvolution:
    """A whole generation per call of the kernel; a population large enough to keep several optima alive."""

    name = "differential-evolution"
    label = "SciPy differential_evolution"
    general_purpose = True
    settings = (
        "300 members, Sobol initial population, `best1bin`, mutation 0.5 to 1, recombination 0.9, a whole "
        "generation per call of the kernel; stopped by the budget or when the population has met "
        "(`atol=1e-9`); SciPy's own polish, which kinks stop, is off"
    )

    def answers(self, problem: FivePose, budget: Budget, seed: int) -> Iterator[Answer]:
        """Yield the search's answer, then that answer polished."""
        generation = _PER_DIMENSION * DIMENSIONS
        found = differential_evolution(
            lambda columns: problem.costs(np.ascontiguousarray(columns.T)),
            [(0.0, 1.0)] * DIMENSIONS,
            popsize=_PER_DIMENSION,
            init="sobol",
            recombination=0.9,
            maxiter=max(1, budget.evaluations // generation - 1),
            tol=0.0,
            atol=1e-9,
            polish=False,
            updating="deferred",
            vectorized=True,
            rng=seed,
        )
        yield Answer(stage="search", x=found.x)
        yield Answer(stage="polished", x=climb(problem, found.x))
