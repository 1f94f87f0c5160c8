"""Prices of the steps that are best for positions already met: a linear program."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import bmat, coo_array, eye_array, kron

from nullpose.objectives import FloatArray, IntArray

_GRID = np.stack(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 3), axis=-1).reshape(-1, 3)
_CORNERS = _GRID[np.any(_GRID, axis=1)]
_DIRECTIONS = _CORNERS / np.linalg.norm(_CORNERS, axis=1, keepdims=True)


def best_prices(
    reach_m: FloatArray,
    owners: IntArray,
    places_m: FloatArray,
    gains: FloatArray,
    prices: FloatArray,
    radius: float,
) -> tuple[float, FloatArray, FloatArray]:
    """Minimise ``sum_s reach_s |c_s| + sum_t max_i (gain_i + (c_t - c_{t-1}) . p_i)`` near some prices.

    The length of a price is the largest of its parts along some directions, so the minimum may be too small.

    Args:
        reach_m: (s,) of each step.
        owners: (n,) the instant of each position.
        places_m: (n, 3) the positions.
        gains: (n,) what each gives there.
        prices: (s, 3) those to stay near.
        radius: how near, in each part.

    Returns:
        The minimum, its prices, (s, 3), and the share of each position in what they balance, (n,).
    """
    steps, count = len(reach_m), len(owners)
    after, before = owners < steps, owners > 0  # the steps on either side of an instant
    rows = np.concatenate([np.flatnonzero(after), np.flatnonzero(before)])
    columns = np.concatenate([owners[after], owners[before] - 1])
    parts = np.concatenate([places_m[after], -places_m[before]])
    at = np.repeat(rows, 3), (3 * columns[:, None] + np.arange(3)).ravel()
    offers = coo_array((parts.ravel(), at), shape=(count, 3 * steps))
    owned = coo_array((-np.ones(count), (np.arange(count), owners)), shape=(count, steps + 1))
    each, lengths = eye_array(steps), np.linalg.norm(prices, axis=1, keepdims=True)
    along = np.divide(prices, lengths, out=np.zeros_like(prices), where=lengths > 0.0)
    present = coo_array(
        (along.ravel(), (np.repeat(np.arange(steps), 3), np.arange(3 * steps))), shape=(steps, 3 * steps)
    )
    table = bmat(
        [
            [offers, None, owned],
            [kron(each, _DIRECTIONS), kron(each, -np.ones((len(_DIRECTIONS), 1))), None],
            [present, -each, None],
        ],
        format="csr",
    )
    right = np.concatenate([-gains, np.zeros(table.shape[0] - count)])
    near = prices.ravel()[:, None] + radius * np.array([-1.0, 1.0])
    free = np.tile([-np.inf, np.inf], (2 * steps + 1, 1))
    cost = np.concatenate([np.zeros(3 * steps), reach_m, np.ones(steps + 1)])
    found = linprog(cost, A_ub=table, b_ub=right, bounds=np.vstack([near, free]), method="highs")
    if found.x is None:  # rounding: the prices at hand stay
        return -np.inf, prices, np.zeros(count)
    return float(found.fun), found.x[: 3 * steps].reshape(-1, 3), -found.ineqlin.marginals[:count]
