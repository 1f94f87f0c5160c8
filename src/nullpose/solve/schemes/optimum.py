"""Optimum pose (paper eq. 2.2): position and axis both free."""

from __future__ import annotations

from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.found import Found
from nullpose.solve.multistart import multistart

__all__ = ["find"]


def find(scenario: Scenario, *, seed: int) -> Found:
    """Return the best pose found with the axis free.

    Args:
        scenario: what to solve.
        seed: seed of the multistart.
    """
    return multistart(build_family(scenario), AxisField.free(), seed=seed)
