"""Many local searches, the strongest peer known: SLSQP on the epigraph form from screened starts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.stats import qmc

from benchmarks.peers.epigraph import climb
from benchmarks.peers.five_pose import DIMENSIONS, FivePose
from benchmarks.peers.peer import Answer, Budget

__all__ = ["MultistartSlsqp"]

_FIRST_STOP = 8
_SCREENED = 128


class MultistartSlsqp:
    """SciPy's SLSQP from the best of many Sobol points, with slopes from nullpose's kernels.

    Made for this very problem: max-min structure, exact compiled slopes, an axis free of its chart's border.
    """

    name = "multistart-slsqp"
    label = "multistart SLSQP"
    general_purpose = False
    settings = (
        "epigraph form, exact slopes from nullpose's kernels, free angles, `ftol=1e-12`, `maxiter=100`; "
        f"the best of {_SCREENED} times as many scrambled Sobol points as starts; could have been stopped "
        "after 8, 16, 32, ... starts"
    )

    def answers(self, problem: FivePose, budget: Budget, seed: int) -> Iterator[Answer]:
        """Yield the best of the first 8, 16, 32, ... starts."""
        sample = qmc.Sobol(DIMENSIONS, rng=seed).random(_SCREENED * budget.starts)
        starts = sample[np.argsort(problem.costs(sample))[: budget.starts]]
        best, best_cost = starts[0], np.inf
        stop = min(_FIRST_STOP, budget.starts)
        for done, start in enumerate(starts, start=1):
            end = climb(problem, start)
            cost = problem.cost(end)
            if cost < best_cost:
                best, best_cost = end, cost
            if done in (stop, budget.starts):
                yield Answer(stage=f"{done} starts", x=best)
                stop *= 2
