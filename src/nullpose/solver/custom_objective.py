"""Objectives that are functions in Python: a search by their values over positions and axes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.linalg import null_space

from nullpose.errors import require_usage
from nullpose.objectives import USUAL, FloatArray
from nullpose.physics import sinr
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario
from nullpose.solver.compiling import compile_search
from nullpose.solver.local_search import EpigraphSearch
from nullpose.solver.multistart import multistart
from nullpose.solver.options import SolveOptions
from nullpose.solver.solve_and_prove import Outcome

_DRAWN, _CLIMBED = 2000, 6  # states of a search, each time
_LOWERED = (0.3, 1e-2, 0.0)  # shares by which single SINRs are lowered, the last from the best state
_STEP = 1e-6  # of differences
_SHARE = 1e-2  # by which all SINRs are lowered to see how the function falls


class ObjectiveSearch(EpigraphSearch):
    """A search over states: the position and the unit axis.

    It begins where the smallest SINR, the mean of the SINRs in dB and the sum of the rates are largest. A
    function may have kinks, as the smallest SINR has where two are equal: first the least of the function's
    values with each SINR in turn a little lower is maximised, of which those that meet at a kink are seen
    apart, and then the function itself. Values count from that of the first of these poses, in units of what
    the function loses there with the SINRs.

    Args:
        scenario: with an objective that is a function.
        field: which axes are allowed.
        seed: of the states drawn.
    """

    steps = 40  # few, for at a kink they lead nowhere

    def __init__(self, scenario: Scenario, field: AxisField, seed: int) -> None:
        smallest = scenario.model_copy(update={"objective": USUAL})
        super().__init__(build_family(smallest, any_channel=True, any_function=True), 1.0, seed)
        self.scenario, self.field, self.angles = scenario, field, 2 if field.is_free else 0
        equal = np.full(len(scenario.nodes), 1.0 / len(scenario.nodes))
        means = [self.family.changed(shares=equal, offset=offset) for offset in (0.0, 1.0)]
        self.known = [multistart(each, field, seed=seed) for each in (self.family, *means)]
        starts = [self._state(each.position_m, each.axis) for each in self.known]
        self.origin, less = scenario.objective.values_of(
            np.array([[1.0], [1.0 - _SHARE]]) * sinr(scenario, *np.split(starts[0], 2))
        )
        self.unit = (self.origin - less) / _SHARE or 1.0
        for start in starts:
            self.climb(start)

    def values_of(self, ratios: FloatArray) -> FloatArray:
        """Evaluate the function, (...), from SINRs, (..., n_nodes)."""
        values = self.scenario.objective.values_of(ratios)
        require_usage(
            not np.any(np.isnan(values)),
            f"objective: {self.scenario.objective} returned no number at a pose; allowed: a function that "
            "returns one for any SINRs, such as float(np.min(sinr))",
        )
        return np.asarray((values - self.origin) / self.unit)

    def _state(self, position_m: FloatArray, axis: FloatArray) -> FloatArray:
        """Put states together, (..., 6), each axis the nearest that is allowed."""
        if not self.field.is_free:
            return np.concatenate([position_m, self.field.axis_at(position_m)], axis=-1)
        up = axis[..., 2:] / np.linalg.norm(axis, axis=-1, keepdims=True)
        up = np.copysign(np.clip(np.abs(up), *np.sqrt(self.field.band)), up)
        level = axis[..., :2] / np.maximum(np.linalg.norm(axis[..., :2], axis=-1, keepdims=True), 1e-300)
        return np.concatenate([position_m, np.sqrt(1.0 - up**2) * level, up], axis=-1)

    def box(self, log_value: float) -> tuple[FloatArray, FloatArray]:
        """Return the corners of the airspace: nothing else bounds where a function is large."""
        return self.family.domain.low_m, self.family.domain.high_m

    def orient(self, positions_m: FloatArray) -> FloatArray:
        """Draw a state at each of some positions, half of them with the null on a jammer."""
        axes, jammers_m = self.rng.normal(size=positions_m.shape), self.scenario.jammer_positions_m
        if len(jammers_m):
            axes[::2] = self.rng.choice(jammers_m, len(axes[::2])) - positions_m[::2]
        return self._state(positions_m, axes)

    def judge(self, states: FloatArray) -> FloatArray:
        """Evaluate the function at states, (n,), minus infinity where a position is not allowed."""
        from nullpose.solver.kernels.search.domain import contains

        allowed = [contains(self.family.domain, state[:3]) for state in states]
        values = np.full(len(states), -math.inf)
        values[allowed] = self.values_of(sinr(self.scenario, states[allowed, :3], states[allowed, 3:]))
        self.evaluations += len(states)
        return values

    def move(self, state: FloatArray, step: FloatArray) -> FloatArray:
        """Move a state by a step, or by several, (..., 3 + angles)."""
        around = step[..., 3:] @ null_space(state[None, 3:]).T[: self.angles]
        return self._state(state[:3] + self.unit_m(state) * step[..., :3], state[3:] + around)

    def ratios(self, state: FloatArray, step: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Evaluate the function at a moved state and its slopes; if SINRs are lowered, once for each."""
        sides = _STEP * np.eye(len(step))
        states = self.move(state, np.vstack([step, step + sides, step - sides]))
        ratios = sinr(self.scenario, states[:, :3], states[:, 3:])[:, None]
        lower = 1.0 - self.lowered * np.eye(ratios.shape[-1])
        values, above, below = np.split(
            self.values_of(ratios * (lower if self.lowered else 1.0)), [1, 1 + len(step)]
        )
        self.evaluations += len(states)
        return values[0], (above - below).T / (2.0 * _STEP)

    def climb(self, state: FloatArray) -> float:
        """Climb to a local optimum, and keep it if it is the best so far; return its value."""
        shares = _LOWERED if state is self.state else _LOWERED[:-1]
        value = self.take(state)
        for self.lowered in shares:
            if (reached := super().climb(state)) > value:
                value, state = reached, self.last
        return value


def solve_by_function(scenario: Scenario, fields: Sequence[AxisField], options: SolveOptions) -> Outcome:
    """Search for the best pose; nothing is proved.

    Args:
        scenario: with an objective that is a function in Python.
        fields: the axis fields, one or more.
        options: what is asked for.

    Raises:
        UsageError: the function returns no number at a pose.
        SolveError: no pose reaches every node.
    """
    compile_search()
    searches = [ObjectiveSearch(scenario, field, options.seed) for field in fields]
    ends = [search.origin + search.unit * search.run(_DRAWN, _CLIMBED) for search in searches]
    best = searches[chosen := int(np.argmax(ends))]
    found = replace(
        best.known[0],
        position_m=best.state[:3],
        axis=best.state[3:],
        log_value=math.nan,
        starts=sum(search.starts for search in searches),
        evaluations=sum(search.evaluations for search in searches),
    )
    return Outcome(
        incumbent=found,
        chosen=chosen,
        reason="an objective that is a function in Python is searched, and nothing is proved of it",
    )
