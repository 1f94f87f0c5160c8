"""Received power and the SINR of each link (paper eq. 2.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import SHORT_DIPOLE, AnyAntenna, GroundAntennas
from nullpose.channel import PointChannels, excess_gain
from nullpose.physics.gain import link_gain
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


def received_power_w(
    position_m: ArrayLike,
    axis: ArrayLike,
    points_m: ArrayLike,
    powers_w: ArrayLike,
    reference_gain: ArrayLike,
    antenna: AnyAntenna = SHORT_DIPOLE,
    ground: GroundAntennas | None = None,
    channels: PointChannels | None = None,
) -> FloatArray:
    """Evaluate the power that the drone receives from each ground transmitter.

    ``g0 G_i P_i h_i^2 / |p_i - p|^2``, the numerator of eq. 2.1, with ``g0`` the path gain at 1 m (1 in the
    paper), ``G_i`` the gain of :func:`link_gain`, and ``h_i^2`` that of the channel over free space
    (:func:`nullpose.channel.excess_gain`; 1 in the paper).

    Source: paper eq. 2.1.

    Args:
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.
        points_m: transmitters, shape ``(m, 3)``, metres, or ``(..., m, 3)`` where they differ.
        powers_w: their powers, shape ``(m,)``, watts; likewise.
        reference_gain: path gain at 1 m, a power ratio.
        antenna: which antenna the drone has.
        ground: the transmitters' antennas; None where all are isotropic.
        channels: theirs; None where all are in free space with line of sight.

    Returns:
        Array of shape ``(..., m)``, watts. Far field: valid beyond the keep-out radius.
    """
    to_points = np.asarray(points_m, dtype=float) - np.asarray(position_m, dtype=float)[..., None, :]
    distance_sq = (to_points**2).sum(axis=-1)  # m^2
    gain = link_gain(position_m, axis, points_m, antenna, ground)
    received_w = (
        np.asarray(reference_gain, dtype=float) * gain * np.asarray(powers_w, dtype=float) / distance_sq
    )
    if channels is not None:
        received_w = received_w * excess_gain(channels, to_points, np.asarray(points_m))
    return np.asarray(received_w)


def received_from_sources_w(
    scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, points_m: ArrayLike | None = None
) -> FloatArray:
    """Evaluate the power that the drone receives from each node and then from each jammer, watts.

    Args:
        scenario: nodes, jammers and receiver.
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.
        points_m: where nodes and jammers are, ``(..., n_nodes + n_jammers, 3)``, metres; as the scenario
            states, if left out.
    """
    return received_power_w(
        position_m,
        axis,
        scenario.source_positions_m if points_m is None else points_m,
        scenario.source_powers_w,
        scenario.reference_gain,
        scenario.antenna_record,
        scenario.source_antennas,
        scenario.source_channels,
    )


def sinr(
    scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, points_m: ArrayLike | None = None
) -> FloatArray:
    """Evaluate the signal to interference-plus-noise ratio of every node.

    ``Gamma_i = (G(gamma_i) P_i h_i^2 / d_i^2) / (sum_j G(gamma_j) J_j h_j^2 / d_j^2 + sigma^2)``, with the
    jammers summed and every power scaled by the path gain at 1 m; ``h^2`` is the channel's gain over free
    space.

    Source: paper eq. 2.1, which has one jammer.

    Args:
        scenario: nodes, jammers and receiver.
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.
        points_m: where nodes and jammers are, as in :func:`received_from_sources_w`.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.
    """
    received_w, nodes = received_from_sources_w(scenario, position_m, axis, points_m), len(scenario.nodes)
    interference_w = received_w[..., nodes:].sum(axis=-1, keepdims=True)
    return np.asarray(received_w[..., :nodes] / (interference_w + scenario.receiver.noise_power_w))
