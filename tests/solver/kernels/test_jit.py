"""The kernels' one decorator."""

import math
from collections.abc import Callable

import numpy as np

from nullpose.objectives import Ratios
from nullpose.solver.kernels.linear_algebra.links import link_form


def test_division_by_zero_follows_ieee(ratios_over: Callable[..., Ratios]) -> None:
    """A kernel that divides by zero returns what IEEE says and raises nothing."""
    here = np.array([1.0, 2.0, 3.0])
    assert math.isnan(link_form(ratios_over(here[None], 0.0), 0, here, np.array([0.0, 0.0, 1.0])))
