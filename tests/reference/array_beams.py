"""What an array receives with given weights, whatever they are."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics import array_channels
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


def beam_sinr(
    scenario: Scenario, position_m: ArrayLike, elements_wavelengths: ArrayLike, weights: ArrayLike
) -> FloatArray:
    """Evaluate every node's SINR with given weights.

    ``Gamma_k = |w_k^H h_k|^2 / (sigma^2 |w_k|^2 + sum_j |w_k^H h_j|^2)``

    Source: Van Trees, section 6.2.

    Args:
        scenario: nodes, jammers and receiver.
        position_m: the array's centre, shape ``(..., 3)``, metres.
        elements_wavelengths: shape ``(..., K, 3)``.
        weights: shape ``(..., n_nodes, K)``, of any length but zero.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.
    """
    channels = array_channels(
        position_m,
        elements_wavelengths,
        scenario.source_positions_m,
        scenario.source_powers_w,
        scenario.reference_gain,
        scenario.source_antennas,
        links=scenario.source_channels,
    )
    nodes, jammers = np.split(channels, [len(scenario.nodes)], axis=-2)
    conjugate = np.conj(np.asarray(weights, dtype=complex))
    signal_w = np.abs(np.sum(conjugate * nodes, axis=-1)) ** 2
    jamming_w = np.sum(np.abs(conjugate @ np.swapaxes(jammers, -1, -2)) ** 2, axis=-1)
    noise_w = scenario.receiver.noise_power_w * np.sum(np.abs(conjugate) ** 2, axis=-1)
    return np.asarray(signal_w / (jamming_w + noise_w))
