"""Received power, and the SINR, SNR and secrecy rate of each link (paper eq. 2.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import SHORT_DIPOLE, AnyAntenna, GroundAntennas
from nullpose.channel import PointChannels, excess_gain
from nullpose.errors import UsageError
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


def _snr(
    scenario: Scenario,
    position_m: ArrayLike,
    axis: ArrayLike,
    kind: str,
    points_m: FloatArray | None = None,
) -> FloatArray:
    if scenario.transmitter is None:
        raise UsageError("scenario: it states no power of the drone; add a [transmitter]")
    places_m = getattr(scenario, f"{kind}_positions_m") if points_m is None else points_m
    # The channel is reciprocal: a point receives from the drone what the drone would receive from it.
    powers_w = np.full(places_m.shape[-2], scenario.transmitter.transmit_power_w)
    link = (scenario.reference_gain, scenario.antenna_record)
    ground, channels = getattr(scenario, f"{kind}_antennas"), getattr(scenario, f"{kind}_channels")
    received_w = received_power_w(position_m, axis, places_m, powers_w, *link, ground, channels)
    return np.asarray(received_w / getattr(scenario, f"{kind}_noise_w"))


def node_snr(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Evaluate the SNR of the drone's signal at every node, jamming counted as noise.

    ``SNR_k = g0 G(gamma_k) P h_k^2 / (d_k^2 sigma_k^2)``, with ``P`` the drone's power, ``h_k^2`` the
    channel's gain over free space and ``sigma_k^2`` the noise of the node's receiver plus the jamming there,
    which does not depend on the pose.

    Source: paper eqs. 1.2 to 1.4, with drone and node changing roles.

    Args:
        scenario: nodes, jammers, receiver and transmitter.
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.

    Raises:
        ValueError: the scenario has no transmitter.
    """
    return _snr(scenario, position_m, axis, "node")


def destination_snr(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Evaluate the SNR of the drone's signal at the destination, as :func:`node_snr` does at a node.

    Args:
        scenario: jammers, receiver, transmitter and destination.
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.

    Returns:
        Array of shape ``(..., 1)``, a power ratio; ``(..., 0)`` without a destination.

    Raises:
        ValueError: the scenario has no transmitter.
    """
    return _snr(scenario, position_m, axis, "destination")


def eavesdropper_snr(
    scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, points_m: FloatArray | None = None
) -> FloatArray:
    """Evaluate the SNR of the drone's signal at every eavesdropper; jammers do not disturb them.

    Args:
        scenario: eavesdroppers, receiver and transmitter.
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.
        points_m: where the eavesdroppers are, ``(..., n_eavesdroppers, 3)``, metres; as the scenario states,
            if left out.

    Returns:
        Array of shape ``(..., n_eavesdroppers)``, power ratios.

    Raises:
        ValueError: the scenario has no transmitter.
    """
    return _snr(scenario, position_m, axis, "eavesdropper", points_m)


def secrecy_rate(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Evaluate the secrecy rate of every node: its rate minus that of the best eavesdropper, at least 0.

    ``C_k = max(0, log2(1 + SNR_k) - max_e log2(1 + SNR_e))``

    Source: Gaussian wiretap channel (Leung-Yan-Cheong and Hellman, 1978), the stronger eavesdropper counting.

    Args:
        scenario: nodes, eavesdroppers, receiver and transmitter.
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.

    Returns:
        Array of shape ``(..., n_nodes)``, bits/s/Hz, at least 0.

    Raises:
        ValueError: the scenario has no transmitter.
    """
    pose = (scenario, position_m, axis)
    return secrecy_rate_of(node_snr(*pose), eavesdropper_snr(*pose))


def jammed_sinr(scenario: Scenario, snr: FloatArray) -> FloatArray:
    """Evaluate the SINR of every node that listens to a source on the ground while the drone jams.

    ``SINR_k = S_k / (sigma_k^2 + J_k)``, with ``S_k`` what the node receives from its source, ``J_k`` what it
    receives from the drone and ``sigma_k^2`` its noise, other jamming included.

    Source: Bonilla Licea et al., arXiv:2408.09753 (GLOBECOM 2024), whose abstract states the problem.

    Args:
        scenario: nodes, sources, jammers and receiver.
        snr: ``J_k / sigma_k^2``, as :func:`node_snr` evaluates it, ``(..., n_nodes)``.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.
    """
    return np.asarray(scenario.node_signal_w / scenario.node_noise_w / (1.0 + snr))


def overheard_sinr(scenario: Scenario, snr: FloatArray, points_m: FloatArray | None = None) -> FloatArray:
    """Evaluate the SINR at every eavesdropper of each node's source, as :func:`jammed_sinr` does at a node.

    Args:
        scenario: nodes, sources, eavesdroppers and receiver.
        snr: of the drone's signal, as :func:`eavesdropper_snr` evaluates it, ``(..., n_eavesdroppers)``.
        points_m: where the eavesdroppers are, ``(..., n_eavesdroppers, 3)``, metres; as the scenario states,
            if left out.

    Returns:
        Array of shape ``(..., n_nodes, n_eavesdroppers)``, power ratios.
    """
    heard_w = (
        scenario.overheard_w
        if points_m is None
        else scenario.ground_received_w(scenario.eavesdroppers, points_m)
    )
    heard = np.swapaxes(heard_w / scenario.eavesdropper_noise_w[:, None], -1, -2)
    return np.asarray(heard[..., scenario.node_senders, :] / (1.0 + snr[..., None, :]))


def secrecy_rate_of(wanted: FloatArray, overheard: FloatArray) -> FloatArray:
    """Evaluate secrecy rates, bits/s/Hz, from the SNR of the nodes and of the eavesdroppers.

    The logarithm of ``1 + (SNR_k - SNR_e) / (1 + SNR_e)``: the same number as the difference of two rates,
    which keeps its digits where signals are weak.
    """
    strongest = np.max(overheard, axis=-1, keepdims=True, initial=0.0)
    return np.asarray(np.log1p(np.maximum(0.0, (wanted - strongest) / (1.0 + strongest))) / np.log(2.0))
