"""The smallest SNR, or margin, of the drone's signal at the nodes, the jamming there counted as noise."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.min_sinr import with_margins
from nullpose.objectives.ratios import Ratios, points_of, snr_weights
from nullpose.objectives.record import OF_SOURCES, ObjectiveRecord, Quantity

if TYPE_CHECKING:
    from nullpose.scenario import Scenario

_SNR = Quantity("min_snr", "SNR", "an SNR", "SNR", "dB", "SNR", "sinr")
_MARGIN = Quantity("min_snr_margin", "margin", "a margin", "margin", "dB", "SNR", "margin")


def _ratios(scenario: Scenario) -> Ratios:
    """Build one ratio for each node, over noise alone: ``(g0 P / (sigma_k^2 Gamma_k)) T(s_k - p)`` over I."""
    n_nodes, nobody = len(scenario.nodes), np.zeros(0, dtype=np.int64)
    return Ratios(
        numerator_isotropic=np.zeros(n_nodes),
        numerator_weight=snr_weights(scenario, "node") / scenario.node_required_sinr,
        numerator_point=np.arange(n_nodes, dtype=np.int64),
        denominator_of=np.zeros(n_nodes, dtype=np.int64),
        denominator_isotropic=np.ones(1),
        denominator_start=np.zeros(2, dtype=np.int64),
        denominator_point=nobody,
        denominator_weight=np.zeros(0),
        **points_of(scenario, "node"),
    )


DOWNLINK = ObjectiveRecord(
    name="downlink",
    summary="the smallest SNR (or margin) of the drone at the nodes",
    quantities=(_SNR, _MARGIN),
    quantity=lambda scenario: _MARGIN if scenario.has_margins else _SNR,
    ratios=_ratios,
    evaluate=lambda reception: with_margins(reception.scenario, reception.node_snr),
    interferers="eavesdroppers",  # of which it has none: only noise stands in the denominator
    transmits=True,
    needs=("transmitter",),
    unused=("eavesdroppers", "destination", *OF_SOURCES),
)
