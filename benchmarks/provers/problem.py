"""Provers: the problem that they get, what they claim, and units in which every number is about one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Triple = tuple[float, float, float]

_ROOM = 1e-6  # relative: the incumbent must stay inside what is cut out with its own value


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """A scene with one jammer, how closely to solve it in which time, and the best pose known.

    Horizontally the drone may be anywhere. The start's axis points up, of unit length.
    """

    nodes_m: tuple[Triple, ...]
    powers_w: tuple[float, ...]
    jammer_m: Triple
    jamming_w: float
    noise_w: float
    altitude_m: tuple[float, float]
    gap: float
    cap_s: float
    start_value: float
    start_position_m: Triple
    start_axis: Triple


FINISHED = "finished"
NOT_CLOSED = "not closed"


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """The pose, value and bound that a prover claims, none of them checked; NaN or empty if it has none.

    The status is ``FINISHED`` if it says that the gap is reached, ``NOT_CLOSED`` if its time ran out, or else
    what went wrong; imports are left out of the time.
    """

    status: str
    value: float = float("nan")
    bound: float = float("nan")
    position_m: tuple[float, ...] = ()
    axis: tuple[float, ...] = ()
    nodes: int = 0
    seconds: float = 0.0


class Prover(Protocol):
    """A global solver with a formulation: its name, its label in tables, its package."""

    name: str
    label: str
    package: str

    def load(self) -> None:
        """Import what it needs, outside the clock."""

    def prove(self, problem: Problem) -> Claim:
        """Solve the problem; the caller fills the time in."""


@dataclass(frozen=True, kw_only=True)
class Scaled:
    """A problem in units of half the widest distance between nodes, and of the first node's power.

    A solver's tolerances are absolute. In metres and watts the quantities that matter are 1e-3 and less, so
    that a tolerance of 1e-6 is a part in a thousand of them, and the values that come out are false.

    Everything here that cuts away poses keeps every pose that is at least as good as the start.
    """

    problem: Problem

    @cached_property
    def unit_m(self) -> float:
        """The unit of length, metres."""
        pairs = combinations(np.array(self.problem.nodes_m), 2)
        return max(float(np.linalg.norm(a - b)) for a, b in pairs) / 2.0

    @cached_property
    def nodes(self) -> FloatArray:
        """Positions of the nodes, (N, 3)."""
        return np.array(self.problem.nodes_m) / self.unit_m

    @cached_property
    def powers(self) -> FloatArray:
        """Powers of the nodes, (N,), the first being 1."""
        return np.array(self.problem.powers_w) / self.problem.powers_w[0]

    @cached_property
    def jammer(self) -> FloatArray:
        """Position of the jammer, (3,)."""
        return np.array(self.problem.jammer_m) / self.unit_m

    @property
    def jamming(self) -> float:
        """Jamming power over the first node's."""
        return self.problem.jamming_w / self.problem.powers_w[0]

    @property
    def noise(self) -> float:
        """Noise over the first node's power at the unit distance."""
        return self.problem.noise_w * self.unit_m**2 / self.problem.powers_w[0]

    @property
    def level_low(self) -> float:
        """A smallest SINR just below the start's."""
        return self.problem.start_value * (1.0 - _ROOM)

    @cached_property
    def reaches(self) -> FloatArray:
        """Largest squared distance from each node, (N,): beyond it noise alone spoils the start's value."""
        return self.powers / (self.noise * self.level_low)

    @cached_property
    def box(self) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest position, each (3,): what the altitude and the reaches leave.

        Beside each node's ball there is one around their centroid, since the mean squared distance from
        points is the squared distance from their centroid plus their spread.
        """
        radii = np.sqrt(self.reaches)[:, None]
        low, high = np.max(self.nodes - radii, axis=0), np.min(self.nodes + radii, axis=0)
        floor, ceiling = np.array(self.problem.altitude_m) / self.unit_m
        low[2], high[2] = max(low[2], floor), min(high[2], ceiling)
        centre = np.mean(self.nodes, axis=0)
        around = float(np.mean(self.reaches)) - self._spread
        above = max(0.0, low[2] - centre[2], centre[2] - high[2])
        level = np.array([1.0, 1.0, 0.0]) * np.sqrt(around - above**2) + [0.0, 0.0, np.sqrt(around)]
        return np.maximum(low, centre - level), np.minimum(high, centre + level)

    @cached_property
    def _spread(self) -> float:
        return float(np.mean(np.sum((self.nodes - np.mean(self.nodes, axis=0)) ** 2, axis=1)))

    @cached_property
    def budget(self) -> float:
        """Noise plus interference at most, at a pose as good as the start.

        ``level * budget <= powers / distances^2`` for every node; its mean over the nodes, each side times
        the squared distance, bounds the budget by the least mean squared distance.
        """
        low, high = self.box
        nearest = np.clip(np.mean(self.nodes, axis=0), low, high)
        least = float(np.sum((nearest - np.mean(self.nodes, axis=0)) ** 2)) + self._spread
        return float(np.mean(self.powers)) / (self.level_low * least) * (1.0 + _ROOM)

    @property
    def level_high(self) -> float:
        """A smallest SINR that no pose exceeds: without interference, nearest to all nodes at once."""
        return self.level_low * self.budget / self.noise

    def squared_distances(self, point: FloatArray) -> tuple[float, float]:
        """Return the smallest and the largest squared distance of the box from a point."""
        low, high = self.box
        nearest = np.clip(point, low, high)
        farthest = np.where(point - low > high - point, low, high)
        return float(np.sum((nearest - point) ** 2)), float(np.sum((farthest - point) ** 2))

    @cached_property
    def start(self) -> tuple[FloatArray, FloatArray]:
        """Position and unit axis of the start, each (3,)."""
        return np.array(self.problem.start_position_m) / self.unit_m, np.array(self.problem.start_axis)
