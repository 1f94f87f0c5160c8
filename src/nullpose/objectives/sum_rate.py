"""The sum of the nodes' rates at the drone, each by its weight: what the network carries in all."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.min_sinr import ratios_at_drone
from nullpose.objectives.ratios import FloatArray, Ratios
from nullpose.objectives.record import ObjectiveRecord, Quantity

if TYPE_CHECKING:
    from nullpose.physics import Reception
    from nullpose.scenario import Scenario

_RATE = Quantity(
    "sum_rate", "rate", "a sum rate", "rate", "bits/s/Hz", "SINR", "rate_bps_hz", whole="sum rate"
)


def _ratios(scenario: Scenario) -> Ratios:
    """Build the nodes' SINR ratios, of which ``prod_k (1 + SINR_k)^(w_k / W)`` is maximised.

    W being the sum of the weights, the sum rate is ``W log2`` of it.
    """
    return ratios_at_drone(scenario, has_margins=False)._replace(shares=scenario.node_shares, offset=1.0)


def _evaluate(reception: Reception) -> dict[str, FloatArray]:
    """Evaluate every node's SINR, and its rate ``log2(1 + SINR_k)``."""
    return {"sinr": reception.sinr, "rate_bps_hz": np.log2(1.0 + reception.sinr)}


SUM_RATE = ObjectiveRecord(
    name="sum-rate",
    summary="the sum of the rates of the nodes that the drone hears, each times its weight",
    quantities=(_RATE,),
    quantity=lambda scenario: replace(_RATE, scale=float(np.sum(scenario.node_weights))),
    ratios=_ratios,
    evaluate=_evaluate,
    mean_offset=1.0,
    interferers="jammers",
    needs=("nodes.power",),
    unused=(
        "transmitter",
        "eavesdroppers",
        "destination",
        "nodes.noise",
        "nodes.jamming",
        "nodes.min_sinr_db",
    ),
)
