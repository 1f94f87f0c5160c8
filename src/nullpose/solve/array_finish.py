"""The last digits of an array's state: sequential quadratic programming on the epigraph."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from nullpose.solve.array_task import ArrayTask

__all__ = ["finished"]

FloatArray = NDArray[np.float64]

_STEPS = 300
_PRECISION = 1e-13


class _Epigraph:
    """``maximise t`` subject to ``f_k(x) >= t`` and the walls, as SLSQP takes it; variables (x, t)."""

    def __init__(self, task: ArrayTask) -> None:
        self.task = task
        self.at: bytes = b""
        self.values, self.slopes = np.empty(0), np.empty((0, 0))

    def look(self, z: FloatArray) -> None:
        """Evaluate all constraints and their slopes, unless that was done last."""
        from nullpose.solve.kernels.array_response import respond

        key = z.tobytes()
        if key == self.at:
            return
        task, nodes, n = self.task, self.task.scene[2], self.task.size
        logs, slopes = np.empty(nodes), np.empty((nodes, n))
        respond(task.scene, task.base, task.shared, np.ascontiguousarray(z[:n]), logs, slopes)
        distance, ways = task.walls(np.ascontiguousarray(z[:3]))
        scale = 1.0 / task.family.keep_out_m if task.family.keep_out_m > 0.0 else 1.0
        self.values = np.concatenate([np.maximum(logs, -1e3) - z[n], scale * distance])
        self.slopes = np.zeros((len(self.values), n + 1))
        self.slopes[:nodes, :n], self.slopes[:nodes, n] = slopes, -1.0
        self.slopes[nodes:, :3] = scale * ways
        self.at = key

    def constraints(self, z: FloatArray) -> FloatArray:
        """Return what must not be negative."""
        self.look(z)
        return self.values

    def constraint_slopes(self, z: FloatArray) -> FloatArray:
        """Return its slopes."""
        self.look(z)
        return self.slopes


def finished(task: ArrayTask, state: FloatArray) -> tuple[float, FloatArray]:
    """Return the local optimum next to a state, inside the domain, and its smallest log ratio.

    Minus infinity if the position cannot be brought into the domain.

    Args:
        task: what is maximised.
        state: where to start.
    """
    from scipy.optimize import minimize

    epigraph = _Epigraph(task)
    n = task.size
    start = state.copy()
    start[:3] = np.clip(start[:3], task.family.low_m, task.family.high_m)
    uphill = np.zeros(n + 1)
    uphill[n] = -1.0
    free = [(None, None)] * (n - 2)
    limits = [
        tuple(float(x) if math.isfinite(x) else None for x in pair)
        for pair in zip(task.family.low_m, task.family.high_m, strict=True)
    ]
    best, best_state = _inside(task, start)
    level = max(task.value(start), -1e3)
    result = minimize(
        lambda z: -float(z[n]),
        np.append(start, level),
        jac=lambda z: uphill,
        method="SLSQP",
        bounds=limits + free,
        constraints=[
            {"type": "ineq", "fun": epigraph.constraints, "jac": epigraph.constraint_slopes},
        ],
        options={"maxiter": _STEPS, "ftol": _PRECISION},
    )
    if np.all(np.isfinite(result.x)):
        value, reached = _inside(task, np.ascontiguousarray(result.x[:n]))
        if value > best:
            best, best_state = value, reached
    return best, best_state


def _inside(task: ArrayTask, state: FloatArray) -> tuple[float, FloatArray]:
    """Return the state with its position in the domain, and its value there."""
    position_m = task.repaired(state[:3])
    if position_m is None:
        return -math.inf, state
    state = state.copy()
    state[:3] = position_m
    return task.value(state), state
