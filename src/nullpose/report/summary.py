"""What a scenario amounts to before anything is solved."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nullpose.physics import to_db
from nullpose.physics.types import FloatArray
from nullpose.scenario import Eavesdropper, Jammer, Node, Scenario

__all__ = ["PointSummary", "ScenarioSummary", "summarise"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PointSummary:
    """A node, a jammer or an eavesdropper, and the most that its link with the drone can carry.

    Args:
        name: its name.
        position_m: where it is, metres.
        power_w: what it transmits, watts; None if it states nothing.
        nearest_m: how close to it the drone may come, zones and fence not counted, metres.
        best_ratio_db: power over noise there, the dipole broadside, dB: at the drone, or at the point itself
            where the drone transmits.
        noise_w: noise of its own receiver with any jamming there, watts; None where the drone receives.
        uncertainty_m: radius of the ball, or the semi-axes of the ellipsoid, that it may be anywhere in.
    """

    name: str
    position_m: tuple[float, float, float]
    power_w: float | None
    nearest_m: float
    best_ratio_db: float
    noise_w: float | None = None
    uncertainty_m: float | tuple[float, float, float] | None = None

    @property
    def power_dbm(self) -> float | None:
        """What it transmits, dBm; None if it states nothing."""
        return None if self.power_w is None else _dbm(self.power_w)

    @property
    def noise_dbm(self) -> float | None:
        """Noise of its own receiver with any jamming there, dBm; None where the drone receives."""
        return None if self.noise_w is None else _dbm(self.noise_w)

    def to_dict(self) -> dict[str, object]:
        """Return the summary as plain data."""
        own = {} if self.noise_w is None else {"noise_w": self.noise_w, "noise_dbm": self.noise_dbm}
        return {
            "name": self.name,
            "position_m": list(self.position_m),
            "power_w": self.power_w,
            "power_dbm": self.power_dbm,
            "nearest_m": self.nearest_m,
            "best_power_to_noise_db": self.best_ratio_db,
            **own,
        }


@dataclass(frozen=True, slots=True)
class ScenarioSummary:
    """A scenario's numbers, derived ones included.

    Args:
        scenario: what is summarised.
        nodes: one entry per node.
        jammers: one entry per jammer.
        eavesdroppers: one entry per eavesdropper.
        noise_w: the receiver's noise power, watts.
        noise_dbm: the same, dBm.
        reference_gain_db: path gain at 1 m, dB.
    """

    scenario: Scenario
    nodes: tuple[PointSummary, ...]
    jammers: tuple[PointSummary, ...]
    eavesdroppers: tuple[PointSummary, ...]
    noise_w: float
    noise_dbm: float
    reference_gain_db: float

    @property
    def beyond_reach(self) -> tuple[str, ...]:
        """Names of the nodes that require more than their link carries at best."""
        return tuple(
            node.name
            for node, summary in zip(self.scenario.nodes, self.nodes, strict=True)
            if node.min_sinr_db is not None and node.min_sinr_db > summary.best_ratio_db
        )

    def to_dict(self) -> dict[str, object]:
        """Return the summary as plain data."""
        return {
            "scenario": self.scenario.to_dict(),
            "nodes": [node.to_dict() for node in self.nodes],
            "jammers": [jammer.to_dict() for jammer in self.jammers],
            "eavesdroppers": [eavesdropper.to_dict() for eavesdropper in self.eavesdroppers],
            "noise_w": self.noise_w,
            "noise_dbm": self.noise_dbm,
            "reference_gain_db": self.reference_gain_db,
        }


def summarise(scenario: Scenario) -> ScenarioSummary:
    """Return a scenario's numbers: powers in both units, and the most that each link can carry.

    The best a link can do is the drone as close as the airspace's box and the keep-out allow, the dipole
    broadside: ``g0 P / (d^2 sigma^2)``, paper eq. 2.1 without jamming and with G = 1.

    Args:
        scenario: nodes, jammers, eavesdroppers, receiver and airspace.
    """
    noise_w = scenario.receiver.noise_power_w
    own_noise_w: list[float | None] = [None] * len(scenario.nodes)
    if scenario.objective == "secrecy-rate":
        own_noise_w = [float(each) for each in scenario.node_noise_w]
    listeners = zip(scenario.eavesdroppers, scenario.eavesdropper_noise_w, strict=True)
    return ScenarioSummary(
        scenario=scenario,
        nodes=tuple(_point(scenario, *each) for each in zip(scenario.nodes, own_noise_w, strict=True)),
        jammers=tuple(_point(scenario, jammer, None) for jammer in scenario.jammers),
        eavesdroppers=tuple(_point(scenario, point, float(noise)) for point, noise in listeners),
        noise_w=noise_w,
        noise_dbm=_dbm(noise_w),
        reference_gain_db=float(to_db(scenario.receiver.reference_gain)),
    )


def _dbm(power_w: float) -> float:
    return float(to_db(power_w)) + 30.0


def _point(
    scenario: Scenario, point: Node | Jammer | Eavesdropper, own_noise_w: float | None
) -> PointSummary:
    """Return a point's summary; one with a noise of its own hears the drone, any other is heard by it."""
    nearest_m = _nearest_m(scenario, np.asarray(point.position_m))
    power_w = None if isinstance(point, Eavesdropper) else point.transmit_power_w or None
    sent_w, noise_w = power_w or 0.0, scenario.receiver.noise_power_w
    if own_noise_w is not None and scenario.transmitter is not None:
        sent_w, noise_w = scenario.transmitter.transmit_power_w, own_noise_w
    ratio = scenario.receiver.reference_gain * sent_w / nearest_m**2
    return PointSummary(
        name=point.name,
        position_m=point.position_m,
        power_w=power_w,
        nearest_m=nearest_m,
        best_ratio_db=float(to_db(ratio / noise_w)),
        noise_w=own_noise_w,
        uncertainty_m=None if isinstance(point, Node) else point.uncertainty_m,
    )


def _nearest_m(scenario: Scenario, position_m: FloatArray) -> float:
    airspace = scenario.airspace
    free = (-math.inf, math.inf)
    sides = np.array([airspace.x_m or free, airspace.y_m or free, airspace.altitude_m])
    inside = np.clip(position_m, sides[:, 0], sides[:, 1])
    return max(float(np.linalg.norm(inside - position_m)), airspace.keep_out_m)
