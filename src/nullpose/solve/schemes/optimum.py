"""Optimum pose (paper eq. 2.2): position and axis both free."""

from __future__ import annotations

from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.effort import Effort
from nullpose.solve.settle import Settled, settle

__all__ = ["find"]


def find(scenario: Scenario, effort: Effort) -> Settled:
    """Return the best pose with the axis free.

    Args:
        scenario: what to solve.
        effort: what it may cost.
    """
    return settle(build_family(scenario), [AxisField.free()], effort)
