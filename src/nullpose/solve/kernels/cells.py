"""Cells of axes and what confines an axis: the two sides of its cell, the two ends of a band.

Cells are rectangles on the faces of a cube, ``u = (1, y, z)`` up to a cyclic permutation, sign and length, in
the world frame; face -1 is every axis.
"""

from __future__ import annotations

from nullpose.solve.kernels.box import BAND, CELL, FACE, SIDE
from nullpose.solve.kernels.jit import inner_kernel
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.symmetric import copy_into

__all__ = ["CONSTRAINTS", "constraint", "constraint_multiplier", "is_level", "off_band", "split_axis"]

CONSTRAINTS = 4
"""The two sides of a cell, then the lower and the upper end of a band."""


@inner_kernel
def is_level(axis_field):
    """Return whether an axis field holds the level axes only."""
    return axis_field.kind == 3 and axis_field.offset[1] == 0.0


@inner_kernel
def constraint(axis_field, row, q, form):
    """Fill the form of constraint q, at least zero at all axes of a row, but for an isotropic part.

    Of a side, ``(v - low a)(high a - v)``, a being the face's axis and v the side's; of the band's ends,
    ``u_z^2`` and minus that. Where all axes are level, only the side in the level plane counts.

    Returns:
        (whether there is one, the isotropic part).
    """
    form[:] = 0.0
    face = int(row[FACE])
    if q < 2:
        if face < 0 or (is_level(axis_field) and q != (0 if face == 0 else 1)):
            return False, 0.0
        v, low, high = (face + 1 + q) % 3, row[CELL + 2 * q], row[CELL + 2 * q + 1]
        form[v] = -1.0
        form[face] = -low * high
        form[2 + face + v] = 0.5 * (low + high)
        return True, 0.0
    end = axis_field.offset[q - 2]
    if axis_field.kind < 2 or is_level(axis_field) or not 0.0 < end < 1.0:
        return False, 0.0
    form[2] = 1.0 if q == 2 else -1.0
    return True, -end if q == 2 else end


@inner_kernel
def constraint_multiplier(row, q):
    """Return the multiplier that a row has of constraint q."""
    if q < 2:
        return row[SIDE + q]
    return max(0.0, -row[BAND] if q == 2 else row[BAND])


@inner_kernel
def split_axis(row, level_axes, stack, top):
    """Push the parts of a cell of axes, three faces or two halves; return the new top.

    Where all axes are level, only the coordinate in the level plane is cut.
    """
    if row[FACE] < 0.0:
        for face in range(3):
            copy_into(row, stack[top])
            stack[top, FACE] = face
            stack[top, BAND] = 0.0
            for side in range(2):
                stack[top, CELL + 2 * side], stack[top, CELL + 2 * side + 1] = -1.0, 1.0
                stack[top, SIDE + side] = 0.0
            top += 1
        return top
    side = 0 if row[CELL + 1] - row[CELL] >= row[CELL + 3] - row[CELL + 2] else 1
    if level_axes:
        side = 0 if row[FACE] == 0.0 else 1
    middle = 0.5 * (row[CELL + 2 * side] + row[CELL + 2 * side + 1])
    for child in range(2):
        copy_into(row, stack[top])
        stack[top, CELL + 2 * side + (0 if child else 1)] = middle
        top += 1
    return top


@inner_kernel
def off_band(ends, row):
    """Return whether no axis of a row's cell has its elevation within the band."""
    face = int(row[FACE])
    if face < 0:
        return False
    # squares of the two free coordinates over the cell, the face's own being one
    low, high = scratch(3), scratch(3)
    low[:], high[:] = 1.0, 1.0
    for side in range(2):
        v = (face + 1 + side) % 3
        a, b = row[CELL + 2 * side], row[CELL + 2 * side + 1]
        low[v] = 0.0 if a < 0.0 < b else min(a * a, b * b)
        high[v] = max(a * a, b * b)
    least = low[2] / (low[2] + high[0] + high[1])
    most = high[2] / (high[2] + low[0] + low[1])
    return most < ends[0] * (1.0 - 1e-12) or least > ends[1] * (1.0 + 1e-12)
