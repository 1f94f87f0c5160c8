"""The smallest secrecy rate of the nodes that hear the drone, the strongest eavesdropper counting."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.ratios import FloatArray, Ratios, channels_of, ground_of
from nullpose.objectives.record import ObjectiveRecord, Quantity

if TYPE_CHECKING:
    from nullpose.physics import Reception
    from nullpose.scenario import Scenario

_RATE = Quantity(
    "min_secrecy_rate", "secrecy rate", "a secrecy rate", "rate", "bits/s/Hz", "SNR", "secrecy_rate_bps_hz"
)


def _ratios(scenario: Scenario) -> Ratios:
    """Build one ratio for each node and eavesdropper, two to the power of the rate.

    ``I + (g0 P / sigma_k^2) T(s_k - p)`` over ``I + (g0 P / sigma_e^2) T(e_e - p)``.
    """
    assert scenario.transmitter is not None, "validation lets no secrecy rate through without it"
    n_nodes, n_eavesdroppers = len(scenario.nodes), len(scenario.eavesdroppers)
    sent = scenario.reference_gain * scenario.transmitter.transmit_power_w
    node, eavesdropper = np.divmod(np.arange(n_nodes * n_eavesdroppers), n_eavesdroppers)
    positions = (
        scenario.node_positions_m,
        scenario.eavesdropper_positions_m,
        scenario.jammer_positions_m.reshape(-1, 3),  # in no ratio, but to be kept clear of
    )
    axes, leaks, shares = ground_of(scenario, "node", "eavesdropper", "jammer")
    channels, strengths = channels_of(scenario, "node", "eavesdropper", others=len(scenario.jammers))
    shares = shares[: len(strengths)] * strengths
    return Ratios(
        points_m=np.vstack(positions),
        numerator_isotropic=np.ones(len(node)),
        numerator_weight=(sent * shares[:n_nodes] / scenario.node_noise_w)[node],
        numerator_point=node.astype(np.int64),
        denominator_of=eavesdropper.astype(np.int64),
        denominator_isotropic=np.ones(n_eavesdroppers),
        denominator_start=np.arange(n_eavesdroppers + 1, dtype=np.int64),
        denominator_point=np.arange(n_nodes, n_nodes + n_eavesdroppers, dtype=np.int64),
        denominator_weight=sent * shares[n_nodes:] / scenario.eavesdropper_noise_w,
        ground_axes=axes,
        ground_leaks=leaks,
        **channels,
    )


def _ratios_at(reception: Reception) -> FloatArray:
    """Evaluate ``(1 + SNR_k) / (1 + SNR_e)`` of every node and eavesdropper."""
    wanted, overheard = reception.node_snr, reception.eavesdropper_snr
    return np.asarray((1.0 + wanted[..., :, None]) / (1.0 + overheard[..., None, :]))


SECRECY_RATE = ObjectiveRecord(
    name="secrecy-rate",
    summary="the smallest secrecy rate of the nodes that hear it",
    quantities=(_RATE,),
    quantity=lambda scenario: _RATE,
    ratios=_ratios,
    evaluate=lambda reception: {
        "sinr": reception.node_snr,
        "secrecy_rate_bps_hz": reception.secrecy_rate,
    },
    ratios_at=_ratios_at,
    interferers="eavesdroppers",
    transmits=True,
    needs=("transmitter", "eavesdroppers"),
    unused=("nodes.weight",),
)
