"""What an objective states of itself, for everything that checks, evaluates, solves, prints or draws it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from nullpose.objectives.quantity import Quantity, Scenario
from nullpose.objectives.ratios import FloatArray, Ratios


def _receiver_noise_w(scenario: Scenario) -> float:
    return float(scenario.receiver.noise_power_w)


@dataclass(frozen=True, slots=True, kw_only=True)
class ObjectiveRecord:
    """An objective that a scenario can maximise.

    Args:
        name: as in a scenario file.
        summary: what it is, for the description of the key ``objective``.
        quantities: what nodes may have under it.
        quantity: from a scenario: which of these it is there.
        ratios: from a scenario: the ratios, each over the points of nodes and of interferers.
        transmits: whether the drone transmits: links are then measured at the nodes.
        noise_w: from a scenario: the noise beside each node's signal at the drone, watts, one or (n_nodes,).
        interferers: the table of a scenario whose points stand in the denominators.
        needs: what a scenario must state for it: headings of tables; ``nodes.power`` for a key of the nodes,
            in watts or dBm.
        unused: what has no meaning under it, likewise.
    """

    name: str
    summary: str
    quantities: tuple[Quantity, ...]
    quantity: Callable[[Scenario], Quantity]
    ratios: Callable[[Scenario], Ratios]
    interferers: str
    transmits: bool = False
    noise_w: Callable[[Scenario], FloatArray | float] = _receiver_noise_w
    needs: tuple[str, ...] = ()
    unused: tuple[str, ...] = ()
