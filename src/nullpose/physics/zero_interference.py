"""The zero-interference pose: the null on a jammer (paper eqs. 3.1 and 3.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.sinr import received_power_w
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
    """Return every node's SINR with the null on the scenario's only jammer.

    ``Gamma_i = (1 - <d_i, d_M>^2) P_i / (|p_i - p|^2 sigma^2)``, with ``d`` the unit directions: the jammer's
    power is gone from it. An antenna whose null is not perfect lets some of it in, and the nodes more;
    antennas on the ground count as in :func:`link_gain`.

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
    received_w = received_power_w(
        p,
        zero_interference_axis(p, scenario.jammer_positions_m[0]),
        scenario.source_positions_m,
        scenario.source_powers_w,
        scenario.reference_gain,
        scenario.antenna_record,
        scenario.source_antennas,
    )
    if scenario.antenna_record.leak == 0.0:
        received_w[..., -1] = 0.0  # as it is but for rounding
    return np.asarray(received_w[..., :-1] / (received_w[..., -1:] + scenario.receiver.noise_power_w))
