"""What a robust solve returns: the pose that guarantees most, beside the nominal one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics import Pose, evaluate, pose_frames
from nullpose.physics.error_case import ErrorCase
from nullpose.scenario import Scenario
from nullpose.solver.robust.guarantee import Guarantee
from nullpose.solver.robust.wording import in_words


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
        return Quantity.of(self.scenario).least(evaluate(self.scenario, self.pose))

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
        """Name of the node with the smallest value in the worst case found."""
        return self.guarantee.binding.node

    @property
    def worst_case(self) -> str:
        """The worst error case found, in words."""
        return in_words(self.scenario, self.guarantee.axis, self.guarantee.case)

    def to_dict(self) -> dict[str, Any]:
        """Return the pose and its values as plain data for JSON."""
        return {
            **self.pose.to_dict(),
            "frames": pose_frames(self.scenario, self.pose).to_dict(),
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
class RobustDetails:
    """What the pose that guarantees most guarantees, beside the nominal one.

    Args:
        robust: the pose that guarantees most.
        nominal: the pose that is best where all is as stated.
        cases: error cases that the bound rests on.
    """

    robust: GuardedPose
    nominal: GuardedPose
    cases: int

    @property
    def label(self) -> str:
        """The name of the case for tables."""
        return "robust"

    @property
    def gain(self) -> float:
        """How many times as much the robust pose guarantees as the nominal one; infinite over nothing."""
        guaranteed = self.nominal.guaranteed
        return self.robust.guaranteed / guaranteed if guaranteed > 0.0 else math.inf

    def to_dict(self, objective: dict[str, Any]) -> dict[str, Any]:
        """Return both poses as plain data for JSON, over the keys of a result.

        Args:
            objective: what is guaranteed and the bound on it, as plain data.
        """
        return {
            "objective": self.robust.scenario.objective,
            "robust": self.robust.to_dict(),
            "nominal": self.nominal.to_dict(),
            "upper_bound": objective["upper_bound"],
            "relative_gap": objective["relative_gap"],
            "error_cases": self.cases,
        }


def _plain(case: ErrorCase) -> dict[str, Any]:
    return {
        "position_offset_m": case.position_offset_m.tolist(),
        "rotation_world": case.rotation_world.tolist(),
        "axis_error_deg": float(np.degrees(case.rotation_rad)),
        "jammer_offsets_m": case.jammer_offsets_m.tolist(),
        "eavesdropper_offsets_m": case.eavesdropper_offsets_m.tolist(),
    }
