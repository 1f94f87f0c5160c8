"""Vertical orientation (paper section 4, case 4): an under-actuated vehicle hovering level."""

from __future__ import annotations

import numpy as np

from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.found import Found
from nullpose.solve.multistart import multistart

__all__ = ["axis_field", "find"]


def axis_field() -> AxisField:
    """Return the field that is vertical everywhere."""
    return AxisField.affine([0.0, 0.0, 1.0], np.zeros((3, 3)))


def find(scenario: Scenario, *, seed: int) -> Found:
    """Return the best position found with the axis vertical.

    Args:
        scenario: what to solve.
        seed: seed of the multistart.
    """
    return multistart(build_family(scenario), axis_field(), seed=seed)
