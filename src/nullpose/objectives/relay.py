"""The smaller hop of a relay: the nodes' SINR at the drone, and the drone's SNR at the destination."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.min_sinr import ratios_at_drone, with_margins
from nullpose.objectives.ratios import Ratios, snr_weights
from nullpose.objectives.record import OF_SOURCES, ObjectiveRecord, Quantity

if TYPE_CHECKING:
    from nullpose.scenario import Scenario

_BOTH = "the nodes and the destination"
_SINR = Quantity("min_hop_sinr", "SINR", "an SINR", "SINR", "dB", "SINR", "sinr", _BOTH)
_MARGIN = Quantity("min_hop_margin", "margin", "a margin", "margin", "dB", "SINR", "margin", _BOTH)


def _ratios(scenario: Scenario) -> Ratios:
    """Build one ratio for each node, as where the drone only receives, and one for the destination.

    The last one is ``(g0 P / (sigma_d^2 Gamma_d)) T(s_d - p)`` over I, a denominator of its own.
    """
    hop = ratios_at_drone(scenario, "destination")
    required = scenario.terminal_required_sinr[len(scenario.nodes) :]
    return hop._replace(
        numerator_isotropic=np.append(hop.numerator_isotropic, 0.0),
        numerator_weight=np.append(hop.numerator_weight, snr_weights(scenario, "destination") / required),
        numerator_point=np.append(hop.numerator_point, len(hop.points_m) - 1),
        denominator_of=np.append(hop.denominator_of, 1),
        denominator_isotropic=np.ones(2),
        denominator_start=np.append(hop.denominator_start, hop.denominator_start[-1]),
    )


RELAY = ObjectiveRecord(
    name="relay",
    summary="the smaller of the nodes' SINR at the drone and the drone's SNR (or margin) at the destination",
    quantities=(_SINR, _MARGIN),
    quantity=lambda scenario: _MARGIN if scenario.has_margins else _SINR,
    ratios=_ratios,
    # of every node at the drone, then of the drone at the destination
    evaluate=lambda reception: with_margins(
        reception.scenario, np.concatenate([reception.sinr, reception.destination_snr], axis=-1)
    ),
    interferers="jammers",
    needs=("transmitter", "destination", "nodes.power"),
    unused=("eavesdroppers", "nodes.noise", "nodes.jamming", *OF_SOURCES),
)
