"""The smallest SINR over the nodes that the drone receives (paper eq. 2.2), or the smallest margin."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.ratios import FloatArray, Ratios, gains_of, points_of
from nullpose.objectives.record import OF_SOURCES, ObjectiveRecord, Quantity

if TYPE_CHECKING:
    from nullpose.scenario import Scenario

_SINR = Quantity("min_sinr", "SINR", "an SINR", "SINR", "dB", "SINR", "sinr")
_MARGIN = Quantity("min_margin", "margin", "a margin", "margin", "dB", "SINR", "margin")


def ratios_at_drone(scenario: Scenario, *others: str) -> Ratios:
    """Build one ratio for each node, over a denominator that all share.

    ``(g0 P_k / (sigma^2 Gamma_k)) T(s_k - p)`` over ``I + sum_j (g0 J_j / sigma^2) T(m_j - p)``:
    paper eq. 2.1 divided through by the noise and by the node's weight or required SINR. Powers count by the
    largest gain of the antenna on the ground and the strength of the channel.

    Args:
        scenario: nodes, jammers and receiver.
        others: kinds of points that come after them for further ratios, as in ``"destination"``.
    """
    n_nodes, n_jammers = len(scenario.nodes), len(scenario.jammers)
    scale = scenario.reference_gain / scenario.receiver.noise_power_w  # 1/W, per m^-2
    is_mean = scenario.objective_record.mean_offset is not None  # then Gamma_k is 1
    weights = scale * scenario.node_powers_w / (1.0 if is_mean else scenario.node_required_sinr)
    return Ratios(
        numerator_isotropic=np.zeros(n_nodes),
        numerator_weight=weights * gains_of(scenario, "node"),
        numerator_point=np.arange(n_nodes, dtype=np.int64),
        denominator_of=np.zeros(n_nodes, dtype=np.int64),
        denominator_isotropic=np.ones(1),
        denominator_start=np.array([0, n_jammers], dtype=np.int64),
        denominator_point=np.arange(n_nodes, n_nodes + n_jammers, dtype=np.int64),
        denominator_weight=scale * scenario.jammer_powers_w * gains_of(scenario, "jammer"),
        **points_of(scenario, "node", "jammer", *others),
    )


def with_margins(scenario: Scenario, sinr: FloatArray) -> dict[str, FloatArray]:
    """Put every terminal's margin, its SINR over its weight or requirement, beside its SINR if any has one.

    Args:
        scenario: the terminals.
        sinr: theirs, ``(..., n_terminals)``, power ratios.
    """
    margins = {"margin": sinr / scenario.terminal_required_sinr} if scenario.has_margins else {}
    return {"sinr": sinr} | margins


MIN_SINR = ObjectiveRecord(
    name="min-sinr",
    summary="the smallest SINR (or margin) of the nodes that the drone hears",
    quantities=(_SINR, _MARGIN),
    quantity=lambda scenario: _MARGIN if scenario.has_margins else _SINR,
    ratios=ratios_at_drone,
    evaluate=lambda reception: with_margins(reception.scenario, reception.sinr),
    interferers="jammers",
    needs=("nodes.power",),
    unused=("transmitter", "eavesdroppers", "destination", "nodes.noise", "nodes.jamming", *OF_SOURCES),
)
