"""What is made as large as it can be, the smallest over the nodes: its name, its unit, its words."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from nullpose.physics.decibel import to_db
from nullpose.physics.evaluate import Link
from nullpose.scenario import Scenario

__all__ = ["Quantity"]


@dataclass(frozen=True, slots=True)
class Quantity:
    """What a node has that is made as large as it can be.

    Args:
        name: as in results: ``"min_sinr"``, ``"min_margin"`` or ``"min_secrecy_rate"``.
        noun: its name: SINR, margin or secrecy rate.
        one: the same with its article.
        short: the same for narrow columns.
        unit: dB, or bits/s/Hz.
        ratio: the name of the power ratio behind it: SINR at the drone, SNR at a node that receives.
    """

    name: str
    noun: str
    one: str
    short: str
    unit: str
    ratio: str

    @classmethod
    def named(cls, name: str) -> Quantity:
        """Return the quantity of a name, as in ``min_sinr``.

        Args:
            name: as in results.
        """
        return _QUANTITIES[name]

    @classmethod
    def of(cls, scenario: Scenario) -> Quantity:
        """Return what a scenario asks for.

        Args:
            scenario: any.
        """
        if scenario.objective == "secrecy-rate":
            return cls.named("min_secrecy_rate")
        return cls.named("min_margin" if scenario.has_margins else "min_sinr")

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
        return value if self.is_rate else float(to_db(value))

    def at(self, link: Link) -> float:
        """Return a node's number: a power ratio, or bits/s/Hz.

        Args:
            link: the node's link.
        """
        if self.is_rate:
            return link.secrecy_rate_bps_hz or 0.0
        return link.sinr if link.margin is None else link.margin

    def least(self, links: Iterable[Link]) -> float:
        """Return the smallest number over the nodes: the objective.

        Args:
            links: one for each node.
        """
        return min(map(self.at, links))

    def of_ratio(self, ratio: float) -> float:
        """Return the number of a smallest ratio: itself, or ``log2`` of it for a rate, at least 0.

        Args:
            ratio: the smallest ratio of a family.
        """
        return math.log2(max(1.0, ratio)) if self.is_rate else ratio


_QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity("min_sinr", "SINR", "an SINR", "SINR", "dB", "SINR"),
        Quantity("min_margin", "margin", "a margin", "margin", "dB", "SINR"),
        Quantity("min_secrecy_rate", "secrecy rate", "a secrecy rate", "rate", "bits/s/Hz", "SNR"),
    )
}
