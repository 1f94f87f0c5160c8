"""The number that was maximised and what is proved about it, in the units that the scenario asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from nullpose.objectives import Quantity
from nullpose.physics import Link, to_db
from nullpose.scenario import Scenario
from nullpose.solve.rigour import Rigour, bound_above

__all__ = ["Objective", "objective_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Objective:
    """The number that was maximised, evaluated at the reported pose, and what is proved about it.

    Args:
        name: that of its quantity, as in ``"min_sinr"``, the smallest SINR over the nodes (paper eq. 2.2).
        value: that number: a power ratio, or bits/s/Hz for a rate.
        value_db: the same in dB; not a number for a rate.
        upper_bound: no pose exceeds this; None if nothing is proved.
        relative_gap: ``(upper_bound - value) / value``, a rate below 1e-3 bits/s/Hz counting as so much; None
            if nothing is proved.
        rigour: how sure the bound is.
    """

    name: str
    value: float
    value_db: float
    upper_bound: float | None = None
    relative_gap: float | None = None
    rigour: Rigour = Rigour.NONE

    @property
    def quantity(self) -> Quantity:
        """What the number is of, and its unit."""
        return Quantity.named(self.name)

    def to_dict(self) -> dict[str, Any]:
        """Return value and bound as plain data for JSON; the decibels of a rate are None."""
        return {
            "name": self.name,
            "value": self.value,
            "value_db": self.value_db if math.isfinite(self.value_db) else None,
            "upper_bound": self.upper_bound,
            "relative_gap": self.relative_gap,
        }


def objective_of(scenario: Scenario, links: tuple[Link, ...], ratio_bound: float | None) -> Objective:
    """Return the objective at a pose with what is proved about it.

    Args:
        scenario: what it asks for decides which number it is.
        links: the nodes' links at the pose.
        ratio_bound: no pose has its smallest ratio of the family above this; None if nothing is proved.

    Raises:
        SolveError: the bound is below the value: a fault of nullpose.
    """
    quantity = Quantity.of(scenario)
    value = quantity.least(links)
    bound = gap = None
    if ratio_bound is not None:
        ratio = 2.0**value if quantity.is_rate else value
        bound = max(value, quantity.of_ratio(float(bound_above(ratio, ratio_bound))))  # log2 is rounded
        gap = quantity.gap(value, bound)
    return Objective(
        name=quantity.name,
        value=value,
        value_db=math.nan if quantity.is_rate else float(to_db(value)),
        upper_bound=bound,
        relative_gap=gap,
        rigour=Rigour.NONE if bound is None else Rigour.FLOATING_POINT,
    )
