"""Vertical orientation (paper section 4, case 4): an under-actuated vehicle hovering level."""

from __future__ import annotations

from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.effort import Effort
from nullpose.solve.settle import Settled, settle

__all__ = ["find"]


def find(scenario: Scenario, effort: Effort) -> Settled:
    """Return the best position with the axis vertical.

    Args:
        scenario: what to solve.
        effort: what it may cost.
    """
    return settle(build_family(scenario), [AxisField.vertical()], effort)
