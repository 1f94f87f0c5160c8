"""The number that was maximised and what is proved about it, in the units that the scenario asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from nullpose.physics import Link, to_db
from nullpose.scenario import Scenario
from nullpose.solve.limits import LEAST_RATE_BPS_HZ
from nullpose.solve.rigour import Rigour, bound_above

__all__ = ["Objective", "objective_of"]

_WORDS = {
    "min_sinr": "smallest SINR",
    "min_margin": "smallest margin",
    "min_secrecy_rate": "smallest secrecy rate",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Objective:
    """The number that was maximised, evaluated at the reported pose, and what is proved about it.

    Args:
        name: ``"min_sinr"``, the smallest SINR over the nodes (paper eq. 2.2); ``"min_margin"``, the smallest
            SINR over its node's weight or requirement; or ``"min_secrecy_rate"``.
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
    def is_rate(self) -> bool:
        """Whether it is a rate in bits/s/Hz, and not a power ratio."""
        return self.name == "min_secrecy_rate"

    @property
    def words(self) -> str:
        """What the number is, in words."""
        return _WORDS[self.name]

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
    rigour = Rigour.NONE if ratio_bound is None else Rigour.FLOATING_POINT
    if scenario.objective == "secrecy-rate":
        rate = min(link.secrecy_rate_bps_hz or 0.0 for link in links)
        bound = None
        if ratio_bound is not None:
            most = float(bound_above(2.0**rate, max(1.0, ratio_bound)))
            bound = max(rate, math.log2(most))  # the logarithm is rounded
        gap = None if bound is None else (bound - rate) / max(rate, LEAST_RATE_BPS_HZ)
        return Objective(
            name="min_secrecy_rate",
            value=rate,
            value_db=math.nan,
            upper_bound=bound,
            relative_gap=gap,
            rigour=rigour,
        )
    name = "min_margin" if scenario.has_margins else "min_sinr"
    value = min(link.sinr if link.margin is None else link.margin for link in links)
    bound = None if ratio_bound is None else float(bound_above(value, ratio_bound))
    return Objective(
        name=name,
        value=value,
        value_db=float(to_db(value)),
        upper_bound=bound,
        relative_gap=None if bound is None else bound / value - 1.0,
        rigour=rigour,
    )
