"""The maximum-gain pose for two nodes: the dipole broadside to both (paper eqs. 3.4 and 3.5)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.sinr import sinr
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


def direction_product(scenario: Scenario, position_m: FloatArray) -> FloatArray:
    """Return the cross product of the unit directions to both nodes, as eq. 3.4 is printed.

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
