"""The pose that guarantees most: error cases are added where they bind, until few speak for all."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.physics import Pose, evaluate
from nullpose.physics.error_case import ErrorCase
from nullpose.physics.gain import worst_polarised
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.problem.robust import BindingCase, build_robust_family
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.compiling import limit_clock, precompile
from nullpose.solver.multistart import Incumbent, SearchSettings, climb, multistart, search_settings
from nullpose.solver.options import SolveOptions
from nullpose.solver.proof import prove
from nullpose.solver.result import BoundedPose, Stats
from nullpose.solver.rigour import Rigour
from nullpose.solver.robust.guarantee import Inner, guarantee_of, require_dipole
from nullpose.solver.robust.solution import GuardedPose, RobustDetails
from nullpose.solver.solve_and_prove import solve_and_prove

ROBUST_GAP = 1e-2
"""The relative gap asked for unless another is."""

POLARISATION = (
    "jammers and eavesdroppers whose dipole has a null depth count as isotropic, and what leaks through a "
    "node's null counts as lost: the worst that they could be"
)
"""The note of a solution whose scenario states such."""
_CLIMB, _CLIMB_STEPS = 1e-2, 100  # barrier weight and steps of a climb from the best pose so far
_MOST_ROUNDS = 100
_SHARE = 1.0 / 3.0  # of the gap, for the distance between the finite family and the guarantee
_ROUNDING = 1e-9
_FINER = 0.1  # accuracy of guarantees, as a share of the gap
_ACCURACIES = 1e-6, 3e-3
_LEAST_GAP, _WIDEST_GAP = 1e-8, 10.0  # of a proof


def solve_robust(scenario: Scenario, limits: SolveOptions) -> BoundedPose:
    """Find the pose whose objective is largest when the scenario's errors do their worst.

    What the pose guarantees is proved; that no pose guarantees much more is proved with ``certify``. On a
    limit or an interrupt the best so far is returned.

    Args:
        scenario: with errors or without, which makes the guaranteed value the nominal one.
        limits: the options of the scenario.

    Raises:
        UsageError: an array in place of the dipole.
        SolveError: no pose reaches every node.
    """
    field, search = AxisField.within(*scenario.axis_band), replace(limits, certify=False)
    inner = Inner(worst_polarised(require_dipole(scenario)))
    if limits.certify:
        precompile()  # compiling must not count against the time limit
    began, again = limit_clock(), True
    incumbent = solve_and_prove(build_family(scenario, any_channel=True), [field], search).incumbent
    nominal = Pose.of_airframe(scenario, incumbent.position_m, incumbent.axis)
    exchange = Exchange(inner, field, limits, nominal.position_m, nominal.antenna_axis)
    robust = None
    try:
        while again:
            exchange.search(began + limits.time_limit_s)
            robust = _prove_best(scenario, exchange, robust)
            again = limits.certify and exchange.prove(exchange.level(robust.guarantee.lower), began)
    except KeyboardInterrupt:
        exchange.reason = INTERRUPT
    robust = _prove_best(scenario, exchange, robust)
    is_close = robust.guarantee.worst <= exchange.level(robust.guarantee.lower)
    unsettled = (
        "error cases that the search did not settle"
        if is_close
        else "limit of the proof of what the pose guarantees: most cells of errors"
    )
    without_errors = guarantee_of(inner, nominal.position_m, nominal.antenna_axis, exchange.accuracy())
    return BoundedPose(
        scheme="robust",
        pose=robust.pose,
        links=evaluate(scenario, robust.pose),
        value=robust.guaranteed,
        upper_bound=exchange.upper_bound,
        reason=exchange.reason or unsettled * limits.certify,
        settings={"gap": limits.target},
        stats=Stats(starts=exchange.starts, evaluations=exchange.evaluations, boxes=exchange.boxes),
        # what is guaranteed rests on a floating-point proof, whether a bound is asked for or not
        rigour=Rigour.FLOATING_POINT,
        note="" if scenario is inner.scenario else POLARISATION,
        details=RobustDetails(
            robust=robust,
            nominal=GuardedPose(scenario=scenario, pose=nominal, guarantee=without_errors),
            cases=len(exchange.cases),
        ),
    )


def _prove_best(scenario: Scenario, exchange: Exchange, before: GuardedPose | None) -> GuardedPose:
    """Prove what the best pose so far guarantees, unless that is the one from before."""
    position_m, axis, _ = exchange.best
    if before is not None and np.allclose(
        (before.guarantee.position_m, before.guarantee.axis), (position_m, axis), 1e-12
    ):
        return before
    pose = Pose.of_airframe(scenario, position_m, axis)
    proved = guarantee_of(exchange.inner, pose.position_m, pose.antenna_axis, exchange.accuracy())
    return GuardedPose(scenario=scenario, pose=pose, guarantee=proved)


class Visited(NamedTuple):
    """A pose and the smallest ratio of the worst cases found there."""

    position_m: FloatArray
    axis: FloatArray
    worst: float


class Exchange:
    """The search for the pose that guarantees most, and the bound on what any pose guarantees.

    A finite family of error cases is maximised; the worst cases at its best pose join it; again, until its
    value exceeds what the best pose so far guarantees by a share of the gap. Fewer errors than all make every
    pose look better, so a proof for the finite family bounds what can be guaranteed.

    Args:
        inner: the scenario, prepared.
        axis_field: the axes that the airframe reaches.
        limits: the gap between bound and guarantee that is aimed at, and what all proofs may cost.
        position_m: (3,) position of the pose to begin with.
        axis: (3,) its axis, of any length.
    """

    def __init__(
        self,
        inner: Inner,
        axis_field: AxisField,
        limits: SolveOptions,
        position_m: FloatArray,
        axis: FloatArray,
    ) -> None:
        self.inner, self.axis_field, self.limits = inner, axis_field, limits
        blank = ErrorCase.none(inner.scenario)
        self.cases: list[BindingCase] = []
        self.best = Visited(position_m, axis, -math.inf)
        self.add([BindingCase(ratio, blank) for ratio in range(inner.n_ratios)])
        self.add(self.visit(position_m, axis))
        self.incumbent: Incumbent | None = None
        self.starts = self.evaluations = self.boxes = 0
        self.upper_bound: float | None = None
        self.reason = ""

    def add(self, cases: Sequence[BindingCase]) -> bool:
        """Add cases to the finite family; tell whether any was not in it."""
        new = [each for each in cases if not any(each.is_same(other) for other in self.cases)]
        self.cases += new
        return bool(new)

    def accuracy(self) -> float:
        """Choose how close the guarantee of the best pose has to be to its worst case."""
        finest, coarsest = _ACCURACIES
        return min(coarsest, max(finest, _FINER * self.limits.ratio_gap(self.best.worst)))

    def level(self, ratio: float, share: float = 1.0) -> float:
        """Raise a ratio, at least 1 for a rate, by a share of the gap."""
        ratio = max(1.0, ratio) if self.limits.of_rate else ratio
        return ratio * (1.0 + replace(self.limits, gap=share * self.limits.target).ratio_gap(ratio))

    @property
    def family(self) -> Family:
        """The finite family of the cases so far."""
        return build_robust_family(self.inner.scenario, self.cases)

    def visit(self, position_m: FloatArray, axis: FloatArray, level: float = math.inf) -> list[BindingCase]:
        """Find the worst cases at a pose that are below a level; remember the pose if it is the best so far.

        Args:
            position_m: (3,) the position.
            axis: (3,) the axis, of any length.
            level: what the finite family promises there.
        """
        unit = axis / np.linalg.norm(axis)
        worst = self.inner.worst(position_m, unit)
        if (value := min(case.worst for case in worst)) > self.best.worst:
            self.best = Visited(position_m.copy(), unit, value)
        return [case.binding for case in worst if case.worst < level * (1.0 - _ROUNDING)]

    def search(self, deadline: float) -> None:
        """Add cases until the finite family promises little more than the best pose guarantees.

        A light search leads the way; its end is confirmed by a thorough one.

        Args:
            deadline: when to stop in any case, on the clock of ``limit_clock``.
        """
        light, thorough = (search_settings(follows, self.axis_field) for follows in (True, False))
        settings = light
        for _ in range(_MOST_ROUNDS):
            found = self._search_once(settings, deadline)
            self.incumbent, promised = found, math.exp(found.log_value)
            new = self.visit(found.position_m, found.axis, promised)
            close = promised <= self.level(self.best.worst, _SHARE)
            if limit_clock() > deadline or (close and settings is thorough):
                return  # the family stays the one that was searched
            if close:
                settings = thorough
            elif not self.add(new):
                return

    def _search_once(self, settings: SearchSettings, deadline: float) -> Incumbent:
        """Search the finite family by a multistart, and by a climb from the best pose so far."""
        family, field = self.family, self.axis_field
        with np.errstate(invalid="ignore"):  # copies of one jammer have no line between them
            anywhere = multistart(family, field, seed=self.limits.seed, settings=settings, deadline=deadline)
        near = climb(family, field, self.best.position_m, self.best.axis, mu=_CLIMB, steps=_CLIMB_STEPS)
        self.starts += anywhere.starts + 1
        self.evaluations += anywhere.evaluations + near.evaluations
        return max(anywhere, near, key=lambda end: end.log_value)

    def prove(self, level: float, began: float) -> bool:
        """Bound the finite family by a level; tell whether to search on, since a better pose turned up.

        Args:
            level: the ratio that no pose is to exceed.
            began: when the clock of the limits began.
        """
        assert self.incumbent is not None
        least = 0.0 if self.limits.of_rate else -math.inf  # a rate is never below zero
        start = replace(self.incumbent, log_value=max(least, self.incumbent.log_value))
        value = math.exp(start.log_value)
        gap = level / value - 1.0
        gap = gap if gap > _LEAST_GAP else self.limits.ratio_gap(value)  # the search was cut short
        target = replace(self.limits, of_rate=False, gap=min(_WIDEST_GAP, max(_LEAST_GAP, gap)))
        proof = prove(self.family, self.axis_field, start, target, began=began, nodes=self.boxes)
        self.boxes += proof.nodes
        self.upper_bound = min(proof.upper_bound, math.inf if self.upper_bound is None else self.upper_bound)
        self.reason, found = proof.reason, proof.incumbent
        if not found.log_value > start.log_value + _ROUNDING:
            return False
        new = self.visit(found.position_m, found.axis, math.exp(found.log_value))
        return self.add(new) and not proof.reason
