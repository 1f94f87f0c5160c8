"""Searches over the states of an array: climbs from many starts, then hops from the best of them.

The landscape has many local optima, more the longer the array is, and those with the best values lie close to
other good ones; so most of the work goes into perturbing what is good already. Independent searches are made
until several agree.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nullpose.errors import SolveError
from nullpose.objectives import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.solver.array_finish import finished
from nullpose.solver.array_task import ArrayTask, silent
from nullpose.solver.multistart import NOT_RECEIVED, landmarks, multistart

_BETAS = np.array([4.0, 16.0, 64.0])
_HOP_BETAS = _BETAS[1:]
_STEPS = 60
_SAME_VALUE = 1e-4
_BETTER = 1e-6
_BATCH = 50  # starts between two looks at how far an optimum can be
_HOPS = np.array(  # east, north and up (m), shorter as the optimum is often on the floor, and yaw (rad)
    [[10.0, 10.0, 3.0, 0.0], [0.0, 0.0, 0.0, 0.5], [0.0, 0.0, 0.0, 20.0], [10.0, 10.0, 3.0, 0.5]]
)
_MOST = 6  # searches
_ENOUGH = 3  # searches with the same end
_HARSH = 1e4  # jamming above which every other search begins with less of it
_HARSHER = 10.0


class ArraySettings(NamedTuple):
    """How hard one search tries."""

    first: int = 300  # climbs from fresh starts
    coarse: int = 8  # states judged for each of them
    elites: int = 8  # different optima that are kept
    patience: int = 500  # hops without improvement after which it stops
    most: int = 4000  # most hops


class Pool:
    """The best states so far, each with another value, the best first.

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
        place = next(
            (i for i, (other, _) in enumerate(self.entries) if abs(value - other) < _SAME_VALUE), None
        )
        if place is None and value > -math.inf:
            self.entries.append((value, state))
        elif place is not None and value > self.entries[place][0]:
            self.entries[place] = (value, state)
        self.entries = sorted(self.entries, key=lambda entry: -entry[0])[: self.size]


class ArraySearch:
    """One search: places worth a start first, then everywhere, then around the best.

    Positions may end a little outside the domain, and values a little short: see
    :func:`nullpose.solver.array_finish.finished`.

    Args:
        task: what to search.
        rng: where starts and hops come from.
        places_m: (m, 3) positions worth a start of their own.
        settings: how hard to try.
    """

    def __init__(
        self,
        task: ArrayTask,
        rng: np.random.Generator,
        places_m: FloatArray,
        settings: ArraySettings | None = None,
    ) -> None:
        self.task, self.rng, self.settings = task, rng, settings or ArraySettings()
        self.pool = Pool(self.settings.elites)
        self.climbs = self.evaluations = 0
        for place_m in places_m:
            self._begin(np.tile(place_m, (self.settings.coarse, 1)))
        self._spread()
        idle = hops = 0
        while self.pool.entries and idle < self.settings.patience and hops < self.settings.most:
            before = self.pool.best
            self._hop()
            hops += 1
            idle = 0 if self.pool.best > before + _SAME_VALUE else idle + 1

    @property
    def states(self) -> list[FloatArray]:
        """The best states, each with another value, the best first."""
        return [state for _, state in sorted(self.pool.entries, key=lambda entry: -entry[0])]

    def _climbed(self, states: FloatArray, betas: FloatArray) -> tuple[float, FloatArray]:
        """Climb from the best of some states; return the value and the state that this ends at."""
        from nullpose.solver.kernels.array_climb import climb

        state, value, evaluations = climb(self.task.problem, self.task.family.domain, states, betas, _STEPS)
        self.climbs += 1
        self.evaluations += int(evaluations)
        return float(value), state

    def _placed(self, position_m: FloatArray) -> bool:
        """Move a position into the domain; false if that failed."""
        from nullpose.solver.kernels.search import push_out

        return bool(push_out(position_m, self.task.family.domain))

    def _begin(self, positions_m: FloatArray) -> None:
        """Climb from the best of several yaws, each at one of the positions."""
        angles = self.rng.uniform(-math.pi, math.pi, (len(positions_m), 1))
        states = np.hstack([positions_m, angles])
        kept = states[[self._placed(state[:3]) for state in states]]
        if len(kept):
            self.pool.offer(*self._climbed(kept, _BETAS))

    def _spread(self) -> None:
        """Climb from fresh starts all over where an optimum can be, every other one on the floor."""
        for done in range(self.settings.first):
            if done % _BATCH == 0:
                low_m, high_m = self.task.reach(self.pool.best)
            shares = self.rng.uniform(size=(self.settings.coarse, 3))
            shares[::2, 2] = 0.0
            self._begin(low_m + shares * (high_m - low_m))

    def _hop(self) -> None:
        """Perturb one of the best states, climb again, and keep what is better."""
        place = int(self.rng.integers(len(self.pool.entries)))
        value, state = self.pool.entries[place]
        spread = 10.0 ** self.rng.uniform(-1.0, 0.3) * self.rng.choice(_HOPS)
        state = state + spread * self.rng.normal(size=4)
        if self._placed(state[:3]):
            reached = self._climbed(state[None], _HOP_BETAS)
            if reached[0] > value + _BETTER:
                self.pool.entries[place] = reached


class ArrayHunt:
    """The best state of several independent searches, and how far they agree.

    Args:
        task: what is searched.
        seed: seed of the searches.
    """

    def __init__(self, task: ArrayTask, seed: int) -> None:
        self.task, self.seed = task, seed
        self.ends: list[float] = []
        self.best, self.state = -math.inf, np.empty(0)
        families = task.family, silent(task.family)
        vertical = [multistart(family, AxisField.vertical(), seed=seed) for family in families]
        self.starts = sum(found.starts for found in vertical)
        self.evaluations = sum(found.evaluations for found in vertical)
        heard_m = [found.position_m for found in vertical]
        self.places_m = np.vstack([*heard_m, landmarks(task.family)])

    @property
    def agreeing(self) -> int:
        """How many searches ended at the best value."""
        return sum(end > self.best - _SAME_VALUE for end in self.ends)

    def reaches(self, bound: float, gap: float) -> bool:
        """Test if the best value is within a relative gap of a bound."""
        return bound <= math.exp(self.best) * (1.0 + gap)

    def search_on(self) -> None:
        """Search until enough searches agree, or until there have been too many."""
        while len(self.ends) < _MOST and self.agreeing < _ENOUGH:
            self.search()

    def search(self) -> None:
        """Make one more search.

        Raises:
            SolveError: nothing was found by any search yet.
        """
        number = len(self.ends)
        harsh = self.task.jamming > _HARSH and number % 2 == 1
        rng = np.random.default_rng([self.seed, number])
        found = ArraySearch(self.task.calmed(_HARSH) if harsh else self.task, rng, self.places_m)
        self.starts += found.climbs
        self.evaluations += found.evaluations
        states = [self._hardened(state) if harsh else state for state in found.states]
        self.ends.append(max((self.look(state) for state in states), default=-math.inf))
        if not self.best > -math.inf:
            raise SolveError(NOT_RECEIVED)

    def look(self, state: FloatArray) -> float:
        """Finish a state, which is kept if it is better than all before; return its value."""
        value, state = finished(self.task, state)
        if value > self.best:
            self.best, self.state = value, state
        return value

    def _hardened(self, state: FloatArray) -> FloatArray:
        """Carry a state found with little jamming along as the jamming grows to its full strength."""
        jamming = _HARSH
        while jamming < self.task.jamming:
            state = finished(self.task.calmed(jamming), state)[1]
            jamming *= _HARSHER
        return state
