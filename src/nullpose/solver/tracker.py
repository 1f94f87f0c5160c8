"""The best pose now, at every step of a live stream of places."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import checked, require_usage
from nullpose.objectives import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario
from nullpose.scenario.motion import move_points
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.by_scheme import answer_of
from nullpose.solver.compiling import limit_clock, precompile, working_clock
from nullpose.solver.multistart import multistart, search_settings
from nullpose.solver.options import TIME_LIMIT_S, SolveOptions
from nullpose.solver.proof import Proof
from nullpose.solver.result import Result, result_of
from nullpose.solver.sensitivity import ErrorSizes
from nullpose.solver.solve_and_prove import Outcome, solve_and_prove

TRACKER_GAP = 1e-3
"""The relative gap asked for unless another is."""
_SEEDS = 64  # so many steps look at different positions
_FEWEST = 500  # leaves of a proof that are worth keeping: fewer are made as fast as they are looked at
_MOST = 1.5  # over the leaves of the last proof from the root, beyond which the next begins there again
_LEAST_S = 1e-9  # of a proof


@checked
class Tracker:
    """The best pose at every step of a live stream, each with a bound that no pose exceeds.

    A step begins where the last pose was, looks at a few other positions, and proves what it finds for the
    whole airspace, beginning with the last proof. So the pose jumps where the best one does, in that step,
    whether or not a drone can fly there in time. ``scenario`` is the scene as it stood last.

    Args:
        scenario: a still scene with one dipole, of any objective and channel that a file can state, solved
            with the scheme optimum. Errors that it states do not count.
        gap: relative gap between bound and value at which a step is done.
        deadline_s: seconds after which a step ends with the bound reached, the evaluation of its pose, some
            tenths of a millisecond, not counted; None for a minute.

    Raises:
        WrongTypeError: no scenario was given, but the path of one, say.
        UsageError: an array, an antenna with a pattern, a function in Python, a scene in motion; a bad gap or
            deadline.

    Example:
        >>> import nullpose
        >>> tracker = nullpose.Tracker(nullpose.load("examples/paper.toml"))
        >>> for x_m in (17.0, 16.95, 16.9):
        ...     result = tracker.update(jammers_m=[[x_m, 15.0, 4.0]])
        ...     print(str(result.status), result.pose.position_m.round(1))
        certified [-2.2 23.8  8. ]
        certified [-2.3 23.8  8. ]
        certified [-2.3 23.8  8. ]
    """

    def __init__(self, scenario: Scenario, gap: float = TRACKER_GAP, deadline_s: float | None = None) -> None:
        require_usage(
            deadline_s is None or deadline_s >= 0.0,
            f"deadline_s: given {deadline_s!r}; allowed: 0 seconds or more, or None for no deadline",
        )
        require_usage(
            scenario.array is None, "Tracker: given an array; allowed: one dipole; solve knows arrays"
        )
        self._family_of(scenario)
        if scenario.at_s is not None:  # things move on from where they were then
            name = scenario.name.rpartition("(at ")[0].strip()
            scenario = scenario.model_copy(update={"at_s": None, "name": name})
        self.scenario, self._deadline_s = scenario, TIME_LIMIT_S if deadline_s is None else deadline_s
        self._field = AxisField.within(*scenario.axis_band)
        self._is_patient = deadline_s is None
        self._options = SolveOptions(gap=gap, threads=1).of(scenario)
        self._steps = 0
        self._near_m: FloatArray | None = None
        self._proof: Proof | None = None
        self._fresh_leaves, self._has_grown = math.inf, False
        precompile()  # no step is to wait for it

    @checked
    def update(
        self,
        nodes_m: ArrayLike | None = None,
        jammers_m: ArrayLike | None = None,
        *,
        eavesdroppers_m: ArrayLike | None = None,
        sources_m: ArrayLike | None = None,
        destination_m: ArrayLike | None = None,
    ) -> Result:
        """Find the best pose with everything where it is now; what is left out stays where it was.

        Args:
            nodes_m: places of all nodes, in the scenario's order: east, north, up, ``(n, 3)``, metres.
            jammers_m: likewise of the jammers.
            eavesdroppers_m: likewise of the eavesdroppers.
            sources_m: likewise of the sources.
            destination_m: place of a relay's destination, ``(3,)``.

        Returns:
            As from :func:`nullpose.solver.solve`, its scenario being the one of this moment. The bound has no
            certificate: solve that scenario for one.

        Raises:
            UsageError: places of another shape.
            ScenarioError: a place is no place, or one where no point may be.
            SolveError: no pose reaches every node, or what it requires.
        """
        began, started = working_clock(), limit_clock()
        places = {
            "nodes": nodes_m,
            "jammers": jammers_m,
            "eavesdroppers": eavesdroppers_m,
            "sources": sources_m,
        }
        places["destination"] = None if destination_m is None else np.reshape(destination_m, (-1, 3))
        scenario = self._moved({kind: at_m for kind, at_m in places.items() if at_m is not None})
        family = self._family_of(scenario)
        self.scenario, self._steps = scenario, self._steps + 1
        found = multistart(
            family,
            self._field,
            seed=self._steps % _SEEDS,
            settings=search_settings(True, self._field, len(family.ratios.shares) > 0),
            near=self._near_m,
        )
        left_s = self._deadline_s - (limit_clock() - started)
        options = replace(self._options, time_limit_s=max(_LEAST_S, left_s))
        last = None if self._has_grown else self._proof
        outcome = solve_and_prove(
            family, [self._field], options, incumbent=found, last=last, searches_again=self._is_patient
        )
        if outcome.reason == INTERRUPT:
            raise KeyboardInterrupt
        if outcome.reason and limit_clock() > started + self._deadline_s:
            outcome = replace(outcome, reason=f"the deadline of {self._deadline_s:g} s")
        self._keep(outcome, last)
        without_leaves = replace(outcome, proofs=(), cells=outcome.nodes)
        answer = answer_of(scenario, Scheme.OPTIMUM, without_leaves, None, options)
        return result_of(scenario, answer, options, began, ErrorSizes())

    @staticmethod
    def _family_of(scenario: Scenario) -> Family:
        return build_family(scenario, any_channel=True, any_objective=True)

    def _moved(self, places: dict[str, ArrayLike]) -> Scenario:
        """Check the shapes of places, and move the points there."""
        moved: dict[str, FloatArray] = {}
        for kind, at in places.items():
            count = len(getattr(self.scenario, f"{kind.removesuffix('s')}s"))
            at_m = np.asarray(at, dtype=float)
            moved[kind] = at_m = at_m if at_m.size else at_m.reshape(0, 3)
            require_usage(
                at_m.shape == (count, 3),
                f"{kind}_m: given shape {at_m.shape}; allowed: ({count}, 3), a row of east, north and up in "
                f"metres for each; for more or fewer {kind} make another Tracker",
            )
        return move_points(self.scenario, moved) if moved else self.scenario

    def _keep(self, outcome: Outcome, last: Proof | None) -> None:
        """Keep pose and proof as far as it came; let the next begin at the root if it has grown."""
        self._near_m, self._has_grown = outcome.incumbent.position_m[None], False
        leaves = len(outcome.proofs[0].leaves) if outcome.proofs else 0
        if outcome.reason and leaves > 1:
            self._proof = outcome.proofs[0]
        elif outcome.reason:
            self._proof = None if last is not None and last.reason else self._proof  # too much for the time
        elif leaves:
            self._fresh_leaves = leaves if last is None else self._fresh_leaves
            self._has_grown = leaves > _MOST * self._fresh_leaves
            self._proof = outcome.proofs[0] if leaves > _FEWEST else None
