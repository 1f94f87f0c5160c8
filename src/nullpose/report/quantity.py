"""What is made as large as it can be, as tables and figures write it: its name, its unit, its digits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from nullpose.physics import Link, to_db
from nullpose.scenario import Scenario
from nullpose.solve import Objective

__all__ = ["Quantity", "bound_text", "bound_words", "value_words"]


@dataclass(frozen=True, slots=True)
class Quantity:
    """What a node has that is made as large as it can be.

    Args:
        noun: its name: SINR, margin or secrecy rate.
        short: the same for narrow columns.
        unit: dB, or bits/s/Hz.
        ratio: the name of the power ratio behind it: SINR at the drone, SNR at a node that receives.
    """

    noun: str
    short: str
    unit: str
    ratio: str

    @classmethod
    def named(cls, name: str) -> Quantity:
        """Return the quantity of an objective's name, as in ``min_sinr``.

        Args:
            name: an objective's name.
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


_QUANTITIES = {
    "min_sinr": Quantity("SINR", "SINR", "dB", "SINR"),
    "min_margin": Quantity("margin", "margin", "dB", "SINR"),
    "min_secrecy_rate": Quantity("secrecy rate", "rate", "bits/s/Hz", "SNR"),
}


def value_words(objective: Objective) -> str:
    """Return the objective's value in words, as in ``smallest SINR 0.98 dB (1.25)``.

    Args:
        objective: value and bound.
    """
    if objective.is_rate:
        return f"{objective.words} {objective.value:.7g} bits/s/Hz"
    return f"{objective.words} {objective.value_db:.7g} dB ({objective.value:.7g})"


def bound_words(objective: Objective) -> str:
    """Return the bound and the gap in words, empty if nothing is proved.

    Args:
        objective: value and bound.
    """
    if objective.upper_bound is None or objective.relative_gap is None:
        return ""
    unit = Quantity.named(objective.name).unit
    return f"at most {bound_text(objective)} {unit} (relative gap {objective.relative_gap:.1e})"


def bound_text(objective: Objective, digits: int = 0) -> str:
    """Return the bound in its unit, rounded up, with the decimals that tell it from the value, or so many.

    Args:
        objective: value and bound.
        digits: decimals; 0 to choose.
    """
    assert objective.upper_bound is not None
    quantity = Quantity.named(objective.name)
    bound = quantity.in_unit(objective.upper_bound)
    if not digits:
        apart = max(bound - quantity.in_unit(objective.value), 1e-12)
        digits = min(12, max(2, math.ceil(-math.log10(apart)) + 1))
    return f"{math.ceil(bound * 10**digits) / 10**digits:.{digits}f}"
