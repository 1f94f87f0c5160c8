"""SciPy's DIRECT: dividing rectangles."""

from __future__ import annotations

from collections.abc import Iterator

from scipy.optimize import direct

from benchmarks.peers.epigraph import climb
from benchmarks.peers.five_pose import DIMENSIONS, FivePose
from benchmarks.peers.peer import Answer, Budget

__all__ = ["Direct"]


class Direct:
    """The original, globally biased variant, which finds more optima here than the locally biased one.

    Args:
        share: it may spend one part in so many of the budget; few evaluations and the polish go a long way.
    """

    general_purpose = True

    def __init__(self, share: int = 1) -> None:
        self.name = "direct" if share == 1 else f"direct-{share}"
        self.label = "SciPy direct" if share == 1 else f"SciPy direct, 1/{share} of the budget"
        self.settings = (
            "`locally_biased=False`, stopped by evaluations alone (`vol_tol=len_tol=0`); not random"
        )
        self._share = share

    def answers(self, problem: FivePose, budget: Budget, seed: int) -> Iterator[Answer]:
        """Yield the search's answer, then that answer polished."""
        found = direct(
            problem.cost,
            [(0.0, 1.0)] * DIMENSIONS,
            maxfun=budget.evaluations // self._share,
            maxiter=budget.evaluations // self._share,
            locally_biased=False,
            vol_tol=0.0,
            len_tol=0.0,
        )
        yield Answer(stage="search", x=found.x)
        yield Answer(stage="polished", x=climb(problem, found.x))
