"""What a pose gives each node of a scenario."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.physics.decibel import to_db
from nullpose.physics.pose import Pose
from nullpose.physics.sinr import sinr
from nullpose.scenario import Scenario

__all__ = ["Link", "evaluate", "min_sinr"]


@dataclass(frozen=True, slots=True)
class Link:
    """One node's link to the drone.

    Args:
        node: the node's name.
        sinr: signal to interference-plus-noise ratio (paper eq. 2.1), a power ratio.
        sinr_db: the same in dB; minus infinity where the null points at the node.
    """

    node: str
    sinr: float
    sinr_db: float


def evaluate(scenario: Scenario, pose: Pose) -> tuple[Link, ...]:
    """Return every node's link at a pose, in the scenario's order (paper eqs. 1.1 to 2.1).

    Args:
        scenario: nodes, jammers and receiver.
        pose: where the drone is and how it is turned.
    """
    ratios = sinr(scenario, pose.position_m, pose.antenna_axis)
    ratios_db = to_db(ratios)
    return tuple(
        Link(node=name, sinr=float(ratio), sinr_db=float(ratio_db))
        for name, ratio, ratio_db in zip(scenario.node_names, ratios, ratios_db, strict=True)
    )


def min_sinr(scenario: Scenario, pose: Pose) -> float:
    """Return the smallest SINR over the nodes at a pose, the paper's objective (eq. 2.2).

    Args:
        scenario: nodes, jammers and receiver.
        pose: where the drone is and how it is turned.
    """
    return float(np.min(sinr(scenario, pose.position_m, pose.antenna_axis)))
