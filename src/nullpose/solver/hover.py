"""The pose to hold for a scene in motion: instants are added where they bind, until few speak for all."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from nullpose.errors import UsageError, require_usage
from nullpose.files import PlainTable
from nullpose.objectives import FloatArray, Quantity
from nullpose.physics import Pose, evaluate, objective_of_links
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import join_instants, still_scenes
from nullpose.scenario import Scenario
from nullpose.scenario.motion import time_of
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.compiling import limit_clock, precompile
from nullpose.solver.options import SolveOptions
from nullpose.solver.proof import Proof
from nullpose.solver.result import BoundedPose, Stats
from nullpose.solver.rigour import Rigour
from nullpose.solver.solve_and_prove import Outcome, solve_and_prove

HOVER_GAP = 1e-4
"""The relative gap asked for unless another is."""
_SHARE = 1.0 / 3.0  # of the gap, for the distance between the chosen instants and all
_MOST_INSTANTS = 10_000
_LEAST_GAP, _LEAST_S = 1e-8, 1e-3  # of a proof


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HoverDetails:
    """What a pose gives at every instant of a scene in motion.

    Args:
        scene: the scene in motion.
        times_s: (t,) the instants.
        values: (t,) the objective at each: power ratios, or bits/s/Hz.
        instants: those that the proof is about, counted from 0; no pose exceeds its bound at all of them.
    """

    scene: Scenario
    times_s: FloatArray
    values: FloatArray
    instants: tuple[int, ...]

    @property
    def label(self) -> str:
        """The name of the case for tables."""
        return "Hover"

    @property
    def worst_s(self) -> float:
        """The instant at which the value is smallest."""
        return float(self.times_s[np.argmin(self.values)])

    def to_dict(self, objective: PlainTable) -> PlainTable:
        """Write plain data for JSON."""
        values = {"time_s": self.times_s.tolist(), "value": self.values.tolist()}
        return {"hover": {"worst_s": self.worst_s, "binding_instants": len(self.instants), **values}}


def solve_hover(scenario: Scenario, limits: SolveOptions) -> tuple[BoundedPose, Scenario]:
    """Find the pose whose smallest value over all instants is largest; return the scene where that is, too.

    Some instants are solved, the one at which the pose found is worst joins them, and again. No pose has more
    at all instants than the best has at some, so a proof for these bounds it.

    Args:
        scenario: in motion.
        limits: its options.

    Raises:
        UsageError: nothing moves, or the antenna, the objective or the channels are not for a hover.
        SolveError: no pose reaches every node at every instant.
    """
    hover = _Hover(scenario, limits)
    try:
        hover.search()
    except KeyboardInterrupt:
        if hover.best is None:
            raise
        hover.reason = INTERRUPT
    return hover.found()


class _Hover:
    """The exchange between the instants that are chosen and the pose that is best for them."""

    def __init__(self, scenario: Scenario, limits: SolveOptions) -> None:
        times_s = time_of(scenario, "hover: asked for").instants_s
        require_usage(
            len(times_s) <= _MOST_INSTANTS,
            f"time: given {len(times_s):,} instants for a hover, allowed: {_MOST_INSTANTS:,}; raise step_s",
        )
        self.scenario, self.times_s, self.limits = scenario, times_s, limits
        self.scenes = still_scenes(scenario)
        first = self.scenes[0]
        if first.array is not None or not first.antenna_record.is_quadratic or first.has_custom_channels:
            raise UsageError(
                "hover: given an array, an antenna that is no dipole, or a channel in Python; allowed: a "
                "dipole, and the channels that a file can state"
            )
        self.families = [build_family(scene, any_channel=True) for scene in self.scenes]
        self.field, self.quantity = AxisField.within(*first.axis_band), Quantity.of(first)
        self.chosen: list[int] = [0]
        self.best: tuple[float, FloatArray, FloatArray] | None = None  # smallest ratio, position and axis
        self.bound, self.reason = math.inf, ""
        self.instants: tuple[int, ...] = ()  # those of the proofs of the bound
        self.proofs: tuple[Proof, ...] = ()
        self.starts = self.evaluations = self.boxes = 0

    def search(self) -> None:
        """Add instants until the chosen ones promise little more than the best pose has at all."""
        if self.limits.certify:
            precompile()  # compiling must not count against the time limit
        deadline, gap = limit_clock() + self.limits.time_limit_s, 0.0
        while True:
            left = replace(
                self.limits,
                gap=max(_LEAST_GAP, gap) if gap else self.limits.gap,
                certify=gap > 0.0,
                time_limit_s=max(_LEAST_S, deadline - limit_clock()),
                node_limit=max(1, self.limits.node_limit - self.boxes),
            )
            outcome = solve_and_prove(join_instants(self.families, self.chosen), [self.field], left)
            worst, self.reason = self._take(outcome), outcome.reason
            reached = self.quantity.of_ratio(math.exp(outcome.incumbent.log_value))  # no rate below zero
            promised = self.quantity.to_ratio(reached)
            is_over = bool(self.reason) or limit_clock() > deadline
            if promised > self._level(_SHARE) and worst not in self.chosen and not is_over:
                self.chosen.append(worst)
            elif gap > 0.0 or not self.limits.certify:
                return
            else:  # what is left of the gap beyond the best pose
                share = (self._level(1.0) / promised - 1.0) / self.limits.ratio_gap(promised)
                gap = self.limits.target * max(share, _LEAST_GAP)

    def _level(self, share: float) -> float:
        """Raise the smallest ratio of the best pose by a share of the gap."""
        assert self.best is not None
        return self.best[0] * (1.0 + share * self.limits.ratio_gap(self.best[0]))

    def _take(self, outcome: Outcome) -> int:
        """Count an outcome, remember its pose if it is the best so far; return its worst instant."""
        found = outcome.incumbent
        self.starts, self.evaluations = self.starts + found.starts, self.evaluations + found.evaluations
        self.boxes += outcome.nodes
        if outcome.upper_bound is not None and outcome.upper_bound < self.bound:
            self.bound, self.proofs = outcome.upper_bound, outcome.proofs
            self.instants = tuple(self.chosen)
        ratios = self.quantity.to_ratio(self._values(found.position_m, found.axis))
        if self.best is None or np.min(ratios) > self.best[0]:
            self.best = float(np.min(ratios)), found.position_m.copy(), found.axis.copy()
        return int(np.argmin(ratios))

    def _values(self, position_m: FloatArray, axis: FloatArray) -> FloatArray:
        """Evaluate the objective of a pose at every instant by the physics."""
        pose = Pose.of_airframe(self.scenes[0], position_m, axis)
        return np.array([objective_of_links(scene, evaluate(scene, pose)) for scene in self.scenes])

    def found(self) -> tuple[BoundedPose, Scenario]:
        """Return the best pose with what is proved, and the scene of the instant at which it is worst."""
        assert self.best is not None
        values = self._values(*self.best[1:])
        details = HoverDetails(
            scene=self.scenario,
            times_s=self.times_s,
            values=values,
            instants=self.instants or tuple(self.chosen),
        )
        worst = self.scenes[int(np.argmin(values))]
        pose = Pose.of_airframe(worst, *self.best[1:])
        count, last_s = len(self.times_s), self.times_s[-1]
        return BoundedPose(
            scheme="hover",
            pose=pose,
            links=evaluate(worst, pose),
            value=float(np.min(values)),
            upper_bound=self.bound if self.limits.certify else None,
            reason=self.reason,
            settings=self.limits.settings,
            stats=Stats(starts=self.starts, evaluations=self.evaluations, boxes=self.boxes),
            rigour=Rigour.VERIFIABLE if self.proofs and worst.prisms is None else None,
            proofs=self.proofs,
            note=f"one pose for {count} instants from 0 to {last_s:g} s; value, links and bound are of the "
            f"smallest value over all, that at {details.worst_s:g} s",
            details=details,
        ), worst
