"""What a pose gives each node of a scenario."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import overload

import numpy as np

from nullpose.physics.decibel import to_db
from nullpose.physics.objective import margin
from nullpose.physics.pose import Pose
from nullpose.physics.poses import Poses
from nullpose.physics.secrecy import node_snr, secrecy_rate
from nullpose.physics.sinr import sinr
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario, require_scenario


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


@overload
def evaluate(scenario: Scenario, pose: Pose) -> tuple[Link, ...]: ...


@overload
def evaluate(scenario: Scenario, pose: Poses) -> dict[str, FloatArray]: ...


def evaluate(scenario: Scenario, pose: Pose | Poses) -> tuple[Link, ...] | dict[str, FloatArray]:
    """Return every node's link at a pose, in the scenario's order (paper eqs. 1.1 to 2.1).

    Of many poses the numbers of :class:`Link` as arrays, by name: ``evaluate(scenario, poses)["sinr_db"]``
    has a row for each pose and a column for each node.

    Args:
        scenario: nodes, jammers, eavesdroppers, receiver and transmitter.
        pose: where the drone is and how it is turned; or many such.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> pose = nullpose.Pose(position_m=[0.0, 25.0, 8.0], roll_rad=0.0, pitch_rad=0.0)
        >>> [(link.node, round(link.sinr_db, 3)) for link in nullpose.evaluate(scenario, pose)]
        [('S1', -4.084), ('S2', -4.084)]
    """
    require_scenario(scenario)
    if isinstance(pose, Poses):
        blocks = [_columns(scenario, *_ratios(scenario, some)) for some in pose.blocks()]
        return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    return links_of(scenario, *_ratios(scenario, pose))


def _ratios(scenario: Scenario, pose: Pose | Poses) -> tuple[FloatArray, FloatArray | None]:
    """Return every node's SINR, and its secrecy rate if that is what the scenario asks for."""
    at = (scenario, pose.position_m, pose.orientation(scenario.antenna_record))
    record = scenario.objective_record
    rates = secrecy_rate(*at) if record.quantity(scenario).is_rate else None
    return node_snr(*at) if record.transmits else sinr(*at), rates


def _columns(scenario: Scenario, ratios: FloatArray, rates: FloatArray | None) -> dict[str, FloatArray]:
    columns = {"sinr": ratios, "sinr_db": to_db(ratios)}
    if scenario.has_margins:
        margins = ratios / scenario.node_required_sinr
        columns |= {"margin": margins, "margin_db": to_db(margins)}
    return columns if rates is None else columns | {"secrecy_rate_bps_hz": rates}


def links_of(scenario: Scenario, ratios: FloatArray, rates: FloatArray | None = None) -> tuple[Link, ...]:
    """Return every node's link from its SINR, in the scenario's order.

    Args:
        scenario: the nodes.
        ratios: (n_nodes,) power ratios.
        rates: (n_nodes,) secrecy rates, bits/s/Hz, if the objective is one.
    """
    columns = _columns(scenario, ratios, rates)
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return tuple(
        Link(name, **dict(zip(columns, row, strict=True)))
        for name, row in zip(scenario.node_names, rows, strict=True)
    )


@overload
def min_sinr(scenario: Scenario, pose: Pose) -> float: ...


@overload
def min_sinr(scenario: Scenario, pose: Poses) -> FloatArray: ...


def min_sinr(scenario: Scenario, pose: Pose | Poses) -> float | FloatArray:
    """Return the smallest SINR over the nodes at a pose, the paper's objective (eq. 2.2).

    A million poses of a small scene take a quarter of a second.

    Args:
        scenario: nodes, jammers and receiver.
        pose: where the drone is and how it is turned; or many such, for an array of shape ``(n,)``.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> pose = nullpose.Pose(position_m=[0.0, 25.0, 8.0], roll_rad=0.0, pitch_rad=0.0)
        >>> round(nullpose.min_sinr(scenario, pose), 4)
        0.3905
        >>> poses = nullpose.Poses([[0.0, 25.0, 8.0], [-2.0, 24.0, 8.0]], roll_rad=0.0, pitch_rad=[0.0, -1.4])
        >>> nullpose.min_sinr(scenario, poses).round(4)
        array([0.3905, 0.9535])
    """
    return _least(sinr, scenario, pose)


@overload
def min_margin(scenario: Scenario, pose: Pose) -> float: ...


@overload
def min_margin(scenario: Scenario, pose: Poses) -> FloatArray: ...


def min_margin(scenario: Scenario, pose: Pose | Poses) -> float | FloatArray:
    """Return the smallest margin over the nodes at a pose: at least 1 where every requirement is met.

    Args:
        scenario: nodes, jammers and receiver.
        pose: where the drone is and how it is turned; or many such, for an array of shape ``(n,)``.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> required = ["nodes.S1.min_sinr_db=-3", "nodes.S2.min_sinr_db=-6"]
        >>> demanding = nullpose.apply_overrides(scenario, required)
        >>> pose = nullpose.Pose(position_m=[0.0, 25.0, 8.0], roll_rad=0.0, pitch_rad=0.0)
        >>> round(nullpose.min_margin(demanding, pose), 4)
        0.7791
    """
    return _least(margin, scenario, pose)


@overload
def min_secrecy_rate(scenario: Scenario, pose: Pose) -> float: ...


@overload
def min_secrecy_rate(scenario: Scenario, pose: Poses) -> FloatArray: ...


def min_secrecy_rate(scenario: Scenario, pose: Pose | Poses) -> float | FloatArray:
    """Return the smallest secrecy rate over the nodes at a pose, bits/s/Hz, at least 0.

    Args:
        scenario: nodes, eavesdroppers, receiver and transmitter.
        pose: where the drone is and how it is turned; or many such, for an array of shape ``(n,)``.

    Raises:
        ValueError: the scenario has no transmitter.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/eavesdropper.toml")
        >>> pose = nullpose.Pose(position_m=[0.0, 25.0, 8.0], roll_rad=0.0, pitch_rad=-1.4)
        >>> round(nullpose.min_secrecy_rate(scenario, pose), 4)
        0.5985
    """
    return _least(secrecy_rate, scenario, pose)


def _least(
    quantity: Callable[[Scenario, FloatArray, FloatArray], FloatArray], scenario: Scenario, pose: Pose | Poses
) -> float | FloatArray:
    """Return the smallest of a quantity over the nodes, at a pose or at each of many."""
    require_scenario(scenario)
    if isinstance(pose, Pose):
        return float(np.min(quantity(scenario, pose.position_m, pose.orientation(scenario.antenna_record))))
    antenna = scenario.antenna_record
    blocks = (quantity(scenario, some.position_m, some.orientation(antenna)) for some in pose.blocks())
    return np.concatenate([np.min(block, axis=-1) for block in blocks])
