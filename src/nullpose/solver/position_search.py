"""Multistart over positions for objectives that are only known by their values.

For what is not a family of smooth ratios in the position: maximum gain for other than two nodes (its axis
is itself the answer of an optimisation, so the objective has kinks and may jump) and the paper's eq. 3.5 as
printed. Nelder-Mead, restarted from its own answer until that no longer moves.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from nullpose.errors import SolveError
from nullpose.objectives import FloatArray
from nullpose.problem.airspace import loosened
from nullpose.problem.family import Family
from nullpose.solver.multistart import BORDER_M, NO_POSITION, NOT_RECEIVED, landmarks

_COARSE = 256
_POLISHED = 8
_RESTARTS = 6


def search_positions(
    objective: Callable[[FloatArray], float], family: Family, *, seed: int
) -> tuple[FloatArray, float, int, int]:
    """Return the best position found, its value, and the numbers of starts and evaluations.

    Args:
        objective: log value of a position, (3,), metres; minus infinity where it has none.
        family: for its domain and for the distances within which a better position must lie.
        seed: seed of the coarse positions.

    Raises:
        SolveError: the objective is minus infinity at every position tried.
    """
    from nullpose.solver.kernels.domain import contains
    from nullpose.solver.kernels.search import cut_box, push_out

    starts = [place for place in landmarks(family) if push_out(place, family.domain)]
    if not starts:  # what is allowed may be of no width
        family = loosened(family, BORDER_M)
        starts = [place for place in landmarks(family) if push_out(place, family.domain)]
    if not starts:
        raise SolveError(NO_POSITION)
    domain, low, high = family.domain, family.low_m, family.high_m
    evaluations = 0

    def cost(position: FloatArray) -> float:
        nonlocal evaluations
        evaluations += 1
        return -objective(position) if contains(domain, position) else math.inf

    best_value, best_position = max(((-cost(place), place) for place in starts), key=lambda pair: pair[0])
    if not math.isfinite(best_value):
        raise SolveError(NOT_RECEIVED)
    box_low, box_high = np.empty(3), np.empty(3)
    cut_box(family.arrays, low, high, best_value, box_low, box_high)
    draws = np.random.default_rng(seed).uniform(size=(_COARSE, 3))
    draws[::2, 2] = 0.0  # the optimum is often on the floor
    for draw in draws:
        place = box_low + draw * (box_high - box_low)
        if push_out(place, domain):
            starts.append(place)
    ranked = sorted(starts, key=cost)[:_POLISHED]
    span = float(np.max(box_high - box_low))
    for place in ranked:
        value, position = _descend(cost, place, 0.05 * span, low, high)
        if value > best_value:
            best_value, best_position = value, position
    return best_position, best_value, len(ranked), evaluations


def _descend(
    cost: Callable[[FloatArray], float], start: FloatArray, size: float, low: FloatArray, high: FloatArray
) -> tuple[float, FloatArray]:
    """Return the value and the position at the end of restarted Nelder-Mead runs."""
    from scipy.optimize import minimize

    position, value = start, cost(start)
    for _ in range(_RESTARTS):
        corners = position + np.vstack([np.zeros(3), size * np.eye(3)])
        result = minimize(
            cost,
            position,
            method="Nelder-Mead",
            bounds=list(zip(low, high, strict=True)),
            options={
                "initial_simplex": np.clip(corners, low, high),
                "xatol": 1e-9,
                "fatol": 1e-13,
                "maxfev": 800,
            },
        )
        gain = value - result.fun
        if result.fun <= value:
            position, value = np.clip(result.x, low, high), float(result.fun)
        if not gain > 1e-11:
            break
        size *= 0.3
    return -value, position
