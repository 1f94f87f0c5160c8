"""Whether an airspace, less the keep-out balls, is empty."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.scenario import Airspace
from nullpose.scenario.reach import may_hold_a_position

Range = tuple[float, float]


def has_room(x_m: Range, y_m: Range, altitude_m: Range, centres: np.ndarray, radius: float) -> bool:
    """Returns whether a box holds a position outside balls."""
    airspace = Airspace(keep_out_m=radius, x_m=x_m, y_m=y_m, altitude_m=altitude_m)
    return may_hold_a_position(airspace, centres)


@pytest.mark.parametrize("excess", [-0.002, 0.002])
def test_room_left_inside_a_face_only(excess: float) -> None:
    """Discs on a triangular lattice leave a hole until the radius is the side over the square root of 3."""
    rows, columns = np.meshgrid(np.arange(-6, 7), np.arange(-6, 7))
    lattice = np.stack([columns + 0.5 * rows, rows * np.sqrt(0.75), 0.0 * rows], axis=-1).reshape(-1, 3)
    centres = lattice[np.abs(lattice[:, :2]).max(axis=1) < 2.5]
    # A box around the hole between (0, 0), (1, 0) and (1/2, sqrt(3)/2).
    radius = 1.0 / np.sqrt(3.0) + excess
    assert has_room((0.4, 0.6), (0.2, 0.4), (0, 0), centres, radius) is (excess < 0.0)


def test_many_balls_in_few_seconds() -> None:
    """A hundred balls, none of which covers the box alone, are judged by all their triples."""
    centres = np.random.default_rng(7).uniform(-0.5, 1.5, size=(100, 3))
    assert not has_room((0, 1), (0, 1), (0, 1), centres, 0.8)


coordinate = st.integers(-8, 8).map(lambda eighth: eighth / 8.0)
corner = st.integers(0, 3).map(lambda quarter: quarter / 4.0)


@given(
    st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=1, max_size=7, unique=True),
    st.tuples(corner, corner, corner),
    st.floats(0.3, 1.4),
)
def test_agrees_with_sampling(
    centres: list[tuple[float, ...]], sides: tuple[float, ...], radius: float
) -> None:
    """Where a position of a dense grid is free there is room; where all are deep in balls there is none."""
    axes = [np.linspace(0.0, side, 17 if side else 1) for side in sides]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    clearance = np.linalg.norm(grid[:, None] - np.array(centres), axis=-1).min(axis=1).max() - radius
    spacing = np.linalg.norm(np.array(sides) / 16.0) / 2.0  # no position is farther than this from the grid
    room = has_room(*((0.0, side) for side in sides), np.array(centres), radius)
    if clearance >= 0.0:
        assert room
    elif clearance < -spacing:
        assert not room
