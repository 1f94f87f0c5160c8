"""What a robust solve returns: the pose that guarantees most, beside the nominal one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nullpose.files import PlainTable
from nullpose.objectives import FloatArray, Quantity
from nullpose.physics import Pose, evaluate, objective_of_links, pose_frames
from nullpose.physics.error_case import ErrorCase
from nullpose.problem.robust import BindingCase
from nullpose.scenario import Scenario

_LEAST_RAD = 1e-9
_LEAST_M = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RatioGuarantee:
    """What a pose guarantees to one node.

    Args:
        node: the node's name.
        eavesdropper: the eavesdropper's name, or empty.
        nominal: the ratio without errors.
        lower: no error makes it smaller than this; 0 if that was not asked for.
        worst: the ratio in the worst case found, by the plain physics; between the two the smallest lies.
        case: that case.
        ratio: index of the ratio in the nominal family.
        cells: cells of errors examined.
    """

    node: str
    eavesdropper: str
    nominal: float
    lower: float
    worst: float
    case: ErrorCase
    ratio: int
    cells: int

    @property
    def binding(self) -> BindingCase:
        """The case and its ratio, for the finite family."""
        return BindingCase(self.ratio, self.case)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Guarantee:
    """What a pose guarantees: the smallest ratio over the nodes and over all errors together.

    A ratio is a node's margin (its SINR where it states no weight and no requirement), or for
    a secrecy rate ``(1 + SNR_k) / (1 + SNR_e)``, two to the power of the secrecy rate.

    Args:
        position_m: (3,) the commanded position.
        axis: (3,) the commanded unit antenna axis.
        ratios: one for every node, or for every node and eavesdropper.
        cells: cells of errors examined.
    """

    position_m: FloatArray
    axis: FloatArray
    ratios: tuple[RatioGuarantee, ...]
    cells: int

    @property
    def nominal(self) -> float:
        """The smallest ratio without errors."""
        return min(ratio.nominal for ratio in self.ratios)

    @property
    def lower(self) -> float:
        """A proved lower bound on the smallest ratio over all errors."""
        return min(ratio.lower for ratio in self.ratios)

    @property
    def worst(self) -> float:
        """The smallest ratio in the worst cases found: an upper bound on the same number."""
        return self.binding.worst

    @property
    def binding(self) -> RatioGuarantee:
        """The ratio that is smallest in its worst case."""
        return min(self.ratios, key=lambda ratio: ratio.worst)

    @property
    def case(self) -> ErrorCase:
        """The worst error case found."""
        return self.binding.case


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
        return objective_of_links(self.scenario, evaluate(self.scenario, self.pose))

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

    def to_dict(self) -> PlainTable:
        """Write the pose and its values as plain data for JSON."""
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
                    "node": ratio.node,
                    **({"eavesdropper": ratio.eavesdropper} if ratio.eavesdropper else {}),
                    "nominal": ratio.nominal,
                    "guaranteed": ratio.lower,
                    "worst_found": ratio.worst,
                }
                for ratio in self.guarantee.ratios
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

    def to_dict(self, objective: PlainTable) -> PlainTable:
        """Write both poses as plain data for JSON, over the keys of a result.

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


def _plain(case: ErrorCase) -> PlainTable:
    return {
        "position_offset_m": case.position_offset_m.tolist(),
        "rotation_world": case.rotation_world.tolist(),
        "axis_error_deg": float(np.degrees(case.rotation_rad)),
        "jammer_offsets_m": case.jammer_offsets_m.tolist(),
        "eavesdropper_offsets_m": case.eavesdropper_offsets_m.tolist(),
    }


def in_words(scenario: Scenario, axis: FloatArray, case: ErrorCase) -> str:
    """Describe an error case as a phrase: what is off by how much, and in which direction.

    Args:
        scenario: has the names of jammers and eavesdroppers.
        axis: (3,) the commanded unit antenna axis; the phrase speaks of its end that points up.
        case: the error case.
    """
    up = axis if axis[2] >= 0.0 else -axis
    parts = []
    if case.rotation_rad > _LEAST_RAD:
        parts.append(
            f"axis {math.degrees(case.rotation_rad):.3g} deg off, {_direction(case.rotation_world @ up - up)}"
        )
    moved = [("drone", case.position_offset_m)]
    moved += zip(scenario.jammer_names, case.jammer_offsets_m, strict=True)
    moved += zip(scenario.eavesdropper_names, case.eavesdropper_offsets_m, strict=True)
    parts += [
        f"{name} {distance_m:.3g} m off, {_direction(offset_m)}"
        for name, offset_m in moved
        if (distance_m := float(np.linalg.norm(offset_m))) > _LEAST_M
    ]
    return "; ".join(parts) if parts else "everything as stated"


def _direction(vector: FloatArray) -> str:
    """Describe a direction by its azimuth, from east towards north, and its elevation."""
    east, north, up = vector
    azimuth_deg = math.degrees(math.atan2(north, east)) % 360.0
    elevation_deg = math.degrees(math.atan2(up, math.hypot(east, north)))
    return f"towards azimuth {round(azimuth_deg) % 360:d} deg, elevation {round(elevation_deg):d} deg"
