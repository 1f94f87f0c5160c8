"""Cells of axes: their ends are exact, and those called out of reach hold no axis of the band."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.certificate.plain import boxes_at, make_leaves, seeds

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.forms import cell_ends, quadratic, side_form
from nullpose.certificate.plain_tests import off_band_holds
from nullpose.problem.axis_field import AxisField

NO_FAMILY = None  # the test of a cell does without


def cells_of(rng: np.random.Generator, count: int, deepest: int) -> np.ndarray:
    """Return cells on the three faces."""
    depth = rng.integers(0, deepest + 1, (count, 2))
    index = [[int(rng.integers(1 << int(d))) for d in row] for row in depth]
    face = rng.integers(3, size=count)
    return np.array([[f, d[0], i[0], d[1], i[1]] for f, d, i in zip(face, depth, index, strict=True)])


def exact_ends(cell: np.ndarray, side: int) -> tuple[Fraction, Fraction]:
    """Return the ends of a cell's side as fractions."""
    width = Fraction(2, 2 ** int(cell[1 + 2 * side]))
    low = -1 + width * int(cell[2 + 2 * side])
    return low, low + width


def boxes_for(count: int) -> Boxes:
    """Return a box for each leaf: positions do not matter here."""
    return boxes_at(np.zeros((count, 3)), np.ones((count, 3)))


@given(seed=seeds)
def test_ends_are_exact(seed: int) -> None:
    """Down to the deepest cell, the ends are the dyadic numbers that they stand for."""
    cells = cells_of(np.random.default_rng(seed), 20, 50)
    for side in range(2):
        low, high = cell_ends(cells, side)
        for i, cell in enumerate(cells):
            assert (Fraction(float(low[i])), Fraction(float(high[i]))) == exact_ends(cell, side)


@given(seed=seeds)
def test_side_forms_vanish_at_the_ends(seed: int) -> None:
    """A side's form is zero where the axis is at either of its ends, and positive between them."""
    cells = cells_of(np.random.default_rng(seed), 10, 20)
    for side in range(2):
        form = side_form(cells, side)
        for i, cell in enumerate(cells):
            ends = [float(x) for x in exact_ends(cell, side)]
            u = np.ones(3)
            for share, sign in ((0.0, 0), (0.5, 1), (1.0, 0)):
                u[(cell[0] + 1 + side) % 3] = ends[0] + share * (ends[1] - ends[0])
                size = (ends[1] - ends[0]) ** 2
                assert quadratic(form.middle()[:, i], u) == pytest.approx(0.25 * sign * size, abs=1e-15)


def elevations(cell: np.ndarray) -> tuple[Fraction, Fraction]:
    """Return the least and the greatest ``u_z^2`` of a cell, exactly."""
    low, high = [Fraction(1)] * 3, [Fraction(1)] * 3
    for side in range(2):
        a, b = exact_ends(cell, side)
        v = int(cell[0] + 1 + side) % 3
        low[v] = Fraction(0) if a < 0 < b else min(a * a, b * b)
        high[v] = max(a * a, b * b)
    return low[2] / (low[2] + high[0] + high[1]), high[2] / (high[2] + low[0] + low[1])


@given(seed=seeds, band=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)).map(sorted))
def test_cells_off_the_band_hold_none_of_its_axes(seed: int, band: list) -> None:
    """A cell passes exactly if its elevations miss the band, but for rounding."""
    rng = np.random.default_rng(seed)
    cells = cells_of(rng, 30, 6)
    cells[0] = [-1, 0, 0, 0, 0]
    if tuple(band) == (1.0, 1.0):
        return
    field = AxisField.within(*band)
    holds = off_band_holds(NO_FAMILY, field, make_leaves(30, cell=cells), boxes_for(30))
    assert not holds[0]
    for cell, held in zip(cells[1:], holds[1:], strict=True):
        least, most = elevations(cell)
        below, above = Fraction(band[0]) - most, least - Fraction(band[1])
        if held:
            assert max(below, above) > 0
        else:
            assert max(below, above) < 1e-12
