"""Cells of errors: rectangles of axes on a face of a cube about the drone, times boxes of offsets.

The axis is ``y = x0 f0 + x1 f1 + x2 f2`` with ``x0 = 1``, of any length.
"""

from __future__ import annotations

from typing import NamedTuple

from nullpose.solver.kernels.bounds.node import split_across
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.linear_algebra.vectors import combination, dot
from nullpose.solver.kernels.search.worst_case import Vector

SLACK = 1e-12  # relative: more than rounding takes from a sum
_SIDES = 5  # of a cell: two of the axis, three of the offset
_CENTRE, HALF = 1, 1 + _SIDES  # columns of a cell's row, after its face
COLUMNS = HALF + _SIDES


class Cell(NamedTuple):
    """A rectangle of axes on a face, times a box of offsets: centres and half sides."""

    face: int
    x: Vector
    x_half: Vector
    d: Vector
    d_half: Vector


@inner_kernel
def cell_of(cells, i):
    """Return a row as a cell."""
    r = cells[i]
    return Cell(int(r[0]), (1.0, r[1], r[2]), (0.0, r[6], r[7]), (r[3], r[4], r[5]), (r[8], r[9], r[10]))


@inner_kernel
def ahead(face):
    """Return the one of a face's three coordinates that lies along the nominal axis."""
    return (3 - face) % 3


@inner_kernel
def axis_at(errors, face, x):
    """Return the axis of a point of a face."""
    frame = errors.frame
    return combination((frame[face], frame[(face + 1) % 3], frame[(face + 2) % 3]), x)


@inner_kernel
def nearest(centre, half):
    """Return the least size of each coordinate."""
    return (
        max(0.0, abs(centre[0]) - half[0]),
        max(0.0, abs(centre[1]) - half[1]),
        max(0.0, abs(centre[2]) - half[2]),
    )


@inner_kernel
def farthest(centre, half):
    """Return the largest size of each coordinate."""
    return abs(centre[0]) + half[0], abs(centre[1]) + half[1], abs(centre[2]) + half[2]


@inner_kernel
def empty_of_errors(errors, cell):
    """Check whether a cell lies outside the cone or outside the ball of offsets."""
    d = nearest(cell.d, cell.d_half)
    if dot(d, d) > errors.reach**2 * (1.0 + SLACK):
        return True
    low, high = nearest(cell.x, cell.x_half), farthest(cell.x, cell.x_half)
    rest = 0.0
    for i in range(3):
        if i != ahead(cell.face):
            rest += low[i] ** 2
    along_cone = (high[ahead(cell.face)] * errors.sine) ** 2
    return along_cone * (1.0 + SLACK) < rest * errors.cosine**2


@inner_kernel
def side_to_split(cell, by_axis, by_offset):
    """Return the side whose halving takes most off a remainder of such curvatures."""
    side, most = 0, -1.0
    for i in range(_SIDES):
        weight = by_axis * cell.x_half[1 + i] ** 2 if i < 2 else by_offset * cell.d_half[i - 2] ** 2
        if weight > most:
            side, most = i, weight
    return side


@inner_kernel
def first_cells(errors, cells):
    """Fill the cells that cover the cone and the ball of offsets; return how many."""
    faces = 3 if errors.sine > 0.999 * errors.cosine else 1
    for face in range(faces):
        half = 1.0
        if face == 0 and errors.cosine > 0.0:
            half = min(1.0, 1.001 * errors.sine / errors.cosine)
        cells[face, 0] = face
        for i in range(_SIDES):
            cells[face, _CENTRE + i] = 0.0
            cells[face, HALF + i] = half if i < 2 else errors.reach * (1.0 + SLACK)
    return faces


@inner_kernel
def split(cells, i, side):
    """Put the halves of cell i in its place and behind it, a hair wider than half."""
    split_across(cells[i], _CENTRE + side, HALF + side, cells[i], cells[i + 1])
    for k in range(i, i + 2):
        cells[k, HALF + side] *= 1.0 + 1e-15
