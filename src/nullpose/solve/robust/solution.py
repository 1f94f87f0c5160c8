"""What a robust solve returns: the pose that guarantees most, beside the nominal one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics import Pose
from nullpose.physics.error_case import ErrorCase
from nullpose.scenario import Scenario
from nullpose.solve.proof import INTERRUPT
from nullpose.solve.rigour import Rigour
from nullpose.solve.robust.guarantee import Guarantee
from nullpose.solve.robust.wording import in_words
from nullpose.solve.solution import Stats, Status

__all__ = ["GuardedPose", "RobustSolution"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GuardedPose:
    """A pose, what it gives where all is as stated, and what it guarantees.

    Args:
        scenario: what was solved.
        pose: position and attitude.
        guarantee: the proof of what it guarantees, ratio by ratio.
    """

    scenario: Scenario
    pose: Pose
    guarantee: Guarantee

    @property
    def nominal(self) -> float:
        """The objective without errors: a power ratio, or bits/s/Hz."""
        return Quantity.of(self.scenario).of_ratio(self.guarantee.nominal)

    @property
    def guaranteed(self) -> float:
        """A proved lower bound on the objective over all errors together."""
        return Quantity.of(self.scenario).of_ratio(self.guarantee.lower)

    @property
    def worst(self) -> float:
        """The objective in the worst case found; the smallest over all errors lies between the two."""
        return Quantity.of(self.scenario).of_ratio(self.guarantee.worst)

    @property
    def binding_node(self) -> str:
        """Name of the node that is worst off in the worst case found."""
        return self.guarantee.binding.node

    @property
    def worst_case(self) -> str:
        """The worst error case found, in words."""
        return in_words(self.scenario, self.guarantee.axis, self.guarantee.case)

    def to_dict(self) -> dict[str, Any]:
        """Return the pose and its values as plain data for JSON."""
        return {
            "position_m": [float(x) for x in self.pose.position_m],
            "roll_rad": self.pose.roll_rad,
            "pitch_rad": self.pose.pitch_rad,
            "yaw_rad": self.pose.yaw_rad,
            "antenna_axis": [float(x) for x in self.pose.antenna_axis],
            "nominal": self.nominal,
            "guaranteed": self.guaranteed,
            "worst_found": self.worst,
            "binding_node": self.binding_node,
            "worst_case": self.worst_case,
            "worst_case_errors": _plain(self.guarantee.case),
            "nodes": [
                {
                    "node": one.node,
                    **({"eavesdropper": one.eavesdropper} if one.eavesdropper else {}),
                    "nominal": one.nominal,
                    "guaranteed": one.lower,
                    "worst_found": one.worst,
                }
                for one in self.guarantee.ratios
            ],
        }


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RobustSolution:
    """The pose with the largest guaranteed objective, and how good any could be.

    Args:
        scenario: what was solved.
        status: how the solve ended.
        robust: the pose that guarantees most.
        nominal: the pose that is best where all is as stated.
        upper_bound: no pose guarantees more than this; None if nothing is proved about others.
        reason: why the gap was not reached, or not aimed at; empty if it was.
        cases: error cases that the bound rests on.
        stats: time and counts.
        provenance: versions, seed and settings that produced it.
    """

    scenario: Scenario
    status: Status
    robust: GuardedPose
    nominal: GuardedPose
    upper_bound: float | None
    reason: str
    cases: int
    stats: Stats
    provenance: Mapping[str, Any]

    def __post_init__(self) -> None:
        object.__setattr__(self, "provenance", MappingProxyType(dict(self.provenance)))

    @property
    def relative_gap(self) -> float | None:
        """``(upper_bound - guaranteed) / guaranteed``, a rate below 1e-3 bits/s/Hz counting as so much.

        Infinite where no power ratio is guaranteed; None without a bound.
        """
        if self.upper_bound is None:
            return None
        return Quantity.of(self.scenario).gap(self.robust.guaranteed, self.upper_bound)

    @property
    def rigour(self) -> Rigour:
        """How sure the guarantee and the bound are: robust poses have no certificates."""
        return Rigour.FLOATING_POINT

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended its search or its proof."""
        return self.reason == INTERRUPT

    @property
    def gain(self) -> float:
        """How many times as much the robust pose guarantees as the nominal one; infinite over nothing."""
        guaranteed = self.nominal.guaranteed
        return self.robust.guaranteed / guaranteed if guaranteed > 0.0 else math.inf

    def to_dict(self) -> dict[str, Any]:
        """Return the solution as plain data for JSON; a number that JSON cannot hold becomes None."""
        gap = self.relative_gap
        return {
            "scenario": self.scenario.to_dict(),
            "objective": self.scenario.objective,
            "status": self.status.value,
            "rigour": self.rigour.value,
            "reason": self.reason,
            "robust": self.robust.to_dict(),
            "nominal": self.nominal.to_dict(),
            "upper_bound": self.upper_bound,
            "relative_gap": gap if gap is not None and math.isfinite(gap) else None,
            "error_cases": self.cases,
            "stats": {
                "wall_s": self.stats.wall_s,
                "starts": self.stats.starts,
                "evaluations": self.stats.evaluations,
                "boxes": self.stats.boxes,
            },
            "provenance": dict(self.provenance),
        }


def _plain(case: ErrorCase) -> dict[str, Any]:
    return {
        "position_offset_m": case.position_offset_m.tolist(),
        "rotation_world": case.rotation_world.tolist(),
        "axis_error_deg": float(np.degrees(case.rotation_rad)),
        "jammer_offsets_m": case.jammer_offsets_m.tolist(),
        "eavesdropper_offsets_m": case.eavesdropper_offsets_m.tolist(),
    }
