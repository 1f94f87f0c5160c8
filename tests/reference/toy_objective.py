"""An objective made as CONTRIBUTING.md says: the smallest SINR with the jamming counted twice."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.objectives import FloatArray, ObjectiveRecord, Quantity, Ratios
from nullpose.objectives.min_sinr import MIN_SINR

if TYPE_CHECKING:
    from nullpose.physics import Reception
    from nullpose.scenario import Scenario

_CAUTIOUS = Quantity(
    "min_cautious_sinr", "cautious SINR", "a cautious SINR", "cautious", "dB", "SINR", "cautious_sinr"
)


def _ratios(scenario: Scenario) -> Ratios:
    ratios = MIN_SINR.ratios(scenario)
    return ratios._replace(denominator_weight=2.0 * ratios.denominator_weight)


def _evaluate(reception: Reception) -> dict[str, FloatArray]:
    nodes = len(reception.scenario.nodes)
    jamming_w = reception.received_w[..., nodes:].sum(axis=-1, keepdims=True)
    cautious = reception.received_w[..., :nodes] / (
        2.0 * jamming_w + reception.scenario.receiver.noise_power_w
    )
    return {"sinr": reception.sinr, "cautious_sinr": cautious}


CAUTIOUS_SINR = ObjectiveRecord(
    name="cautious-sinr",
    summary="the smallest SINR with the jamming counted twice",
    quantities=(_CAUTIOUS,),
    quantity=lambda scenario: _CAUTIOUS,
    ratios=_ratios,
    evaluate=_evaluate,
    interferers="jammers",
    needs=("nodes.power",),
    unused=("transmitter", "eavesdroppers", "nodes.weight", "nodes.noise", "nodes.jamming"),
)
