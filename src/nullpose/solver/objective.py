"""The number that was maximised, the bound on it, and the status that follows from the two."""

from __future__ import annotations

import math
from dataclasses import dataclass

from nullpose.errors import SolveError, require
from nullpose.files import PlainTable
from nullpose.objectives import Quantity
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.rigour import Rigour, Status, bound_above

_ROUNDING = 1e-6  # of a gap, by the rounding of value and bound: 1e-9 of a ratio is 1e-6 of the least rate


@dataclass(frozen=True, slots=True, kw_only=True)
class Objective:
    """The number that was maximised, evaluated at the reported pose, and what is proved about it.

    Args:
        quantity: what the number is of, and its unit, as the smallest SINR over the nodes (paper eq. 2.2).
        value: that number: a power ratio, or bits/s/Hz for a rate.
        value_db: the same in dB; not a number for a rate.
        upper_bound: no pose exceeds this; None if nothing is proved.
        relative_gap: ``(upper_bound - value) / value``, a rate below 1e-3 bits/s/Hz counting as so much; None
            if nothing is proved.
        rigour: how sure the bound is.
    """

    quantity: Quantity
    value: float
    value_db: float
    upper_bound: float | None = None
    relative_gap: float | None = None
    rigour: Rigour = Rigour.NONE

    @property
    def name(self) -> str:
        """The name of its quantity, as in ``"min_sinr"``."""
        return self.quantity.name

    @property
    def value_mbps(self) -> float | None:
        """The value in Mbit/s; None without a bandwidth, or for no rate."""
        return None if (factor := self.quantity.mbps) is None else factor * self.value

    @property
    def upper_bound_mbps(self) -> float | None:
        """The bound in Mbit/s; None likewise, or if nothing is proved."""
        factor, bound = self.quantity.mbps, self.upper_bound
        return None if factor is None or bound is None else factor * bound

    @property
    def rates(self) -> PlainTable:
        """Both in Mbit/s as plain data; nothing where there are none."""
        names = () if self.value_mbps is None else ("value_mbps", "upper_bound_mbps")
        return {name: getattr(self, name) for name in names}

    def to_dict(self) -> PlainTable:
        """Write value and bound as plain data for JSON; None for a number that JSON cannot hold."""
        return {
            "name": self.name,
            "value": self.value,
            "value_db": _finite(self.value_db),
            "upper_bound": self.upper_bound,
            "relative_gap": _finite(self.relative_gap),
            **self.rates,
        }


def objective_of(
    scenario: Scenario, value: float, ratio_bound: float | None, rigour: Rigour | None = None
) -> Objective:
    """Report the value at a pose with the bound that was proved.

    Args:
        scenario: what it asks for decides which number it is.
        value: that number.
        ratio_bound: no pose has its smallest ratio above this; None if nothing is proved.
        rigour: of the numbers; without it floating-point if there is a bound.

    Raises:
        SolveError: the bound is below the value: a fault of nullpose.
    """
    quantity = Quantity.of(scenario)
    bound = gap = None
    if ratio_bound is not None:
        ratio = quantity.to_ratio(value)
        bound = max(value, quantity.of_ratio(float(bound_above(ratio, ratio_bound))))  # log2 is rounded
        gap = quantity.gap(value, bound)
    return Objective(
        quantity=quantity,
        value=value,
        value_db=math.nan if quantity.is_rate else quantity.in_unit(value),
        upper_bound=bound,
        relative_gap=gap,
        rigour=rigour or (Rigour.NONE if bound is None else Rigour.FLOATING_POINT),
    )


def status_of(objective: Objective, requested_gap: float, reason: str) -> tuple[Status, str]:
    """Decide from the reported numbers how a solve ended and why not better.

    Certified means that the reported gap, by the quantity's own rule, is at most the one requested.

    Args:
        objective: value and bound, as reported.
        requested_gap: relative.
        reason: why the solver's proof stopped short of that gap; empty if it says that it did not.

    Raises:
        SolveError: the solver says that the gap is reached and the reported numbers do not, by more than
            1e-6: a fault of nullpose.
    """
    if (gap := objective.relative_gap) is None:
        return Status.BEST_FOUND, reason
    if gap <= requested_gap:
        return Status.CERTIFIED, reason if reason == INTERRUPT else ""
    require(
        SolveError,
        reason or not gap > requested_gap + _ROUNDING * (1.0 + requested_gap),
        f"the proof reached a relative gap of {requested_gap:g}, but the reported value "
        f"{objective.value!r} and bound {objective.upper_bound!r} are {gap:.3g} apart; "
        "this is a fault of nullpose: please report it with the scenario",
    )
    return Status.GAP_NOT_REACHED, reason or "the rounding of value and bound"


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
