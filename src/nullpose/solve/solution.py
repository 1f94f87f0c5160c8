"""What a solve returns: the answer and its evidence."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from types import MappingProxyType
from typing import Any

from nullpose.physics import Link, Pose, pose_frames
from nullpose.scenario import Scenario
from nullpose.schemes import Scheme
from nullpose.solve.objective import Objective
from nullpose.solve.proof import INTERRUPT, Proof
from nullpose.solve.rigour import Rigour

__all__ = ["Objective", "Solution", "Stats", "Status"]


class Status(StrEnum):
    """How a solve ended."""

    CERTIFIED = "certified"
    GAP_NOT_REACHED = "gap-not-reached"
    BEST_FOUND = "best-found"

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return _MESSAGES[self]


_MESSAGES = {
    Status.CERTIFIED: "certified: no pose exceeds the bound, and the gap asked for is reached",
    Status.GAP_NOT_REACHED: "no pose exceeds the bound, but the gap asked for was not reached",
    Status.BEST_FOUND: "the best of many local optima; not proved to be the global one",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Stats:
    """What the solve cost.

    Args:
        wall_s: wall-clock time, seconds.
        starts: local searches run.
        evaluations: poses evaluated.
        boxes: boxes of positions examined by the proof; 0 without one.
    """

    wall_s: float
    starts: int
    evaluations: int
    boxes: int = 0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Solution:
    """A pose, what it gives, and how it was found.

    Args:
        scenario: what was solved.
        scheme: the case.
        status: how the solve ended.
        objective: the value at the pose and the bound on it.
        pose: position and attitude.
        links: every node's link at the pose (paper eq. 2.1), in the scenario's order.
        stats: time and counts.
        provenance: versions, seed and settings that produced it.
        note: a sentence on what the scheme did here, such as which jammer the null points at; may be empty.
        reason: what kept the gap from being reached, or the pose from being certified; empty if nothing did.
        null_jammer: the jammer that was asked to be nulled, if one was.
        proofs: what the branch and bound showed, for each axis field of the scheme.
    """

    scenario: Scenario
    scheme: Scheme
    status: Status
    objective: Objective
    pose: Pose
    links: tuple[Link, ...]
    stats: Stats
    provenance: Mapping[str, Any]
    note: str = ""
    reason: str = ""
    null_jammer: str | None = None
    proofs: tuple[Proof, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "provenance", MappingProxyType(dict(self.provenance)))

    def __reduce__(self) -> tuple[Callable[[dict[str, Any]], Solution], tuple[dict[str, Any]]]:
        state = {one.name: getattr(self, one.name) for one in fields(self)}
        return _rebuilt, (state | {"provenance": dict(self.provenance)},)

    @property
    def binding_node(self) -> str:
        """Name of the node that decides: least SINR, margin or rate (the first, if several share it)."""
        return min(self.links, key=self.objective.quantity.at).node

    @property
    def rigour(self) -> Rigour:
        """How sure the bound is."""
        return self.objective.rigour

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended its proof."""
        return self.reason == INTERRUPT

    def to_dict(self) -> dict[str, Any]:
        """Return the solution as plain data for JSON; a number that JSON cannot hold becomes None."""
        pose = self.pose
        return {
            "scenario": self.scenario.to_dict(),
            "scheme": self.scheme.value,
            "status": self.status.value,
            "reason": self.reason,
            "rigour": self.rigour.value,
            "objective": self.objective.to_dict(),
            "pose": {
                "position_m": [float(x) for x in pose.position_m],
                "roll_rad": pose.roll_rad,
                "pitch_rad": pose.pitch_rad,
                "yaw_rad": pose.yaw_rad,
                "tilt_rad": pose.tilt_rad,
                "mount_rad": pose.mount_rad,
                "antenna_axis": [float(x) for x in pose.antenna_axis],
                "frames": pose_frames(self.scenario, pose).to_dict(),
            },
            "links": [link.to_dict() for link in self.links],
            "binding_node": self.binding_node,
            "stats": {
                "wall_s": self.stats.wall_s,
                "starts": self.stats.starts,
                "evaluations": self.stats.evaluations,
                "boxes": self.stats.boxes,
            },
            "provenance": dict(self.provenance),
            "note": self.note,
        }


def _rebuilt(state: dict[str, Any]) -> Solution:
    return Solution(**state)
