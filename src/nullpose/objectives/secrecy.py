"""The smallest secrecy rate of the nodes, the strongest eavesdropper counting.

The nodes hear the drone; or sources on the ground, and the drone jams those who overhear these.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.ratios import Ratios, points_of, snr_weights
from nullpose.objectives.record import OF_SOURCES, ObjectiveRecord, Quantity

if TYPE_CHECKING:
    from nullpose.scenario import Scenario

_RATE = Quantity(
    "min_secrecy_rate", "secrecy rate", "a secrecy rate", "rate", "bits/s/Hz", "SNR", "secrecy_rate_bps_hz"
)
_JAMMED_RATE = replace(_RATE, name="min_jammed_secrecy_rate", ratio="SINR")


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
    # of every node and eavesdropper
    ratios_at=lambda reception: (
        (1.0 + reception.node_snr[..., :, None]) / (1.0 + reception.eavesdropper_snr[..., None, :])
    ),
    interferers="eavesdroppers",
    transmits=True,
    needs=("transmitter", "eavesdroppers"),
    unused=("destination", "nodes.weight", "nodes.min_sinr_db", *OF_SOURCES),
)


def _jammed_ratios(scenario: Scenario) -> Ratios:
    """Build a ratio for each node, and one for each eavesdropper and source that a node listens to.

    ``1 + S / (sigma^2 + J x)``, each over its own noise: ``(1 + S / sigma^2) I + (g0 J / sigma^2) T(s - p)``
    over ``I + (g0 J / sigma^2) T(s - p)``. A pair is a node's ratio and an eavesdropper's, of one source.
    """
    n_nodes, n_eavesdroppers = len(scenario.nodes), len(scenario.eavesdroppers)
    used, of_node = np.unique(scenario.node_senders, return_inverse=True)
    e, a = np.divmod(np.arange(n_eavesdroppers * len(used)), len(used))
    overheard = scenario.overheard_w[e, used[a]] / scenario.eavesdropper_noise_w[e]
    signals = np.concatenate([scenario.node_signal_w / scenario.node_noise_w, overheard])
    jamming = np.concatenate([snr_weights(scenario, "node"), snr_weights(scenario, "eavesdropper")])
    point = np.arange(n_nodes + n_eavesdroppers, dtype=np.int64)
    of_ratio = np.concatenate([point[:n_nodes], n_nodes + e])
    node, heard_by = np.divmod(np.arange(n_nodes * n_eavesdroppers), n_eavesdroppers)
    return Ratios(
        numerator_isotropic=1.0 + signals,
        numerator_weight=jamming[of_ratio],
        numerator_point=of_ratio,
        denominator_of=of_ratio,
        denominator_isotropic=np.ones(len(point)),
        denominator_start=np.arange(len(point) + 1, dtype=np.int64),
        denominator_point=point,
        denominator_weight=jamming,
        pairs=np.column_stack([node, n_nodes + heard_by * len(used) + of_node[node]]).astype(np.int64),
        **points_of(scenario, "node", "eavesdropper"),
    )


FRIENDLY_JAMMING = ObjectiveRecord(
    name="friendly-jamming",
    summary="the smallest secrecy rate of nodes that hear a source on the ground, eavesdroppers being jammed",
    quantities=(_JAMMED_RATE,),
    quantity=lambda scenario: _JAMMED_RATE,
    ratios=_jammed_ratios,
    evaluate=lambda reception: {
        "sinr": reception.jammed_sinr,
        "secrecy_rate_bps_hz": reception.jammed_secrecy_rate,
    },
    ratios_at=lambda reception: (1.0 + reception.jammed_sinr[..., None]) / (1.0 + reception.overheard_sinr),
    interferers="eavesdroppers",
    transmits=True,
    needs=("transmitter", "sources", "eavesdroppers"),
    unused=("destination", "nodes.weight", "nodes.min_sinr_db"),
)
