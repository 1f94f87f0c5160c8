"""The mean of the nodes' SINR in dB, each by its weight: as fair as all but the smallest can be (Kelly)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.objectives.min_sinr import ratios_at_drone
from nullpose.objectives.ratios import Ratios
from nullpose.objectives.record import ObjectiveRecord, Quantity

if TYPE_CHECKING:
    from nullpose.scenario import Scenario

_MEAN = Quantity("mean_sinr", "SINR", "a mean SINR", "SINR", "dB", "SINR", "sinr", whole="mean SINR")


def _ratios(scenario: Scenario) -> Ratios:
    """Build the nodes' SINR ratios; ``prod_k SINR_k^(w_k / W)`` is maximised, W the sum of the weights."""
    return ratios_at_drone(scenario, has_margins=False)._replace(shares=scenario.node_shares)


PROPORTIONAL_FAIR = ObjectiveRecord(
    name="proportional-fair",
    summary="the mean SINR in dB of the nodes that the drone hears, by their weights",
    quantities=(_MEAN,),
    quantity=lambda scenario: _MEAN,
    ratios=_ratios,
    evaluate=lambda reception: {"sinr": reception.sinr},
    mean_offset=0.0,
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
