"""Independent searches for the best state of an array, and how far they agree."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import SolveError
from nullpose.family import AxisField
from nullpose.solve.array_finish import finished
from nullpose.solve.array_search import search_array
from nullpose.solve.array_task import ArrayTask, silent
from nullpose.solve.multistart import landmarks, multistart

__all__ = ["ArrayHunt"]

FloatArray = NDArray[np.float64]

_MOST = 6  # searches
_ENOUGH = 3  # searches with the same end
_SAME = 1e-4
_HARSH = 1e4  # jamming above which every other search begins with less of it
_HARSHER = 10.0


class ArrayHunt:
    """The best state of several searches.

    Args:
        task: what is searched.
        seed: seed of the searches.
        places_m: (..., 3) positions worth a start of their own, beside those that every array has.
    """

    def __init__(self, task: ArrayTask, seed: int, *places_m: FloatArray) -> None:
        self.task, self.seed = task, seed
        self.ends: list[float] = []
        self.best, self.state = -math.inf, np.empty(0)
        self.starts = self.evaluations = 0
        self.places_m = np.vstack([*places_m, *self._vertical(), landmarks(task.family)])

    @property
    def agreeing(self) -> int:
        """How many searches ended at the best value."""
        return sum(end > self.best - _SAME for end in self.ends)

    @property
    def is_open(self) -> bool:
        """Whether another search may change anything."""
        return len(self.ends) < _MOST and self.agreeing < _ENOUGH

    def reaches(self, bound: float, gap: float) -> bool:
        """Return whether the best value is within a relative gap of a bound."""
        return bound <= math.exp(self.best) * (1.0 + gap)

    def search(self) -> None:
        """Make one more search.

        Raises:
            SolveError: nothing was found by any search yet.
        """
        number = len(self.ends)
        harsh = self.task.jamming > _HARSH and number % 2 == 1
        rng = np.random.default_rng([self.seed, number])
        found = search_array(self.task.calmed(_HARSH) if harsh else self.task, rng, self.places_m)
        self.starts += found.climbs
        self.evaluations += found.evaluations
        end = -math.inf
        for state in found.states:
            value, state = finished(self.task, self._hardened(state) if harsh else state)
            end = max(end, value)
            self._offer(value, state)
        self.ends.append(end)
        if not self.best > -math.inf:
            raise SolveError("no position was found at which every node is received; widen the airspace")

    def look(self, state: FloatArray) -> bool:
        """Finish a state from elsewhere; return whether it is better than all before."""
        return self._offer(*finished(self.task, state))

    def _offer(self, value: float, state: FloatArray) -> bool:
        if not value > self.best:
            return False
        self.best, self.state = value, state
        return True

    def _hardened(self, state: FloatArray) -> FloatArray:
        """Return a state found with little jamming, carried along as that grows to what it is."""
        jamming = _HARSH
        while jamming < self.task.jamming:
            state = finished(self.task.calmed(jamming), state)[1]
            jamming *= _HARSHER
        return state

    def _vertical(self) -> list[FloatArray]:
        """Return where one vertical dipole hears best, with the jammers and without them."""
        places = []
        for family in (self.task.family, silent(self.task.family)):
            found = multistart(family, AxisField.vertical(), seed=self.seed)
            self.starts += found.starts
            self.evaluations += found.evaluations
            places.append(found.position_m)
        return places
