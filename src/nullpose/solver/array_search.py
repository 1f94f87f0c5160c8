"""The search over positions and yaws of a level vehicle that carries an array."""

from __future__ import annotations

import math

import numpy as np

from nullpose.errors import SolveError, require
from nullpose.objectives import FloatArray
from nullpose.physics.array import element_positions
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.records import ArrayProblem
from nullpose.scenario import Array, Scenario
from nullpose.solver.local_search import EpigraphSearch
from nullpose.solver.multistart import NOT_RECEIVED, Incumbent, multistart

_DRAWN, _CLIMBED = 2000, 40  # states of a search, each time
_YAWS = 16  # of a start
_SAME_VALUE = 1e-4
_MOST = 6  # searches
_ENOUGH = 3  # searches with the same end


class ArraySearch(EpigraphSearch):
    """Several independent searches over states: east, north, up and yaw.

    No combining without jamming exceeds as many times one dipole's gain as there are elements.

    Args:
        scenario: nodes, jammers, receiver and airspace; the drone receives.
        array: elements, layout and spacing.
        seed: of the searches.
    """

    angles = 1

    def __init__(self, scenario: Scenario, array: Array, seed: int) -> None:
        family = build_family(scenario, any_channel=True)
        super().__init__(family, float(array.elements), seed)
        places = element_positions(array.elements, array.layout, array.spacing_wavelengths)
        self.problem = ArrayProblem(
            family.ratios,
            np.concatenate([family.ratios.numerator_weight, family.ratios.denominator_weight]),
            len(scenario.nodes),
            np.ascontiguousarray(places[:, :2]),
        )
        self.elements = array.elements
        # by how many equal rotations the elements come to lie on each other
        self.symmetry = max(2, array.elements) if array.layout == "circular" else 2
        self.ends: list[float] = []
        self.seed = seed

    @property
    def agreeing(self) -> int:
        """How many searches ended at the best value."""
        return sum(end > self.best - _SAME_VALUE for end in self.ends)

    def start_from(self, upright: Incumbent) -> None:
        """Climb from the best of some yaws where one vertical dipole is best; no combining is worse.

        Args:
            upright: the dipole's pose, and the work to find it.
        """
        states = np.column_stack(
            [np.tile(upright.position_m, (_YAWS, 1)), np.linspace(0.0, 2.0 * math.pi / self.symmetry, _YAWS)]
        )
        self.climb(states[np.argmax(self.judge(states))])
        self.starts, self.evaluations = self.starts + upright.starts, self.evaluations + upright.evaluations

    def search(self) -> None:
        """Make one more search; the first starts from the pose of a vertical dipole, too.

        Raises:
            SolveError: nothing was found by any search yet.
        """
        if not self.ends:
            self.start_from(multistart(self.family, AxisField.vertical(), seed=self.seed))
        self.ends.append(self.run(_DRAWN, _CLIMBED))
        require(SolveError, self.best > -math.inf, NOT_RECEIVED)

    def search_on(self) -> None:
        """Search until enough searches agree, or until there have been too many."""
        while len(self.ends) < _MOST and self.agreeing < _ENOUGH:
            self.search()

    def orient(self, positions_m: FloatArray) -> FloatArray:
        """Draw a state at each of some positions."""
        return np.hstack([positions_m, self.rng.uniform(-math.pi, math.pi, (len(positions_m), 1))])

    def judge(self, states: FloatArray) -> FloatArray:
        """Evaluate the smallest log ratio of states."""
        from nullpose.solver.kernels.search.array_response import judge_array

        values = np.empty(len(states))
        judge_array(self.problem, self.family.domain, states, values)
        self.evaluations += len(states)
        return values

    def move(self, state: FloatArray, step: FloatArray) -> FloatArray:
        """Move a state by a step."""
        return np.asarray(state + np.append(self.unit_m(state) * step[:3], step[3]))

    def ratios(self, state: FloatArray, step: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Evaluate the log ratios of a moved state, and their slopes."""
        from nullpose.solver.kernels.search.array_response import respond

        logs, slopes = np.empty(self.problem.nodes), np.empty((self.problem.nodes, 4))
        respond(self.problem, self.move(state, step), logs, slopes)
        self.evaluations += 1
        slopes[:, :3] *= self.unit_m(state)
        return logs, slopes
