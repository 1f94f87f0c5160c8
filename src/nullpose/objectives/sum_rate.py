"""The sum of the nodes' rates at the drone, each by its weight: what the network carries in all."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives.min_sinr import MIN_SINR
from nullpose.objectives.ratios import FloatArray
from nullpose.objectives.record import Quantity

if TYPE_CHECKING:
    from nullpose.physics import Reception

_RATE = Quantity(
    "sum_rate", "rate", "a sum rate", "rate", "bits/s/Hz", "SINR", "rate_bps_hz", whole="sum rate"
)


def _evaluate(reception: Reception) -> dict[str, FloatArray]:
    """Evaluate every node's SINR, and its rate ``log2(1 + SINR_k)``."""
    return {"sinr": reception.sinr, "rate_bps_hz": np.log2(1.0 + reception.sinr)}


SUM_RATE = replace(
    MIN_SINR,
    name="sum-rate",
    summary="the sum of the rates of the nodes that the drone hears, each times its weight",
    quantities=(_RATE,),
    # W log2 of the mean prod_k (1 + SINR_k)^(w_k / W), W being the sum of the weights
    quantity=lambda scenario: replace(_RATE, scale=float(np.sum(scenario.node_weights))),
    evaluate=_evaluate,
    mean_offset=1.0,
)
