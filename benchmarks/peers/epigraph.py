"""A local search that kinks do not stop: SLSQP on ``maximise t subject to log SINR_i(x) >= t``.

Every peer may end with it. Without it, those that only see the smallest SINR's value stop at a few digits on
its kinks, and the comparison would be about digits rather than about which optimum was found.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from benchmarks.peers.five_pose import DIMENSIONS, FivePose

__all__ = ["climb"]

FloatArray = NDArray[np.float64]

_LEVEL = DIMENSIONS
_BOUNDS = [(0.0, 1.0)] * 3 + [(None, None)] * 3  # x, y, z; then roll, pitch and the level, which are free


class _Ratios:
    """The log SINRs and their slopes at the last point asked for: SLSQP asks for them apart."""

    def __init__(self, problem: FivePose) -> None:
        self._problem = problem
        self._at: bytes = b""
        self._found: tuple[FloatArray, FloatArray]

    def at(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log SINRs, (N,), and their slopes, (N, 5)."""
        x = np.ascontiguousarray(y[:DIMENSIONS])
        if x.tobytes() != self._at:
            self._at, self._found = x.tobytes(), self._problem.ratios_and_slopes(x)
        return self._found


def climb(problem: FivePose, start: FloatArray) -> FloatArray:
    """Return the better of a start, (5,), and the local optimum that SLSQP reaches from it.

    Roll and pitch may leave [-90, 90] degrees on the way, since an axis and its opposite are the same dipole:
    held inside, half of the starts would stop on a border that means nothing.

    Args:
        problem: the scene.
        start: scaled numbers.
    """
    start = np.asarray(start, dtype=float)
    ratios = _Ratios(problem)
    level_up = np.zeros(DIMENSIONS + 1)
    level_up[_LEVEL] = -1.0

    def slack_slopes(y: FloatArray) -> FloatArray:
        slopes = ratios.at(y)[1]
        return np.hstack([slopes, np.full((len(slopes), 1), -1.0)])

    result = minimize(
        lambda y: -y[_LEVEL],
        np.append(start, np.min(ratios.at(start)[0])),
        jac=lambda _: level_up,
        method="SLSQP",
        bounds=_BOUNDS,
        constraints={"type": "ineq", "fun": lambda y: ratios.at(y)[0] - y[_LEVEL], "jac": slack_slopes},
        options={"ftol": 1e-12, "maxiter": 100},
    )
    end = np.array(result.x[:DIMENSIONS])
    end[:3] = np.clip(end[:3], 0.0, 1.0)
    if not np.all(np.isfinite(end)):
        return start
    return end if problem.cost(end) < problem.cost(start) else start
