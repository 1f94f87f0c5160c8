"""The paper's closed forms: zero interference (eqs. 3.1, 3.2) and maximum gain (eqs. 3.4, 3.5)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics import received_from_sources_w, sinr
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


def zero_interference_axis(position_m: ArrayLike, jammer_position_m: ArrayLike) -> FloatArray:
    """Return the axis that points the dipole's null at a jammer.

    ``u = (p_M - p) / |p_M - p|``; the sign ``b`` of eq. 3.1 is +1, the other being the same antenna.

    Source: paper eq. 3.1.

    Args:
        position_m: the drone's position, shape ``(..., 3)``, metres.
        jammer_position_m: the jammer's position, shape ``(3,)``, metres.

    Returns:
        Unit vectors, shape ``(..., 3)``.
    """
    to_jammer = np.asarray(jammer_position_m, dtype=float) - np.asarray(position_m, dtype=float)
    return np.asarray(to_jammer / np.linalg.norm(to_jammer, axis=-1, keepdims=True))


def zero_interference_sinr(scenario: Scenario, position_m: ArrayLike) -> FloatArray:
    """Evaluate every node's SINR with the null on the scenario's only jammer.

    ``Gamma_i = (1 - <d_i, d_M>^2) P_i / (|p_i - p|^2 sigma^2)``, with ``d`` the unit directions: the jammer's
    power is gone from it. An antenna whose null is not perfect lets some of it in, and the nodes more;
    antennas on the ground count as in :func:`link_gain`, channels as in :func:`received_power_w`.

    Source: paper eq. 3.2.

    Args:
        scenario: a scenario with exactly one jammer.
        position_m: the drone's position, shape ``(..., 3)``, metres.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.

    Raises:
        ValueError: the scenario has no jammer or several.
    """
    if len(scenario.jammers) != 1:
        raise ValueError(f"eq. 3.2 is for one jammer; this scenario has {len(scenario.jammers)}")
    p = np.asarray(position_m, dtype=float)
    received_w = received_from_sources_w(
        scenario, p, zero_interference_axis(p, scenario.jammer_positions_m[0])
    )
    if scenario.antenna_record.leak == 0.0:
        received_w[..., -1] = 0.0  # as it is but for rounding
    return np.asarray(received_w[..., :-1] / (received_w[..., -1:] + scenario.receiver.noise_power_w))


def direction_product(scenario: Scenario, position_m: FloatArray) -> FloatArray:
    """Evaluate the cross product of the unit directions to both nodes, as eq. 3.4 is printed.

    Args:
        scenario: a scenario with exactly two nodes.
        position_m: the drone's position, shape ``(..., 3)``, metres.

    Raises:
        ValueError: the scenario does not have two nodes.
    """
    if len(scenario.nodes) != 2:
        raise ValueError(f"eq. 3.4 is for two nodes; this scenario has {len(scenario.nodes)}")
    to_nodes = scenario.node_positions_m - position_m[..., None, :]
    directions = to_nodes / np.linalg.norm(to_nodes, axis=-1, keepdims=True)
    return np.asarray(np.cross(directions[..., 0, :], directions[..., 1, :]))


def maximum_gain_axis(scenario: Scenario, position_m: ArrayLike) -> FloatArray:
    """Return the unit axis broadside to both nodes.

    ``u = d_1 x d_2 / |d_1 x d_2|`` with ``d_i`` the unit directions to the nodes. The paper leaves out the
    normalisation, without which eq. 3.4 is no antenna axis.

    Source: paper eq. 3.4, corrected.

    Args:
        scenario: a scenario with exactly two nodes.
        position_m: the drone's position, shape ``(..., 3)``, metres, off the line through the nodes.

    Returns:
        Unit vectors, shape ``(..., 3)``.

    Raises:
        ValueError: the scenario does not have two nodes.
    """
    product = direction_product(scenario, np.asarray(position_m, dtype=float))
    return np.asarray(product / np.linalg.norm(product, axis=-1, keepdims=True))


def maximum_gain_sinr(scenario: Scenario, position_m: ArrayLike) -> FloatArray:
    """Evaluate both nodes' SINR with the dipole broadside to both: eq. 2.1 with the axis of eq. 3.4.

    Source: paper eq. 3.5, with the axis normalised.

    Args:
        scenario: a scenario with exactly two nodes.
        position_m: the drone's position, shape ``(..., 3)``, metres, off the line through the nodes.

    Returns:
        Array of shape ``(..., 2)``, power ratios.

    Raises:
        ValueError: the scenario does not have two nodes.
    """
    return sinr(scenario, position_m, maximum_gain_axis(scenario, position_m))
