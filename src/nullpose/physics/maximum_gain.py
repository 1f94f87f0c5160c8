"""The maximum-gain pose for two nodes: the dipole broadside to both (paper eqs. 3.4 and 3.5)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.sinr import sinr
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


def _direction_product(scenario: Scenario, position_m: FloatArray) -> FloatArray:
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
    product = _direction_product(scenario, np.asarray(position_m, dtype=float))
    return np.asarray(product / np.linalg.norm(product, axis=-1, keepdims=True))


def maximum_gain_sinr(scenario: Scenario, position_m: ArrayLike) -> FloatArray:
    """Return both nodes' SINR with the dipole broadside to both: eq. 2.1 with the axis of eq. 3.4.

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


def maximum_gain_sinr_as_printed(scenario: Scenario, position_m: ArrayLike) -> FloatArray:
    """Return eq. 3.5 to the letter, its cross product not normalised.

    ``Gamma_i = (P_i / d_i^2) / (sum_j (1 - <d_j, d_1 x d_2>^2) J_j / d_j^2 + sigma^2)``. The gain towards the
    jammer comes out too large unless the nodes are seen at right angles; no antenna receives this. Kept for
    comparison with the paper only.

    Source: paper eq. 3.5, as printed.

    Args:
        scenario: a scenario with exactly two nodes.
        position_m: the drone's position, shape ``(..., 3)``, metres.

    Returns:
        Array of shape ``(..., 2)``, ratios.

    Raises:
        ValueError: the scenario does not have two nodes.
    """
    p = np.asarray(position_m, dtype=float)
    product = _direction_product(scenario, p)
    to_nodes = scenario.node_positions_m - p[..., None, :]
    to_jammers = scenario.jammer_positions_m - p[..., None, :]
    jammer_distance_sq = np.sum(to_jammers**2, axis=-1)  # m^2
    cosine_sq = np.sum(to_jammers * product[..., None, :], axis=-1) ** 2 / jammer_distance_sq
    g0 = scenario.reference_gain
    jamming_w = np.sum(g0 * (1.0 - cosine_sq) * scenario.jammer_powers_w / jammer_distance_sq, axis=-1)
    signal_w = g0 * scenario.node_powers_w / np.sum(to_nodes**2, axis=-1)
    return np.asarray(signal_w / (jamming_w[..., None] + scenario.receiver.noise_power_w))
