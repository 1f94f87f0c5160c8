"""What a scenario amounts to before anything is solved."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nullpose.physics import to_db
from nullpose.physics.types import FloatArray
from nullpose.scenario import Jammer, Node, Scenario

__all__ = ["PointSummary", "ScenarioSummary", "summarise"]


@dataclass(frozen=True, slots=True)
class PointSummary:
    """A node or a jammer, and the most that the drone can receive from it.

    Args:
        name: its name.
        position_m: where it is, metres.
        power_w: what it transmits, watts.
        power_dbm: the same, dBm.
        nearest_m: how close to it the drone may come, metres.
        best_ratio_db: received power over noise there, the dipole broadside to it, dB.
    """

    name: str
    position_m: tuple[float, float, float]
    power_w: float
    power_dbm: float
    nearest_m: float
    best_ratio_db: float

    def to_dict(self) -> dict[str, object]:
        """Return the summary as plain data."""
        return {
            "name": self.name,
            "position_m": list(self.position_m),
            "power_w": self.power_w,
            "power_dbm": self.power_dbm,
            "nearest_m": self.nearest_m,
            "best_power_to_noise_db": self.best_ratio_db,
        }


@dataclass(frozen=True, slots=True)
class ScenarioSummary:
    """A scenario's numbers, derived ones included.

    Args:
        scenario: what is summarised.
        nodes: one entry per node.
        jammers: one entry per jammer.
        noise_w: the receiver's noise power, watts.
        noise_dbm: the same, dBm.
        reference_gain_db: path gain at 1 m, dB.
    """

    scenario: Scenario
    nodes: tuple[PointSummary, ...]
    jammers: tuple[PointSummary, ...]
    noise_w: float
    noise_dbm: float
    reference_gain_db: float

    def to_dict(self) -> dict[str, object]:
        """Return the summary as plain data."""
        return {
            "scenario": self.scenario.to_dict(),
            "nodes": [node.to_dict() for node in self.nodes],
            "jammers": [jammer.to_dict() for jammer in self.jammers],
            "noise_w": self.noise_w,
            "noise_dbm": self.noise_dbm,
            "reference_gain_db": self.reference_gain_db,
        }


def summarise(scenario: Scenario) -> ScenarioSummary:
    """Return a scenario's numbers: powers in both units, and the most that each link can carry.

    The best a link can do is the drone as close as the airspace and the keep-out allow, the dipole broadside:
    ``g0 P_i / (d^2 sigma^2)``, paper eq. 2.1 without jamming and with G = 1.

    Args:
        scenario: nodes, jammers, receiver and airspace.
    """
    noise_w = scenario.receiver.noise_power_w
    return ScenarioSummary(
        scenario=scenario,
        nodes=tuple(_point(scenario, node) for node in scenario.nodes),
        jammers=tuple(_point(scenario, jammer) for jammer in scenario.jammers),
        noise_w=noise_w,
        noise_dbm=_dbm(noise_w),
        reference_gain_db=float(to_db(scenario.receiver.reference_gain)),
    )


def _dbm(power_w: float) -> float:
    return float(to_db(power_w)) + 30.0


def _point(scenario: Scenario, point: Node | Jammer) -> PointSummary:
    nearest_m = _nearest_m(scenario, np.asarray(point.position_m))
    ratio = scenario.receiver.reference_gain * point.transmit_power_w / nearest_m**2
    return PointSummary(
        name=point.name,
        position_m=point.position_m,
        power_w=point.transmit_power_w,
        power_dbm=_dbm(point.transmit_power_w),
        nearest_m=nearest_m,
        best_ratio_db=float(to_db(ratio / scenario.receiver.noise_power_w)),
    )


def _nearest_m(scenario: Scenario, position_m: FloatArray) -> float:
    airspace = scenario.airspace
    free = (-math.inf, math.inf)
    sides = np.array([airspace.x_m or free, airspace.y_m or free, airspace.altitude_m])
    inside = np.clip(position_m, sides[:, 0], sides[:, 1])
    return max(float(np.linalg.norm(inside - position_m)), airspace.keep_out_m)
