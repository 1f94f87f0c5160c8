"""The maximised quantity, the smallest over the nodes: its name, its unit, its words."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

Scenario: TypeAlias = Any
"""A :class:`nullpose.scenario.Scenario`, whose module imports this room."""

Link: TypeAlias = Any
"""A :class:`nullpose.physics.Link`, likewise."""

LEAST_RATE_BPS_HZ = 1e-3
"""The relative gap of a smaller rate is that of this one, bits/s/Hz."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """The quantity of a node that is maximised.

    Args:
        name: as in results: ``min_`` and the noun, as in ``"min_sinr"``.
        noun: its name, as in SINR, margin or secrecy rate.
        one: the same with its article.
        short: the same for narrow columns.
        unit: dB, or bits/s/Hz.
        ratio: the name of the power ratio behind it: SINR at the drone, SNR at a node that receives.
        field: the field of a link that holds it.
    """

    name: str
    noun: str
    one: str
    short: str
    unit: str
    ratio: str
    field: str

    @classmethod
    def named(cls, name: str) -> Quantity:
        """Return the quantity of a name, as in ``min_sinr``.

        Args:
            name: as in results.
        """
        from nullpose.objectives import RECORDS

        return next(one for record in RECORDS.values() for one in record.quantities if one.name == name)

    @classmethod
    def of(cls, scenario: Scenario) -> Quantity:
        """Return what a scenario asks for.

        Args:
            scenario: any.
        """
        quantity: Quantity = scenario.objective_record.quantity(scenario)
        return quantity

    @property
    def is_rate(self) -> bool:
        """Whether it is a rate, which no decibels are taken of."""
        return self.unit != "dB"

    @property
    def smallest(self) -> str:
        """The objective in words, as in "smallest SINR"."""
        return f"smallest {self.noun}"

    def in_unit(self, value: float) -> float:
        """Return a number in the quantity's unit: in dB, or as it is if it is a rate.

        Args:
            value: a power ratio, or bits/s/Hz.
        """
        if self.is_rate:
            return value
        return 10.0 * math.log10(value) if value > 0.0 else -math.inf

    def at(self, link: Link) -> float:
        """Return a node's number: a power ratio, or bits/s/Hz.

        Args:
            link: the node's link.
        """
        value = getattr(link, self.field)
        return float(link.sinr if value is None else value)  # a link of eq. 3.5 has its ratio alone

    def least(self, links: Iterable[Link]) -> float:
        """Return the smallest number over the nodes: the objective.

        Args:
            links: one for each node.
        """
        return min(map(self.at, links))

    def of_ratio(self, ratio: float) -> float:
        """Return the number of a smallest ratio: itself, or ``log2`` of it for a rate, at least 0.

        Args:
            ratio: the smallest ratio of a problem.
        """
        return math.log2(max(1.0, ratio)) if self.is_rate else ratio

    def gap(self, value: float, bound: float) -> float:
        """Return ``(bound - value) / value``, a rate below ``LEAST_RATE_BPS_HZ`` counting as so much.

        Infinite for a ratio of zero.

        Args:
            value: a power ratio, or bits/s/Hz.
            bound: no pose exceeds it.
        """
        if self.is_rate:
            return (bound - value) / max(value, LEAST_RATE_BPS_HZ)
        return (bound - value) / value if value > 0.0 else math.inf
