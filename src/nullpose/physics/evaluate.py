"""What a pose gives each node of a scenario."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from nullpose.physics.decibel import to_db
from nullpose.physics.objective import margin
from nullpose.physics.pose import Pose
from nullpose.physics.secrecy import node_snr, secrecy_rate
from nullpose.physics.sinr import sinr
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


@dataclass(frozen=True, slots=True)
class Link:
    """One node's link with the drone.

    Args:
        node: the node's name.
        sinr: signal to interference-plus-noise ratio, a power ratio: at the drone (paper eq. 2.1), or at the
            node where the scenario's objective is the secrecy rate.
        sinr_db: the same in dB; minus infinity where the null points at the node.
        margin: the SINR over the node's weight or required SINR, a power ratio; None where no node of the
            scenario states one.
        margin_db: the same in dB.
        secrecy_rate_bps_hz: the secrecy rate, bits/s/Hz; None with any other objective.
    """

    node: str
    sinr: float
    sinr_db: float
    margin: float | None = None
    margin_db: float | None = None
    secrecy_rate_bps_hz: float | None = None

    def to_dict(self) -> dict[str, object]:
        """Return the link as plain data for JSON: without what it has not, minus infinity as None."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        stated = {key: value for key, value in values.items() if value is not None}
        return {key: None if value == -math.inf else value for key, value in stated.items()}


def evaluate(scenario: Scenario, pose: Pose) -> tuple[Link, ...]:
    """Return every node's link at a pose, in the scenario's order (paper eqs. 1.1 to 2.1).

    Args:
        scenario: nodes, jammers, eavesdroppers, receiver and transmitter.
        pose: where the drone is and how it is turned.
    """
    at = (scenario, pose.position_m, pose.orientation(scenario.antenna_record))
    record = scenario.objective_record
    rates = secrecy_rate(*at) if record.quantity(scenario).is_rate else None
    return links_of(scenario, node_snr(*at) if record.transmits else sinr(*at), rates)


def links_of(scenario: Scenario, ratios: FloatArray, rates: FloatArray | None = None) -> tuple[Link, ...]:
    """Return every node's link from its SINR, in the scenario's order.

    Args:
        scenario: the nodes.
        ratios: (n_nodes,) power ratios.
        rates: (n_nodes,) secrecy rates, bits/s/Hz, if the objective is one.
    """
    columns = {"sinr": ratios, "sinr_db": to_db(ratios)}
    if scenario.has_margins:
        margins = ratios / scenario.node_required_sinr
        columns |= {"margin": margins, "margin_db": to_db(margins)}
    if rates is not None:
        columns["secrecy_rate_bps_hz"] = rates
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return tuple(
        Link(name, **dict(zip(columns, row, strict=True)))
        for name, row in zip(scenario.node_names, rows, strict=True)
    )


def min_sinr(scenario: Scenario, pose: Pose) -> float:
    """Return the smallest SINR over the nodes at a pose, the paper's objective (eq. 2.2).

    Args:
        scenario: nodes, jammers and receiver.
        pose: where the drone is and how it is turned.
    """
    return float(np.min(sinr(scenario, pose.position_m, pose.orientation(scenario.antenna_record))))


def min_margin(scenario: Scenario, pose: Pose) -> float:
    """Return the smallest margin over the nodes at a pose: at least 1 where every requirement is met.

    Args:
        scenario: nodes, jammers and receiver.
        pose: where the drone is and how it is turned.
    """
    return float(np.min(margin(scenario, pose.position_m, pose.orientation(scenario.antenna_record))))


def min_secrecy_rate(scenario: Scenario, pose: Pose) -> float:
    """Return the smallest secrecy rate over the nodes at a pose, bits/s/Hz, at least 0.

    Args:
        scenario: nodes, eavesdroppers, receiver and transmitter.
        pose: where the drone is and how it is turned.

    Raises:
        ValueError: the scenario has no transmitter.
    """
    return float(np.min(secrecy_rate(scenario, pose.position_m, pose.orientation(scenario.antenna_record))))
