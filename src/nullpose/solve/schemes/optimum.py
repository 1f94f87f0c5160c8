"""Optimum pose (paper eq. 2.2): position and axis both free, the latter as far as the airframe reaches."""

from __future__ import annotations

from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.effort import Effort
from nullpose.solve.settle import Settled, settle

__all__ = ["find"]


def find(scenario: Scenario, effort: Effort) -> Settled:
    """Return the best pose with any axis that the airframe reaches.

    Args:
        scenario: what to solve.
        effort: what it may cost.
    """
    return settle(build_family(scenario), [AxisField.within(*scenario.axis_band)], effort)
