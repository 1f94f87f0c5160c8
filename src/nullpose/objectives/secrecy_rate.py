"""The smallest secrecy rate of the nodes that hear the drone, the strongest eavesdropper counting."""

from __future__ import annotations

import numpy as np

from nullpose.objectives.quantity import Quantity, Scenario
from nullpose.objectives.ratios import Ratios, ground_of
from nullpose.objectives.record import ObjectiveRecord

_RATE = Quantity(
    "min_secrecy_rate", "secrecy rate", "a secrecy rate", "rate", "bits/s/Hz", "SNR", "secrecy_rate_bps_hz"
)


def _ratios(scenario: Scenario) -> Ratios:
    """Return one ratio for each node and eavesdropper, two to the power of the rate.

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
    return Ratios(
        points_m=np.vstack(positions),
        numerator_isotropic=np.ones(len(node)),
        numerator_weight=(sent * shares[:n_nodes] / scenario.node_noise_w)[node],
        numerator_point=node.astype(np.int64),
        denominator_of=eavesdropper.astype(np.int64),
        denominator_isotropic=np.ones(n_eavesdroppers),
        denominator_start=np.arange(n_eavesdroppers + 1, dtype=np.int64),
        denominator_point=np.arange(n_nodes, n_nodes + n_eavesdroppers, dtype=np.int64),
        denominator_weight=sent * shares[n_nodes : n_nodes + n_eavesdroppers] / scenario.eavesdropper_noise_w,
        ground_axes=axes,
        ground_leaks=leaks,
    )


SECRECY_RATE = ObjectiveRecord(
    name="secrecy-rate",
    summary="the smallest secrecy rate of the nodes that hear it",
    quantities=(_RATE,),
    quantity=lambda scenario: _RATE,
    ratios=_ratios,
    interferers="eavesdroppers",
    transmits=True,
    needs=("transmitter", "eavesdroppers"),
    unused=("nodes.weight",),
)
