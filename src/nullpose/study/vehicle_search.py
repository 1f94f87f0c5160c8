"""Vehicles held against one that takes any attitude: which suffice, by one rule, and no nearer proof.

A vehicle *suffices* if its pose is proved to reach a share of what any pose can: its value is at least that
share of the upper bound of the omnidirectional vehicle. It *falls short* if its own upper bound is below that
share of the omnidirectional vehicle's value. Between the two nothing is proved.
"""

from __future__ import annotations

import math
from dataclasses import replace
from enum import StrEnum

from nullpose.physics import Pose
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Airframe, Scenario
from nullpose.solver import Result, SolveKeywords, Status, solve
from nullpose.solver.objective import Objective, status_of
from nullpose.solver.result import Stats
from nullpose.solver.rigour import Rigour
from nullpose.study.evaluation import evaluated

LEAST_GAP = 1e-8
AS_NEEDED = "the verdict needs no nearer bound"
_ALL = 1.0 - 1e-7  # a share above this counts as this: proofs do not come nearer
_WIDEST_GAP, _SHARES = 10.0, (0.9, 0.5, 0.1)  # of what is missing to the target: the gaps of proofs
_ROUNDING_RAD = 1e-9


class Sufficiency(StrEnum):
    """Whether a vehicle suffices in place of the omnidirectional one, so far as the bounds prove it."""

    SUFFICES = "yes"
    FALLS_SHORT = "no"
    NOT_PROVED = "not proved"


def required(whole: Objective, share: float) -> float:
    """Compute the least value that is proved to be a share of any pose's; infinite without a bound.

    Args:
        whole: value and bound of the omnidirectional vehicle.
        share: above 0, at most 1.
    """
    return math.inf if whole.upper_bound is None else min(share, _ALL) * whole.upper_bound


def judged(vehicle: Objective, whole: Objective, share: float) -> Sufficiency:
    """Decide whether a vehicle reaches a share of what any pose can, so far as the bounds prove it.

    Args:
        vehicle: its value and bound.
        whole: value and bound of the omnidirectional vehicle.
        share: above 0, at most 1.
    """
    if whole.value > 0.0 and vehicle.value >= required(whole, share):
        return Sufficiency.SUFFICES
    if vehicle.upper_bound is not None and vehicle.upper_bound < share * whole.value:
        return Sufficiency.FALLS_SHORT
    return Sufficiency.NOT_PROVED


class VehicleSearch:
    """The solves of one scenario for several vehicles, and the rigour of the least sure bound.

    Args:
        scenario: of the omnidirectional vehicle, without an array.
        share: of its value that suffices.
        options: as for :func:`nullpose.solver.solve`; with the gap of the omnidirectional vehicle.

    Raises:
        SolveError: no pose of the omnidirectional vehicle reaches every node.
    """

    def __init__(self, scenario: Scenario, share: float, options: SolveKeywords) -> None:
        self.scenario, self.share, self.options = scenario, share, SolveKeywords(**options)
        self.gap = options.get("gap") or LEAST_GAP
        self.whole = solve(scenario, **options)
        self.rigour = self.whole.rigour

    def judge(self, result: Result) -> Sufficiency:
        """Decide whether a result suffices."""
        return judged(result.objective, self.whole.objective, self.share)

    def solved(self, airframe: Airframe) -> Result:
        """Find the best pose of a vehicle, and prove no more of it than the verdict needs.

        Where the verdict is open because the omnidirectional bound is too far off, that bound is improved.

        Raises:
            SolveError: no pose was found that reaches every node, which proves nothing.
        """
        result = self._proved(airframe)
        while self.judge(result) is Sufficiency.NOT_PROVED and self._improves_bound(result):
            result = self._proved(airframe)
        return result

    def flown(self, result: Result, airframe: Airframe) -> Result:
        """Fly a result's pose with a vehicle, by the least tilt, which may be more than the vehicle takes."""
        free = self._with(Airframe(tilt_max_deg=180.0, mount_deg=airframe.mount_deg))
        pose = Pose.of_airframe(free, result.pose.position_m, result.pose.orientation(free.antenna_record))
        return self._bounded(self.whole, self._with(airframe), pose, Stats(evaluations=1))

    def _proved(self, airframe: Airframe) -> Result:
        """Take the omnidirectional pose if it is reached; else search, and prove a miss.

        Where the value is far below the target a wide gap proves that all are, which takes few boxes.
        """
        best = self.flown(self.whole, airframe)
        if best.pose.tilt_rad <= airframe.tilt_max_rad + _ROUNDING_RAD:
            return best
        scenario, whole = self._with(airframe), self.whole.objective
        found = solve(scenario, **self.options | {"certify": False})
        best = self._bounded(self.whole, scenario, found.pose, found.stats)
        for share in _SHARES:
            value = best.objective.value
            missing = self.share * whole.value / value - 1.0 if value > 0.0 else math.inf
            is_open = whole.upper_bound is not None and self.judge(best) is Sufficiency.NOT_PROVED
            if not is_open or missing <= 0.0:  # no bound of its own could show that it falls short
                break
            gap = min(max(share * missing, LEAST_GAP), _WIDEST_GAP)
            proof = solve(scenario, **self.options | {"gap": gap})
            self.rigour = max(self.rigour, proof.rigour, key=list(Rigour).index)
            pose = max(best, proof, key=lambda each: each.objective.value).pose
            best = self._bounded(proof, scenario, pose, proof.stats)
            if proof.status is not Status.CERTIFIED:
                break
        return best

    def _bounded(self, proof: Result, scenario: Scenario, pose: Pose, stats: Stats) -> Result:
        """Evaluate a pose, with the bound of a proof that holds for it."""
        result = evaluated(proof, scenario, pose, proof.objective.upper_bound)
        reason = "" if proof.objective.upper_bound is None else proof.reason or AS_NEEDED
        status, reason = status_of(result.objective, self.gap, reason)
        return replace(result, scheme=Scheme.OPTIMUM, status=status, reason=reason, stats=stats)

    def _improves_bound(self, result: Result) -> bool:
        """Prove more of the omnidirectional vehicle, if that may tell whether a result suffices."""
        whole = self.whole
        target, gap = self.share * whole.objective.value, self.options.get("gap") or LEAST_GAP
        if whole.status is not Status.CERTIFIED or gap <= LEAST_GAP or result.objective.value < target:
            return False
        self.options["gap"] = max(0.1 * gap, LEAST_GAP)
        self.whole = solve(whole.scenario, **self.options)
        return True

    def _with(self, airframe: Airframe) -> Scenario:
        return self.scenario.model_copy(update={"airframe": airframe})
