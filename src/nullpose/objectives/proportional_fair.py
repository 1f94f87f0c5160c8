"""The mean of the nodes' SINR in dB, each by its weight: as fair as all but the smallest can be (Kelly)."""

from __future__ import annotations

from dataclasses import replace

from nullpose.objectives.min_sinr import MIN_SINR
from nullpose.objectives.record import Quantity

_MEAN = Quantity("mean_sinr", "SINR", "a mean SINR", "SINR", "dB", "SINR", "sinr", whole="mean SINR")

PROPORTIONAL_FAIR = replace(
    MIN_SINR,
    name="proportional-fair",
    summary="the mean SINR in dB of the nodes that the drone hears, by their weights",
    quantities=(_MEAN,),
    quantity=lambda scenario: _MEAN,
    evaluate=lambda reception: {"sinr": reception.sinr},
    mean_offset=0.0,
)
