"""What a pose gives each node of a scenario."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import overload

import numpy as np

from nullpose.errors import checked
from nullpose.physics.decibel import to_db
from nullpose.physics.pose import Pose, Poses
from nullpose.physics.reception import Reception
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


@dataclass(frozen=True, slots=True)
class Link:
    """One node's link with the drone.

    Args:
        node: the name of the node, or of a relay's destination.
        values: its numbers by name: ``sinr``, and what else the scenario's objective evaluates. A power ratio
            stands there in dB as well, ``sinr_db``; minus infinity where the null points at the node.
    """

    node: str
    values: Mapping[str, float] = field(hash=False)

    @property
    def sinr(self) -> float:
        """Signal to interference-plus-noise ratio, a power ratio.

        At the drone (paper eq. 2.1), or at the node or the destination where the drone transmits to it.
        """
        return self.values["sinr"]

    @property
    def sinr_db(self) -> float:
        """The same in dB."""
        return self.values["sinr_db"]

    @property
    def margin(self) -> float | None:
        """The SINR over the node's weight or required SINR; None where no node of the scenario states one."""
        return self.values.get("margin")

    @property
    def margin_db(self) -> float | None:
        """The same in dB."""
        return self.values.get("margin_db")

    @property
    def secrecy_rate_bps_hz(self) -> float | None:
        """The secrecy rate, bits/s/Hz; None with any other objective."""
        return self.values.get("secrecy_rate_bps_hz")

    def to_dict(self) -> dict[str, object]:
        """Return the link as plain data for JSON, minus infinity as None."""
        numbers = {name: None if value == -math.inf else value for name, value in self.values.items()}
        return {"node": self.node, **numbers}


@overload
def evaluate(scenario: Scenario, pose: Pose) -> tuple[Link, ...]: ...


@overload
def evaluate(scenario: Scenario, pose: Poses) -> dict[str, FloatArray]: ...


@checked
def evaluate(scenario: Scenario, pose: Pose | Poses) -> tuple[Link, ...] | dict[str, FloatArray]:
    """Evaluate every node's link at a pose, in the scenario's order (paper eqs. 1.1 to 2.1).

    Of a relay, the destination's link is the last.

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
    evaluation = scenario.objective_record.evaluate
    if isinstance(pose, Pose):
        return links_of(scenario, evaluation(_reception(scenario, pose)))
    blocks = [with_decibels(evaluation(_reception(scenario, block))) for block in pose.blocks()]
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def links_of(scenario: Scenario, values: Mapping[str, FloatArray]) -> tuple[Link, ...]:
    """Make the link of every terminal from its numbers, in the scenario's order.

    Args:
        scenario: the nodes.
        values: arrays of shape (n_terminals,) by name, as an objective evaluates them.
    """
    columns = with_decibels(values)
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return tuple(
        Link(name, dict(zip(columns, row, strict=True)))
        for name, row in zip(scenario.terminal_names, rows, strict=True)
    )


def objective_of_links(scenario: Scenario, links: Sequence[Link]) -> float:
    """Evaluate the scenario's objective from every node's link, in the scenario's order.

    Args:
        scenario: the nodes, and what is maximised.
        links: as ``evaluate`` makes them.
    """
    values = {name: np.array([link.values[name] for link in links]) for name in links[0].values}
    return float(scenario.objective_record.value(scenario, values))


def with_decibels(values: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Put the decibels of each power ratio, whose name has no unit, beside it."""
    columns = {}
    for name, column in values.items():
        columns[name] = column
        if not name.endswith("_bps_hz"):
            columns[f"{name}_db"] = to_db(column)
    return columns


@overload
def min_sinr(scenario: Scenario, pose: Pose) -> float: ...


@overload
def min_sinr(scenario: Scenario, pose: Poses) -> FloatArray: ...


@checked
def min_sinr(scenario: Scenario, pose: Pose | Poses) -> float | FloatArray:
    """Evaluate the smallest SINR over the nodes at a pose, the paper's objective (eq. 2.2).

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
    return _smallest(lambda received: received.sinr, scenario, pose)


@overload
def min_margin(scenario: Scenario, pose: Pose) -> float: ...


@overload
def min_margin(scenario: Scenario, pose: Poses) -> FloatArray: ...


@checked
def min_margin(scenario: Scenario, pose: Pose | Poses) -> float | FloatArray:
    """Evaluate the smallest margin over the nodes at a pose: at least 1 where every requirement is met.

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
    return _smallest(lambda received: received.sinr / scenario.node_required_sinr, scenario, pose)


@overload
def min_secrecy_rate(scenario: Scenario, pose: Pose) -> float: ...


@overload
def min_secrecy_rate(scenario: Scenario, pose: Poses) -> FloatArray: ...


@checked
def min_secrecy_rate(scenario: Scenario, pose: Pose | Poses) -> float | FloatArray:
    """Evaluate the smallest secrecy rate over the nodes at a pose, bits/s/Hz, at least 0.

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
    return _smallest(lambda received: received.secrecy_rate, scenario, pose)


def _smallest(
    of_nodes: Callable[[Reception], FloatArray], scenario: Scenario, pose: Pose | Poses
) -> float | FloatArray:
    """Evaluate the smallest number over the nodes, at a pose or at each of many."""
    if isinstance(pose, Pose):
        return float(np.min(of_nodes(_reception(scenario, pose))))
    blocks = (of_nodes(_reception(scenario, block)) for block in pose.blocks())
    return np.concatenate([np.min(block, axis=-1) for block in blocks])


def _reception(scenario: Scenario, pose: Pose | Poses) -> Reception:
    return Reception(scenario, pose.position_m, pose.orientation(scenario.antenna_record))
