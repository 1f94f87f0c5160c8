"""The search over positions for objectives that are only known by their values.

For what is not a family of smooth ratios in the position: maximum gain for other than two nodes (its axis
is itself the answer of an optimisation, so the objective has kinks and may jump) and the paper's eq. 3.5 as
printed.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from nullpose.errors import SolveError, require
from nullpose.objectives import FloatArray
from nullpose.problem.family import Family
from nullpose.solver.local_search import LocalSearch
from nullpose.solver.multistart import NOT_RECEIVED

_DRAWN, _CLIMBED = 1000, 3  # positions of the search, each time
_RESTARTS = 6
_SIZE = 0.05  # of the first simplex, as a share of the box


class PositionSearch(LocalSearch):
    """A search whose climb is Nelder-Mead, restarted from its own end until that no longer moves.

    Args:
        objective: log value of a position, (3,), metres; minus infinity where it has none.
        family: for its domain and for the distances within which a better position must lie.
        seed: of the positions drawn.
    """

    def __init__(self, objective: Callable[[FloatArray], float], family: Family, seed: int) -> None:
        super().__init__(family, 1.0, seed)
        self.objective = objective

    def search(self) -> None:
        """Find the best position.

        Raises:
            SolveError: the objective is minus infinity at every position tried.
        """
        require(SolveError, self.run(_DRAWN, _CLIMBED) > -math.inf, NOT_RECEIVED)

    def orient(self, positions_m: FloatArray) -> FloatArray:
        """Return the positions, which are the states."""
        return positions_m

    def judge(self, states: FloatArray) -> FloatArray:
        """Evaluate the objective at positions."""
        from nullpose.solver.kernels.search.domain import contains

        self.evaluations += len(states)
        pairs = zip(states, (contains(self.family.domain, state) for state in states), strict=True)
        return np.array([self.objective(state) if inside else -math.inf for state, inside in pairs])

    def climb(self, state: FloatArray) -> float:
        """Climb to a local optimum, and keep it if it is the best so far; return its value."""
        from scipy.optimize import minimize

        low_m, high_m = self.family.domain.low_m, self.family.domain.high_m
        value, size_m = self.take(state), _SIZE * float(np.max(np.diff(self.box(self.best), axis=0)))
        self.starts += 1
        for _ in range(_RESTARTS):
            found = minimize(
                lambda position_m: -self.judge(position_m[None])[0],
                state,
                method="Nelder-Mead",
                bounds=list(zip(low_m, high_m, strict=True)),
                options={
                    "initial_simplex": np.clip(
                        state + np.vstack([np.zeros(3), size_m * np.eye(3)]), low_m, high_m
                    ),
                    "xatol": 1e-9,
                    "fatol": 1e-13,
                    "maxfev": 800,
                },
            )
            state, before = np.clip(found.x, low_m, high_m), value
            value, size_m = max(value, self.take(state)), 0.3 * size_m
            if not value > before + 1e-11:
                break
        return value
