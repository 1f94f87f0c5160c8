"""The five-dimensional problem as the peers see it: x, y, z, roll, pitch, each scaled to [0, 1].

The objective is nullpose's own compiled kernel, `log_objective`, inside one kernel that takes the five
numbers, so that no peer pays for Python in it. The angles run over [-90, 90] degrees, as in the paper.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.channel.model import WIDTH
from nullpose.objectives import Ratios
from nullpose.physics import Pose
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.scenario import Scenario
from nullpose.solver.kernels.compiler.jit import heap_kernel
from nullpose.solver.kernels.linear_algebra.links import derivatives, log_objective

DIMENSIONS = 5

FloatArray = NDArray[np.float64]


@heap_kernel
def unpack(reals, counts):
    """Split the family's arrays and scratch out of two: each array costs a call a fixed time."""
    points, ratios, groups, entries = counts[1], counts[2], counts[3], counts[4]
    a = 3 * points
    b = a + ratios
    c = b + ratios
    d = c + groups
    e = d + entries
    i = 5 + ratios
    j = i + ratios
    k = j + groups + 1
    family = Ratios(
        reals[:a].reshape(points, 3),
        reals[a:b],
        reals[b:c],
        counts[5:i],
        counts[i:j],
        reals[c:d],
        counts[j:k],
        counts[k : k + entries],
        reals[d:e],
        np.zeros((0, 3, 3)),
        0.0,
        np.zeros((0, 3)),
        np.zeros(0),
        np.zeros((0, WIDTH)),
        np.zeros(1, np.int64),
        np.zeros(1, np.int64),
        np.zeros((0, 5)),
        np.zeros(0),
        0.0,
        np.zeros(0),
        np.zeros((0, 2), np.int64),
    )
    bounds = reals[e : e + 6]
    return family, bounds, reals[e + 6 : e + 6 + groups], reals[e + 6 + groups : e + 6 + groups + ratios]


@heap_kernel
def place(x, bounds, p, u):
    """Fill position and axis (paper eq. 1.1, yaw 0) from the five scaled numbers."""
    for i in range(3):
        p[i] = bounds[i] + x[i] * (bounds[3 + i] - bounds[i])
    roll, pitch = math.pi * (x[3] - 0.5), math.pi * (x[4] - 0.5)
    u[0] = math.cos(roll) * math.sin(pitch)
    u[1] = -math.sin(roll)
    u[2] = math.cos(roll) * math.cos(pitch)


@heap_kernel
def cost(x, reals, counts):
    """Return minus the smallest log ratio of a pose, counting the evaluation."""
    family, bounds, logs, f = unpack(reals, counts)
    p, u = np.empty(3), np.empty(3)
    place(x, bounds, p, u)
    counts[0] += 1
    return -log_objective(family, p, u, logs, f)


@heap_kernel
def costs(xs, reals, counts):
    """Return minus the smallest log ratio of many poses, given as rows."""
    family, bounds, logs, f = unpack(reals, counts)
    p, u = np.empty(3), np.empty(3)
    out = np.empty(xs.shape[0])
    for m in range(xs.shape[0]):
        place(xs[m], bounds, p, u)
        out[m] = -log_objective(family, p, u, logs, f)
    counts[0] += xs.shape[0]
    return out


