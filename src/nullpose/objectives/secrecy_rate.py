"""The smallest secrecy rate of the nodes that hear the drone, the strongest eavesdropper counting."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.ratios import FloatArray, Ratios, points_of, snr_weights
from nullpose.objectives.record import OF_SOURCES, ObjectiveRecord, Quantity

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
    n_nodes, n_eavesdroppers = len(scenario.nodes), len(scenario.eavesdroppers)
    node, eavesdropper = np.divmod(np.arange(n_nodes * n_eavesdroppers), n_eavesdroppers)
    return Ratios(
        numerator_isotropic=np.ones(len(node)),
        numerator_weight=snr_weights(scenario, "node")[node],
        numerator_point=node.astype(np.int64),
        denominator_of=eavesdropper.astype(np.int64),
        denominator_isotropic=np.ones(n_eavesdroppers),
        denominator_start=np.arange(n_eavesdroppers + 1, dtype=np.int64),
        denominator_point=np.arange(n_nodes, n_nodes + n_eavesdroppers, dtype=np.int64),
        denominator_weight=snr_weights(scenario, "eavesdropper"),
        **points_of(scenario, "node", "eavesdropper"),
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
    unused=("destination", "nodes.weight", "nodes.min_sinr_db", *OF_SOURCES),
)
