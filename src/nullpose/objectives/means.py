"""Means over the nodes that the drone hears, each by its weight, in place of the smallest SINR."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nullpose.objectives.min_sinr import MIN_SINR
from nullpose.objectives.record import Quantity

_RATE = Quantity(
    "sum_rate", "rate", "a sum rate", "rate", "bits/s/Hz", "SINR", "rate_bps_hz", whole="sum rate"
)
_MEAN = Quantity("mean_sinr", "SINR", "a mean SINR", "SINR", "dB", "SINR", "sinr", whole="mean SINR")

SUM_RATE = replace(
    MIN_SINR,
    name="sum-rate",
    summary="the sum of the rates of the nodes that the drone hears, each times its weight",
    quantities=(_RATE,),
    # W log2 of the mean prod_k (1 + SINR_k)^(w_k / W), W being the sum of the weights
    quantity=lambda scenario: replace(_RATE, scale=float(np.sum(scenario.node_weights))),
    evaluate=lambda reception: {"sinr": reception.sinr, "rate_bps_hz": np.log2(1.0 + reception.sinr)},
    mean_offset=1.0,
)
"""What the network carries in all."""

PROPORTIONAL_FAIR = replace(
    MIN_SINR,
    name="proportional-fair",
    summary="the mean SINR in dB of the nodes that the drone hears, by their weights",
    quantities=(_MEAN,),
    quantity=lambda scenario: _MEAN,
    evaluate=lambda reception: {"sinr": reception.sinr},
    mean_offset=0.0,
)
"""As fair as all but the smallest can be (Kelly)."""
