"""Axis fields: free, or affine in the position."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from paper_schemes import maximum_gain_axis, zero_interference_axis

from nullpose.problem.axis_field import AxisField

SHARES = st.floats(0.0, 1.0)


@given(seed=st.integers(0, 2**32 - 1))
def test_the_paper_s_orientations_are_affine(seed: int, random_problem: Callable) -> None:
    """Eqs. 3.1 and 3.4 are affine in the position, up to the length and the sign of the axis."""
    rng = np.random.default_rng(seed)
    scene = random_problem(rng, 2, 1)
    position = rng.uniform([-20.0, -20.0, 10.0], [120.0, 120.0, 40.0])
    jammer = scene.jammer_positions_m[0]
    first, second = scene.node_positions_m
    null = AxisField.affine(jammer, -np.eye(3))
    np.testing.assert_allclose(null.axis_at(position), zero_interference_axis(position, jammer), atol=1e-14)
    # the columns of the matrix of (s2 - s1) x p are the products with the unit vectors
    across = AxisField.affine(np.cross(first, second), np.cross(second - first, np.eye(3)).T)
    parallel = across.axis_at(position) @ maximum_gain_axis(scene, position)
    assert abs(parallel) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(
    ("offset", "matrix", "name"),
    [
        ([0.0, 1.0], np.eye(3), "offset"),
        ([0.0, math.nan, 1.0], np.eye(3), "offset"),
        ([0.0, 0.0, 1.0], np.eye(2), "matrix"),
        ([0.0, 0.0, 1.0], np.full((3, 3), math.inf), "matrix"),
    ],
)
def test_bad_arrays_are_refused(offset: list, matrix: np.ndarray, name: str) -> None:
    """An array of the wrong shape, or not finite, is refused by name with its shape."""
    with pytest.raises(ValueError, match=f"axis field {name} must be finite, of shape"):
        AxisField.affine(offset, matrix)


@given(SHARES, SHARES)
def test_a_band_keeps_its_ends(one: float, other: float) -> None:
    """What is no single vertical axis is free within its ends; arrays are copies."""
    least, greatest = sorted((one, other))
    field = AxisField.within(least, greatest)
    assert field.is_free is (least < 1.0)
    assert field.band == ((least, greatest) if field.is_free else (0.0, 1.0))
    field.arrays.offset[:] = 9.0
    assert not np.any(field.arrays.offset == 9.0)


@pytest.mark.parametrize(
    "band", [(0.5, 0.4), (-0.1, 0.5), (0.5, 1.1), (math.nan, 0.5), (0.5, math.nan), (math.inf, math.inf)]
)
def test_bands_that_hold_no_axis_are_refused(band: tuple[float, float]) -> None:
    """Ends out of order, out of range or no numbers are refused with what was given."""
    with pytest.raises(ValueError, match=r"band must be 0 <= low <= high <= 1; given \("):
        AxisField.within(*band)
