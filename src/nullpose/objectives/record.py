"""An objective and the quantity that it maximises, for everything that solves, evaluates or prints them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from nullpose.objectives.ratios import FloatArray, Ratios

if TYPE_CHECKING:
    from nullpose.physics import Link, Reception
    from nullpose.scenario import Scenario

LEAST_RATE_BPS_HZ = 1e-3
"""The relative gap of a smaller rate is that of this one, bits/s/Hz; of a sum, times its weights."""

OF_SOURCES = ("sources", "nodes.from")
"""What only a drone has a use for that jams those who overhear transmitters on the ground."""

_Numbers = TypeVar("_Numbers", float, FloatArray)


@dataclass(frozen=True, slots=True)
class Quantity:
    """The quantity of a node that is maximised.

    Args:
        name: as in results: ``min_`` and the noun, as in ``"min_sinr"``.
        noun: its name, as in SINR, margin or secrecy rate.
        with_article: what is maximised with its article, but for being the smallest.
        short: the same for narrow columns.
        unit: dB, or bits/s/Hz.
        ratio: the name of the power ratio behind it: SINR at the drone, SNR at a node that receives.
        field: its name among the numbers of a link, ``values`` of :class:`nullpose.physics.Link`.
        terminals: over whom the smallest is taken.
        whole: what is maximised, as in sum rate; empty for the smallest.
        scale: a rate is so many times the logarithm of the ratio that stands for it.
        mbps: Mbit/s of 1 bit/s/Hz; None without a bandwidth, or for no rate.
    """

    name: str
    noun: str
    with_article: str
    short: str
    unit: str
    ratio: str
    field: str
    terminals: str = "the nodes"
    whole: str = ""
    scale: float = dataclasses.field(default=1.0, compare=False)
    mbps: float | None = dataclasses.field(default=None, compare=False)

    @classmethod
    def of(cls, scenario: Scenario) -> Quantity:
        """Return the quantity that a scenario maximises."""
        quantity, bandwidth_hz = scenario.objective_record.quantity(scenario), scenario.rate_bandwidth_hz
        if not quantity.is_rate or bandwidth_hz is None:
            return quantity
        return dataclasses.replace(quantity, mbps=1e-6 * bandwidth_hz)

    @property
    def is_rate(self) -> bool:
        """Whether it is a rate, which no decibels are taken of."""
        return self.unit != "dB"

    @property
    def ending(self) -> str:
        """The unit at the end of a name, as in ``db``."""
        return {"dB": "db", "bits/s/Hz": "bps_hz"}.get(self.unit, self.unit)

    @property
    def smallest(self) -> str:
        """The objective in words, as in "smallest SINR"."""
        return self.whole or f"smallest {self.noun}"

    @property
    def smallest_short(self) -> str:
        """The same for narrow columns, as in "SINR" or "sum rate"."""
        return self.whole or self.short

    @property
    def gives(self) -> str:
        """What a pose does, before a number: that it has it, or gives it to every node."""
        return "has" if self.whole else f"gives {self.terminals.replace('the nodes', 'every node')}"

    @property
    def smallest_over(self) -> str:
        """The objective in words with those who count, as in "smallest SINR over the nodes"."""
        return f"{self.smallest} over {self.terminals}"

    def in_unit(self, value: float) -> float:
        """Convert a number to the quantity's unit: to dB, or leave it as it is if it is a rate."""
        return value if self.is_rate else 10.0 * math.log10(value) if value > 0.0 else -math.inf

    def at(self, link: Link) -> float:
        """Return a node's number: a power ratio, or bits/s/Hz."""
        return float(link.values[self.field])

    def of_ratio(self, ratio: float) -> float:
        """Convert the smallest ratio of a problem, or a mean: to ``log2`` of it, at least 0, for a rate."""
        return self.scale * math.log2(max(1.0, ratio)) if self.is_rate else ratio

    def to_ratio(self, value: _Numbers) -> _Numbers:
        """Convert numbers to the ratios that stand for them."""
        return 2.0 ** (value / self.scale) if self.is_rate else value

    def gap(self, value: float, bound: float) -> float:
        """Return ``(bound - value) / value``, infinite for a ratio of zero.

        A rate below ``LEAST_RATE_BPS_HZ`` counts as so much, a sum below that times its weights likewise.
        """
        if self.is_rate:
            return (bound - value) / max(value, LEAST_RATE_BPS_HZ * self.scale)
        return (bound - value) / value if value > 0.0 else math.inf


@dataclass(frozen=True, slots=True, kw_only=True)
class ObjectiveRecord:
    """An objective that a scenario can maximise.

    Args:
        name: as in a scenario file.
        summary: what it is, for the description of the key ``objective``.
        quantities: what nodes may have under it.
        quantity: from a scenario: which of these it is there.
        ratios: from a scenario: the ratios, each over the points of nodes and of interferers.
        evaluate: from what is received at poses: the numbers of every node, and of a destination after them,
            by name, each ``(..., n_terminals)``.
            ``sinr`` is among them, and the quantity's field. A name without a unit is that of a power ratio;
            links get its decibels as well.
        ratios_at: from what is received at poses: the values of ``ratios`` there, ``(..., n_nodes, m)``, a
            row for each node; the quantity itself if left out, ``m`` being 1.
        mean_offset: a, 0 or 1, where ``prod_k (a + ratio_k)^share_k`` is maximised in place of the smallest
            ratio. The quantity is then the number of a node, ``a + ratio_k`` or, of a rate, its ``log2``.
        of_nodes: of an objective that is a function in Python: its values, (...), from every node's SINR.
        transmits: whether the drone transmits: links are then measured at the nodes.
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
    evaluate: Callable[[Reception], Mapping[str, FloatArray]]
    ratios_at: Callable[[Reception], FloatArray] | None = None
    mean_offset: float | None = None
    of_nodes: Callable[[FloatArray], FloatArray] | None = None
    transmits: bool = False
    interferers: str
    needs: tuple[str, ...] = ()
    unused: tuple[str, ...] = ()

    def value(self, scenario: Scenario, values: Mapping[str, FloatArray]) -> FloatArray:
        """Evaluate the objective, (...), from the numbers of every node by name, each ``(..., n_nodes)``.

        The smallest of the maximised quantity; or the mean of it by the nodes' shares, that of its logarithm
        if it is no rate.
        """
        quantity = self.quantity(scenario)
        numbers = np.asarray(values[quantity.field])
        if self.of_nodes is not None:
            return self.of_nodes(numbers)
        if self.mean_offset is None:
            return np.asarray(np.min(numbers, axis=-1))
        if quantity.is_rate:
            return np.asarray(quantity.scale * (numbers @ scenario.node_shares))
        with np.errstate(divide="ignore"):
            return np.asarray(np.exp(np.log(numbers) @ scenario.node_shares))
