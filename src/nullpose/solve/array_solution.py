"""What solving an array returns: the answer and its evidence."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, fields
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from nullpose.physics import Link, Pose, pose_frames
from nullpose.scenario import Scenario
from nullpose.solve.objective import Objective
from nullpose.solve.solution import Stats, Status

__all__ = ["ArraySolution", "ArrayStats", "Combining"]

Combining = Literal["digital", "analogue"]
"""Each node with its own weights, or one beam of phase shifters for all nodes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ArrayStats(Stats):
    """What the solve cost, and how far its searches agree.

    Args:
        searches: independent searches made.
        agreeing: those of them that ended at the best value, within 1e-4.
    """

    searches: int
    agreeing: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArraySolution:
    """Where an array hovers, how it is turned, how its elements are combined, and what that gives.

    Args:
        scenario: what was solved.
        combining: ``"digital"`` (each node has its own weights) or ``"analogue"`` (one beam for all).
        elements: number of dipoles.
        layout: ``"linear"`` or ``"circular"``.
        spacing_wavelengths: distance between neighbours, in wavelengths.
        status: ``certified``; or ``gap-not-reached``, as always where a shared beam falls short of digital
            combining, whose bound it has; or ``best-found`` without a proof.
        objective: the value at the pose, and the bound on it if there was a proof.
        pose: level: roll and pitch are zero.
        weights: what each element is multiplied by (its conjugate), of unit length: (n_nodes, K) digital,
            (K,) analogue; complex, read-only.
        links: every node's link, in the scenario's order.
        stats: time and counts.
        provenance: versions and seed.
        reason: what kept the gap from being reached; empty if nothing did.
    """

    scenario: Scenario
    combining: Combining
    elements: int
    layout: str
    spacing_wavelengths: float
    status: Status
    objective: Objective
    pose: Pose
    weights: NDArray[np.complex128]
    links: tuple[Link, ...]
    stats: ArrayStats
    provenance: Mapping[str, Any]
    reason: str = ""

    def __post_init__(self) -> None:
        weights = np.array(self.weights, dtype=complex)
        weights.flags.writeable = False
        object.__setattr__(self, "weights", weights)
        object.__setattr__(self, "provenance", MappingProxyType(dict(self.provenance)))

    def __reduce__(self) -> tuple[Callable[[dict[str, Any]], ArraySolution], tuple[dict[str, Any]]]:
        state = {one.name: getattr(self, one.name) for one in fields(self)}
        return _rebuilt, (state | {"provenance": dict(self.provenance)},)

    @property
    def scheme(self) -> str:
        """The name of the case: ``"array-digital"`` or ``"array-analogue"``."""
        return f"array-{self.combining}"

    @property
    def label(self) -> str:
        """The name of the case for tables, as in "array of 4, digital"."""
        return f"array of {self.elements}, {self.combining}"

    @property
    def position_m(self) -> NDArray[np.float64]:
        """Where the vehicle hovers, (3,), metres."""
        return self.pose.position_m

    @property
    def yaw_rad(self) -> float:
        """Its yaw, radians."""
        return self.pose.yaw_rad

    @property
    def phases_rad(self) -> NDArray[np.float64]:
        """The phases of the weights, shape as ``weights``, radians."""
        return np.asarray(np.angle(self.weights))

    @property
    def binding_node(self) -> str:
        """Name of the node with the smallest margin (the first, if several share it)."""
        return min(self.links, key=self.objective.quantity.at).node

    def to_dict(self) -> dict[str, Any]:
        """Return the solution as plain data for JSON; a weight is [real part, imaginary part]."""
        return {
            "scenario": self.scenario.to_dict(),
            "scheme": self.scheme,
            "array": {
                "elements": self.elements,
                "layout": self.layout,
                "spacing_wavelengths": self.spacing_wavelengths,
                "combining": self.combining,
                "weights": np.stack([self.weights.real, self.weights.imag], axis=-1).tolist(),
            },
            "status": self.status.value,
            "reason": self.reason,
            "rigour": self.objective.rigour.value,
            "objective": self.objective.to_dict(),
            "pose": {
                "position_m": [float(x) for x in self.pose.position_m],
                "roll_rad": self.pose.roll_rad,
                "pitch_rad": self.pose.pitch_rad,
                "yaw_rad": self.pose.yaw_rad,
                "frames": pose_frames(self.scenario, self.pose).to_dict(),
            },
            "links": [_link_dict(link) for link in self.links],
            "stats": asdict(self.stats),
            "provenance": dict(self.provenance),
        }


def _rebuilt(state: dict[str, Any]) -> ArraySolution:
    return ArraySolution(**state)


def _link_dict(link: Link) -> dict[str, Any]:
    """Return a link as plain data, without what does not apply."""
    stated = {key: value for key, value in asdict(link).items() if value is not None}
    return {key: _finite(value) if isinstance(value, float) else value for key, value in stated.items()}


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
