"""The smallest SINR over the nodes that the drone receives (paper eq. 2.2), or the smallest margin."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.ratios import FloatArray, Ratios, channels_of, ground_of
from nullpose.objectives.record import ObjectiveRecord, Quantity

if TYPE_CHECKING:
    from nullpose.physics import Reception
    from nullpose.scenario import Scenario

_SINR = Quantity("min_sinr", "SINR", "an SINR", "SINR", "dB", "SINR", "sinr")
_MARGIN = Quantity("min_margin", "margin", "a margin", "margin", "dB", "SINR", "margin")


def _ratios(scenario: Scenario) -> Ratios:
    """Build one ratio for each node, over a denominator that all share.

    ``(g0 P_k / (sigma^2 Gamma_k)) T(s_k - p)`` over ``I + sum_j (g0 J_j / sigma^2) T(m_j - p)``:
    paper eq. 2.1 divided through by the noise and by the node's weight or required SINR. Powers count by the
    largest gain of the antenna on the ground and the strength of the channel.
    """
    n_nodes, n_jammers = len(scenario.nodes), len(scenario.jammers)
    scale = scenario.reference_gain / scenario.receiver.noise_power_w  # 1/W, per m^-2
    axes, leaks, shares = ground_of(scenario, "node", "jammer")
    channels, strengths = channels_of(scenario, "node", "jammer")
    shares = shares * strengths
    return Ratios(
        points_m=scenario.source_positions_m,
        numerator_isotropic=np.zeros(n_nodes),
        numerator_weight=scale * scenario.node_powers_w / scenario.node_required_sinr * shares[:n_nodes],
        numerator_point=np.arange(n_nodes, dtype=np.int64),
        denominator_of=np.zeros(n_nodes, dtype=np.int64),
        denominator_isotropic=np.ones(1),
        denominator_start=np.array([0, n_jammers], dtype=np.int64),
        denominator_point=np.arange(n_nodes, n_nodes + n_jammers, dtype=np.int64),
        denominator_weight=scale * scenario.jammer_powers_w * shares[n_nodes:],
        ground_axes=axes,
        ground_leaks=leaks,
        **channels,
    )


def _evaluate(reception: Reception) -> dict[str, FloatArray]:
    """Evaluate every node's SINR (paper eq. 2.1), and its margin: the SINR over its weight or requirement."""
    values = {"sinr": reception.sinr}
    if reception.scenario.has_margins:
        values["margin"] = reception.sinr / reception.scenario.node_required_sinr
    return values


MIN_SINR = ObjectiveRecord(
    name="min-sinr",
    summary="the smallest SINR (or margin) of the nodes that the drone hears",
    quantities=(_SINR, _MARGIN),
    quantity=lambda scenario: _MARGIN if scenario.has_margins else _SINR,
    ratios=_ratios,
    evaluate=_evaluate,
    interferers="jammers",
    needs=("nodes.power",),
    unused=("transmitter", "eavesdroppers", "nodes.noise", "nodes.jamming"),
)
