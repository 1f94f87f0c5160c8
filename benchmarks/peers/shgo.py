"""SciPy's SHGO: simplicial homology global optimisation."""

from __future__ import annotations

import warnings
from collections.abc import Iterator

from scipy.optimize import shgo

from benchmarks.peers.epigraph import climb
from benchmarks.peers.five_pose import DIMENSIONS, FivePose
from benchmarks.peers.peer import Answer, Budget

__all__ = ["Shgo"]

_POLISHED = 16


class Shgo:
    """One round of Sobol points, a local search from each of its vertices that look like a minimum."""

    name = "shgo"
    label = "SciPy shgo"
    general_purpose = True
    settings = (
        "one round of Sobol points, SLSQP local searches of at most 100 iterations; "
        "up to 16 of the optima it lists are polished; a budget of its own, since most of its time goes "
        "into the triangulation; not random"
    )

    def answers(self, problem: FivePose, budget: Budget, seed: int) -> Iterator[Answer]:
        """Yield the search's answer, then the best of its optima polished."""
        with warnings.catch_warnings():
            # its local searches are stopped by kinks and say so
            warnings.simplefilter("ignore", RuntimeWarning)
            found = shgo(
                problem.cost,
                [(0.0, 1.0)] * DIMENSIONS,
                n=budget.samples,
                iters=1,
                sampling_method="sobol",
                minimizer_kwargs={"method": "SLSQP", "options": {"maxiter": 100}},
            )
        yield Answer(stage="search", x=found.x)
        optima = [climb(problem, x) for x in (found.x, *found.get("xl", ())[1:_POLISHED])]
        yield Answer(stage="polished", x=min(optima, key=problem.cost))
