"""Search over the states of an array: climbs from many starts, then hops from the best of them.

The landscape has many local optima, more the longer the array is, and those with the best values lie close to
other good ones; so most of the work goes into perturbing what is good already.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.solve.array_task import ArrayTask

__all__ = ["ArrayFound", "ArraySettings", "Pool", "search_array"]

FloatArray = NDArray[np.float64]

_BETAS = np.array([4.0, 16.0, 64.0])
_HOP_BETAS = _BETAS[1:]
_STEPS = 60
_SAME = 1e-4
_BETTER = 1e-6
_BATCH = 50  # starts between two looks at how far an optimum can be
_LEVEL_SHARE = np.array([1.0, 1.0, 0.3])  # hops are shorter upwards: the optimum is often on the floor


@dataclass(frozen=True, slots=True, kw_only=True)
class ArraySettings:
    """How hard one search tries.

    Args:
        first: climbs from fresh starts.
        coarse: states judged for each of them.
        elites: different optima that are kept.
        patience: hops without improvement after which it stops.
        most: most hops.
    """

    first: int = 300
    coarse: int = 8
    elites: int = 8
    patience: int = 500
    most: int = 4000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArrayFound:
    """What one search comes to.

    Args:
        states: the best states, each with another value, the best first.
        climbs: local searches made.
        evaluations: states evaluated.
    """

    states: tuple[FloatArray, ...]
    climbs: int
    evaluations: int


class Pool:
    """The best states so far, each with another value.

    Args:
        size: how many are kept.
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.entries: list[tuple[float, FloatArray]] = []

    @property
    def best(self) -> float:
        """The best log value, or minus infinity."""
        return max((value for value, _ in self.entries), default=-math.inf)

    def offer(self, value: float, state: FloatArray) -> None:
        """Keep a state if it is among the best, and better than one with the same value."""
        if not value > -math.inf:
            return
        for place, (known, _) in enumerate(self.entries):
            if abs(value - known) < _SAME:
                if value > known:
                    self.entries[place] = (value, state)
                break
        else:
            self.entries.append((value, state))
        self.entries.sort(key=lambda entry: -entry[0])
        del self.entries[self.size :]


class _Search:
    def __init__(self, task: ArrayTask, rng: np.random.Generator, settings: ArraySettings) -> None:
        self.task, self.rng, self.settings = task, rng, settings
        self.pool = Pool(settings.elites)
        self.climbs = self.evaluations = 0

    def climbed(self, state: FloatArray, betas: FloatArray = _BETAS) -> float:
        from nullpose.solve.kernels.array_climb import climb

        task = self.task
        value, evaluations = climb(
            task.scene, task.base, task.family.domain, task.shared, state, betas, _STEPS
        )
        self.climbs += 1
        self.evaluations += int(evaluations)
        return float(value)

    def placed(self, position_m: FloatArray) -> bool:
        """Move a position into the domain; return whether it got there."""
        from nullpose.solve.kernels.search import push_out

        return bool(push_out(position_m, self.task.family.domain))

    def begin(self, positions_m: FloatArray) -> None:
        """Climb from the best of several yaws and phases, each at one of the positions."""
        from nullpose.solve.kernels.array_climb import judge

        task = self.task
        states = np.empty((len(positions_m), task.size))
        states[:, :3] = positions_m
        states[:, 3:] = self.rng.uniform(-math.pi, math.pi, (len(positions_m), task.size - 3))
        kept = states[[self.placed(state[:3]) for state in states]]
        if len(kept):
            values = np.empty(len(kept))
            judge(task.scene, task.base, task.shared, kept, values)
            self.evaluations += len(kept)
            state = kept[np.argmax(values)].copy()
            self.pool.offer(self.climbed(state), state)

    def spread(self) -> None:
        """Climb from fresh starts all over where an optimum can be, every other one on the floor."""
        settings = self.settings
        for done in range(settings.first):
            if done % _BATCH == 0:
                low_m, high_m = self.task.reach(self.pool.best)
            shares = self.rng.uniform(size=(settings.coarse, 3))
            shares[::2, 2] = 0.0
            self.begin(low_m + shares * (high_m - low_m))

    def hop(self) -> None:
        """Perturb one of the best states, climb again, and keep what is better."""
        place = int(self.rng.integers(len(self.pool.entries)))
        value, state = self.pool.entries[place]
        state = state.copy()
        size = 10.0 ** self.rng.uniform(-1.0, 0.3)
        what = self.rng.integers(4)  # the position, the yaw, the phases, or all of them
        if what in (0, 3):
            state[:3] += 10.0 * size * self.rng.normal(size=3) * _LEVEL_SHARE
        if what in (1, 3):
            state[3] += 0.5 * size * self.rng.normal()
        if what in (2, 3):
            state[4:] += size * self.rng.normal(size=len(state) - 4)
        if what == 2 and not self.task.shared:
            state[3] = self.rng.uniform(-math.pi, math.pi)
        if self.placed(state[:3]):
            reached = self.climbed(state, _HOP_BETAS)
            if reached > value + _BETTER:
                self.pool.entries[place] = (reached, state)

    def run(self, places_m: FloatArray) -> None:
        """Search: known places first, then everywhere, then around the best."""
        settings = self.settings
        for place_m in places_m:
            self.begin(np.tile(place_m, (settings.coarse, 1)))
        self.spread()
        idle = hops = 0
        while self.pool.entries and idle < settings.patience and hops < settings.most:
            before = self.pool.best
            self.hop()
            hops += 1
            idle = 0 if self.pool.best > before + _SAME else idle + 1


def search_array(
    task: ArrayTask, rng: np.random.Generator, places_m: FloatArray, settings: ArraySettings | None = None
) -> ArrayFound:
    """Return the best states that one search finds.

    Their positions may be a little outside the domain and their values a little short: see
    :func:`nullpose.solve.array_finish.finished`.

    Args:
        task: what to search.
        rng: where starts and hops come from.
        places_m: (m, 3) positions worth a start of their own.
        settings: how hard to try.
    """
    search = _Search(task, rng, settings or ArraySettings())
    search.run(places_m)
    ranked = sorted(search.pool.entries, key=lambda entry: -entry[0])
    return ArrayFound(
        states=tuple(state for _, state in ranked), climbs=search.climbs, evaluations=search.evaluations
    )
