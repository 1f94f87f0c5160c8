"""Cells of axes, rectangles on the faces of a cube, and the band of an airframe."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.forms import PLACE
from nullpose.certificate.interval import Interval
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family


def cell_ends(cell: IntArray, side: int) -> tuple[FloatArray, FloatArray]:
    """Return the ends of one side of each cell, (b,) each; exact, as dyadic numbers of few bits.

    Args:
        cell: (b, 5) as in :class:`Leaves`.
        side: 0 or 1.
    """
    width: FloatArray = np.ldexp(2.0, -cell[:, 1 + 2 * side])
    low: FloatArray = -1.0 + cell[:, 2 + 2 * side] * width
    return low, low + width


def side_form(cell: IntArray, side: int) -> Interval:
    """Return the form ``(v - low a)(high a - v)`` of one side of each cell, (6, b), not negative inside.

    Args:
        cell: (b, 5) as in :class:`Leaves`, each on a face.
        side: 0 or 1.
    """
    row, a = np.arange(len(cell)), cell[:, 0]
    v = (a + 1 + side) % 3
    low, high = cell_ends(cell, side)
    least = np.zeros((6, len(cell)))
    least[v, row] = -1.0
    least[PLACE[a, v], row] = 0.5 * (low + high)
    most = least.copy()
    ends = -(Interval(low) * high)
    least[a, row], most[a, row] = ends.low, ends.high
    return Interval(least, most)


def off_band_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which leaves hold no axis of the band, wherever their boxes are.

    With one coordinate at 1 and the squares of the two others in intervals, ``u_z^2 / |u|^2`` is largest
    where z is and x and y are not, and the other way round.

    Args:
        family: of no effect.
        field: a free axis within a band.
        leaves: with cells.
        boxes: of no effect.
    """
    cell = leaves.cell
    row, on_face = np.arange(len(cell)), cell[:, 0] >= 0
    face = np.maximum(cell[:, 0], 0)
    least, most = np.ones((3, len(cell))), np.ones((3, len(cell)))
    for side in range(2):
        square = Interval(*cell_ends(cell, side)).squared()
        v = (face + 1 + side) % 3
        least[v, row], most[v, row] = square.low, square.high
    lower, upper = field.band
    # c (x^2 + y^2 + z^2) - z^2 for the greatest z^2 and the least x^2 and y^2, and the other way round
    below = (Interval(least[0]) + least[1] + most[2]) * lower - most[2]
    above = (Interval(most[0]) + most[1] + least[2]) * upper - least[2]
    return np.asarray(on_face & ((below.low > 0.0) | (above.high < 0.0)))
