"""CMA-ES, from the package cma."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.peers.epigraph import climb
from benchmarks.peers.five_pose import DIMENSIONS, FivePose
from benchmarks.peers.peer import Answer, Budget

__all__ = ["CmaEs"]


class CmaEs:
    """Covariance matrix adaptation with BIPOP restarts until the budget is spent."""

    name = "cma-es"
    label = "CMA-ES (BIPOP)"
    general_purpose = True
    settings = (
        "package `cma`: BIPOP restarts until the budget is spent, first step size 0.3 of the box, "
        "`tolfun=1e-11`, `tolx=1e-10`, a whole population per call of the kernel"
    )

    def answers(self, problem: FivePose, budget: Budget, seed: int) -> Iterator[Answer]:
        """Yield the search's answer, then that answer polished."""
        import cma

        options = {
            "bounds": [0.0, 1.0],
            "maxfevals": budget.evaluations,
            "tolfun": 1e-11,
            "tolx": 1e-10,
            "seed": seed + 1,  # 0 would mean the time of day
            "verbose": -9,
        }
        found, _ = cma.fmin2(
            None,
            np.full(DIMENSIONS, 0.5),
            0.3,
            options,
            restarts=50,
            bipop=True,
            parallel_objective=lambda population: list(problem.costs(np.asarray(population))),
        )
        yield Answer(stage="search", x=np.asarray(found))
        yield Answer(stage="polished", x=climb(problem, found))