@heap_kernel
def ratios_and_slopes(x, reals, counts):
    """Return every log ratio of a pose, (R,), and its derivatives in the five scaled numbers, (R, 5)."""
    family, bounds, _, f = unpack(reals, counts)
    ratios, groups = f.shape[0], family.denominator_isotropic.shape[0]
    p, u = np.empty(3), np.empty(3)
    place(x, bounds, p, u)
    grads = np.empty((ratios, 6))
    logs = np.empty(ratios)
    derivatives(family, p, u, np.zeros(ratios), logs, grads, np.empty((6, 6)), np.empty((groups, 50)))
    roll, pitch = math.pi * (x[3] - 0.5), math.pi * (x[4] - 0.5)
    slopes = np.empty((ratios, 5))
    for k in range(ratios):
        for i in range(3):
            slopes[k, i] = grads[k, i] * (bounds[3 + i] - bounds[i])
        gx, gy, gz = grads[k, 3], grads[k, 4], grads[k, 5]
        slopes[k, 3] = math.pi * (
            -math.sin(roll) * (gx * math.sin(pitch) + gz * math.cos(pitch)) - gy * math.cos(roll)
        )
        slopes[k, 4] = math.pi * math.cos(roll) * (gx * math.cos(pitch) - gz * math.sin(pitch))
    counts[0] += 1
    return logs, slopes


@dataclass(frozen=True, slots=True, eq=False)
class FivePose:
    """A scene as a function of five numbers in [0, 1]: what is minimised, its parts, and the way back.

    Args:
        scenario: a scene whose airspace is bounded on every side.
    """

    scenario: Scenario
    _reals: FloatArray
    _counts: NDArray[np.int64]

    @classmethod
    def of(cls, scenario: Scenario) -> FivePose:
        """Return the problem of a scene.

        Raises:
            ValueError: the airspace has a side without a bound.
        """
        family = build_family(scenario)
        if not (np.all(np.isfinite(family.domain.low_m)) and np.all(np.isfinite(family.domain.high_m))):
            raise ValueError("the peers need an airspace that is bounded on every side")
        return cls(scenario, *_pack(family))

    @property
    def evaluations(self) -> int:
        """How many poses were evaluated so far, those with derivatives counting once."""
        return int(self._counts[0])

    def cost(self, x: FloatArray) -> float:
        """Return minus the log of the smallest SINR at (5,) scaled numbers."""
        value: float = cost(x, self._reals, self._counts)
        return value

    def costs(self, xs: FloatArray) -> FloatArray:
        """Return minus the log of the smallest SINR at each row of (m, 5) scaled numbers."""
        values: FloatArray = costs(xs, self._reals, self._counts)
        return values

    def ratios_and_slopes(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the log SINR of every node, (N,), and its derivatives, (N, 5)."""
        found: tuple[FloatArray, FloatArray] = ratios_and_slopes(x, self._reals, self._counts)
        return found

    def pose(self, x: FloatArray) -> Pose:
        """Return the pose of five scaled numbers, brought back into the airspace and the range of angles."""
        x = np.asarray(x, dtype=float)
        airspace = self.scenario.airspace
        ranges = np.array([airspace.x_m, airspace.y_m, airspace.altitude_m], dtype=float)
        position_m = ranges[:, 0] + np.clip(x[:3], 0.0, 1.0) * (ranges[:, 1] - ranges[:, 0])
        roll_rad, pitch_rad = math.pi * (x[3] - 0.5), math.pi * (x[4] - 0.5)
        axis = (
            math.cos(roll_rad) * math.sin(pitch_rad),
            -math.sin(roll_rad),
            math.cos(roll_rad) * math.cos(pitch_rad),
        )
        return Pose.from_axis(position_m, axis)


def _pack(family: Family) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return the family as one array of floats and one of integers, in the order that `unpack` reads."""
    ratios = family.ratios
    points, n0 = ratios.points_m, ratios.numerator_isotropic
    nw, npt = ratios.numerator_weight, ratios.numerator_point
    den, d0 = ratios.denominator_of, ratios.denominator_isotropic
    start, dpt = ratios.denominator_start, ratios.denominator_point
    dw = ratios.denominator_weight
    scratch = np.zeros(len(d0) + len(nw))
    reals = np.concatenate(
        [points.ravel(), n0, nw, d0, dw, family.domain.low_m, family.domain.high_m, scratch]
    )
    sizes = [0, len(points), len(nw), len(d0), len(dw)]
    return reals, np.concatenate([np.array(sizes, dtype=np.int64), npt, den, start, dpt])
