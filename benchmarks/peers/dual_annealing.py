"""SciPy's dual annealing: the successor of the paper's simulated annealing."""

from __future__ import annotations

from collections.abc import Iterator

from scipy.optimize import dual_annealing

from benchmarks.peers.epigraph import climb
from benchmarks.peers.five_pose import DIMENSIONS, FivePose
from benchmarks.peers.peer import Answer, Budget

__all__ = ["DualAnnealing"]


class DualAnnealing:
    """Generalised simulated annealing with SciPy's own local search."""

    name = "dual-annealing"
    label = "SciPy dual_annealing"
    general_purpose = True
    settings = (
        "stopped by evaluations alone (`maxfun`); the L-BFGS-B local search and every other setting as SciPy "
        "has it"
    )

    def answers(self, problem: FivePose, budget: Budget, seed: int) -> Iterator[Answer]:
        """Yield the search's answer, then that answer polished."""
        found = dual_annealing(
            problem.cost,
            [(0.0, 1.0)] * DIMENSIONS,
            maxfun=budget.evaluations,
            maxiter=budget.evaluations,
            rng=seed,
        )
        yield Answer(stage="search", x=found.x)
        yield Answer(stage="polished", x=climb(problem, found.x))
