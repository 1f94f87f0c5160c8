"""The kernels' one decorator."""

import math

import numpy as np

from nullpose.solve.kernels.links import link_form


def test_division_by_zero_follows_ieee() -> None:
    """A kernel that divides by zero returns what IEEE says and raises nothing."""
    points = np.array([[1.0, 2.0, 3.0]])
    assert math.isnan(
        link_form(points, np.zeros((0, 3, 3)), 0, np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 1.0]))
    )
