"""The last digits of an array's state: sequential quadratic programming on the epigraph."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.solver.array_task import ArrayTask

_STEPS = 300
_PRECISION = 1e-13
_LEAST = -1e3  # log ratio that counts for a node which is not heard


def finished(task: ArrayTask, state: FloatArray) -> tuple[float, FloatArray]:
    """Find the local optimum next to a state, inside the domain, and its smallest log ratio.

    ``maximise t`` subject to ``f_k(x) >= t`` and the walls, by SLSQP in the variables (x, t). Minus infinity
    if the position cannot be brought into the domain.

    Args:
        task: what is maximised.
        state: where to start.
    """
    from scipy.optimize import minimize

    from nullpose.solver.kernels.array_response import respond

    n, nodes, family = 4, task.problem.nodes, task.family
    scale = 1.0 / family.keep_out_m if family.keep_out_m > 0.0 else 1.0

    @lru_cache(maxsize=1)
    def constraints(variables: bytes) -> tuple[FloatArray, FloatArray]:
        """Evaluate the constraints, none of which may be negative, and their slopes."""
        z = np.frombuffer(variables)
        logs, by_state = np.empty(nodes), np.empty((nodes, n))
        respond(task.problem, z[:n].copy(), logs, by_state)
        distance, slopes_out = task.walls(z[:3].copy())
        slopes = np.zeros((nodes + len(distance), n + 1))
        slopes[:nodes, :n], slopes[:nodes, n] = by_state, -1.0
        slopes[nodes:, :3] = scale * slopes_out
        return np.concatenate([np.maximum(logs, _LEAST) - z[n], scale * distance]), slopes

    start = state.copy()
    start[:3] = np.clip(start[:3], family.low_m, family.high_m)
    uphill = np.append(np.zeros(n), -1.0)
    sides = zip(family.low_m.tolist(), family.high_m.tolist(), strict=True)
    bounds = [tuple(x if math.isfinite(x) else None for x in pair) for pair in sides]
    result = minimize(
        lambda z: -float(z[n]),
        np.append(start, max(task.value(start), _LEAST)),
        jac=lambda z: uphill,
        method="SLSQP",
        bounds=bounds + [(None, None)] * (n - 2),
        constraints={
            "type": "ineq",
            "fun": lambda z: constraints(z.tobytes())[0],
            "jac": lambda z: constraints(z.tobytes())[1],
        },
        options={"maxiter": _STEPS, "ftol": _PRECISION},
    )
    ends = [_inside(task, start)]
    if np.all(np.isfinite(result.x)):
        ends.append(_inside(task, result.x[:n].copy()))
    return max(ends, key=lambda end: end[0])


def _inside(task: ArrayTask, state: FloatArray) -> tuple[float, FloatArray]:
    """Move a state's position into the domain, and evaluate it there."""
    position_m = task.repaired(state[:3].copy())
    if position_m is None:
        return -math.inf, state
    state = np.concatenate([position_m, state[3:]])
    return task.value(state), state
