"""The objective of a scenario, which is maximised."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.secrecy import node_snr, secrecy_rate
from nullpose.physics.sinr import sinr
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


def margin(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Return the margin of every node: its SINR over its weight or over the SINR that it requires.

    ``Gamma_i / w_i``; 1 is a requirement just met. The SINR itself for a node that states neither.

    Args:
        scenario: nodes, jammers and receiver.
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.
    """
    return np.asarray(sinr(scenario, position_m, axis) / scenario.node_required_sinr)


def objective_value(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Return the scenario's objective at every pose.

    The smallest margin over the nodes, which is the smallest SINR (paper eq. 2.2) where no node states a
    weight or a requirement; or the smallest secrecy rate if that is asked for.

    Args:
        scenario: nodes, jammers, eavesdroppers, receiver and transmitter; one dipole, not an array.
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.

    Returns:
        Array of shape ``(...)``: power ratios, or bits/s/Hz.
    """
    at = (scenario, position_m, axis)
    record = scenario.objective_record
    if record.quantity(scenario).is_rate:
        of_nodes = secrecy_rate(*at)
    else:
        of_nodes = node_snr(*at) if record.transmits else margin(*at)
    return np.asarray(np.min(of_nodes, axis=-1))
