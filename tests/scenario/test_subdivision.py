"""Looking for a position by halving."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.scenario.reach import find_position

LOWER, UPPER = np.array([-1.0, 0.0, 5.0]), np.array([3.0, 2.0, 6.0])
SEEDS = st.integers(0, 2**32 - 1)


@given(SEEDS, st.floats(0.0, 1.0))
def test_inside_a_ball(seed: int, radius: float) -> None:
    """A ball that reaches into the box is found, one that stays clear of it is ruled out."""
    centre = np.random.default_rng(seed).uniform([-3.0, -2.0, 3.0], [5.0, 4.0, 8.0])
    gap = np.linalg.norm(centre - np.clip(centre, LOWER, UPPER)) - radius
    found, settled = find_position(LOWER, UPPER, lambda at: radius - np.linalg.norm(at - centre, axis=1))
    if abs(gap) > 1e-7:
        assert settled
        assert (found is not None) is bool(gap < 0.0)
    if found is not None:
        assert (found >= LOWER).all()
        assert (found <= UPPER).all()
        assert np.linalg.norm(found - centre) <= radius + 1e-7


def test_outside_balls() -> None:
    """The last corner left free by two balls is found, and missed once the balls grow over it."""
    centres = np.array([[-1.0, 1.0, 5.5], [3.0, 1.0, 5.5]])
    corner_m = np.sqrt(2.0**2 + 1.0**2 + 0.5**2)  # from either centre to the box's middle edges

    def clearance(radius: float) -> object:
        return lambda at: np.linalg.norm(at[:, None] - centres, axis=-1).min(axis=1) - radius

    found, settled = find_position(LOWER, UPPER, clearance(corner_m - 1e-3))
    assert found is not None
    np.testing.assert_allclose(found[0], 1.0, atol=1e-2)
    nothing, settled = find_position(LOWER, UPPER, clearance(corner_m + 1e-3))
    assert nothing is None
    assert settled


def test_touching_counts_as_found() -> None:
    """A single point that is allowed is found, to a billionth of the box."""
    point = np.array([1.0 / 3.0, 0.7, 5.1])
    found, _ = find_position(LOWER, UPPER, lambda at: -np.linalg.norm(at - point, axis=1))
    np.testing.assert_allclose(found, point, atol=1e-7)


def test_flat_and_empty_boxes() -> None:
    """A box may be flat; a reversed one holds nothing."""
    flat = np.array([3.0, 2.0, 5.0])
    found, settled = find_position(LOWER, flat, lambda at: 0.01 - np.abs(at[:, 0] - 2.9))
    assert found[2] == 5.0
    assert abs(found[0] - 2.9) <= 0.01
    empty, settled = find_position(UPPER, LOWER, lambda at: np.ones(len(at)))
    assert empty is None
    assert settled


@pytest.mark.parametrize("depth", [1e-3, 1e-4])
def test_too_fine_to_tell(depth: float) -> None:
    """A sheet that is forbidden by a hair everywhere is neither found nor ruled out in time."""
    found, settled = find_position(LOWER, UPPER, lambda at: -depth - np.abs(at[:, 2] - 5.37))
    assert found is None
    assert not settled
