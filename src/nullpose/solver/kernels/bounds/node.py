"""A node of the tree as a row of numbers: its columns, and how it is split.

Cells of axes are rectangles on the faces of a cube, ``u = (1, y, z)`` up to a cyclic permutation, sign and
length, in the world frame; face -1 is every axis.
"""

from __future__ import annotations

from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into

CENTRE = 0  # the box's centre, m
HALF = 3  # its half sides, m
LEVEL = 6  # the ratio that was excluded
KIND = 7  # the test: of a free axis (in which frame) or of an affine one, FAR, or KEPT_OUT
ANCHOR = 8  # the point that a frame turns towards, the ratio that is FAR, or the ball KEPT_OUT of
FACE = 9  # the cell of axes: its face, or -1
CELL = 10  # and its rectangle: low and high of two coordinates
SIDE = 14  # multipliers of the cell's two sides
BAND = 16  # multiplier of the band: of its upper end, or, if negative, minus that of its lower one
COUNT = 17  # how many ratios have a multiplier
INDEX = 18  # which they are
SUPPORT = 8
WEIGHT = INDEX + SUPPORT  # their multipliers, which sum to one; of a mean those of their requirements
TOUCH = WEIGHT + SUPPORT  # of a mean: the form u u^T of an axis, or a mixture, at which its tangent is taken
BALL = TOUCH + 6  # a keep-out ball that reaches into the box, or -1
NU = BALL + 1  # and the multiplier of staying out of it, 1/m^2
COLUMNS = NU + 1

AFFINE, FAR, KEPT_OUT, OFF_BAND = 2, 3, 4, 5  # kinds beside those of frames, as certificates have them


@inner_kernel
def cell_side(face, cell, side, out):
    """Fill the form ``(v - low a)(high a - v)`` of a cell's side, a being the face's axis, v the side's."""
    a = face
    v = (face + 1 + side) % 3
    low, high = cell[2 * side], cell[2 * side + 1]
    out[:] = 0.0
    out[v] = -1.0
    out[a] = -low * high
    pair = 3 if a + v == 1 else (4 if a + v == 2 else 5)
    out[pair] = 0.5 * (low + high)


@kernel
def keep_largest(weights, total, row, is_mean):
    """Put the largest multipliers into a row, scaled to sum to one unless they are beside those of a mean."""
    chosen = 0
    gathered = 0.0
    for s in range(min(SUPPORT, total)):
        lead = 0
        for k in range(1, total):
            if weights[k] > weights[lead]:
                lead = k
        if not weights[lead] > 1e-4 * max(gathered, 1e-300):
            break
        row[INDEX + s] = lead
        row[WEIGHT + s] = weights[lead]
        gathered += weights[lead]
        weights[lead] = 0.0
        chosen += 1
    row[COUNT] = chosen
    if is_mean:
        return
    for s in range(chosen):
        row[WEIGHT + s] /= gathered
    for side in range(3):  # and the band's
        row[SIDE + side] /= gathered


@inner_kernel
def longest_side(row):
    """Return the longest side of a row's box."""
    side = 0
    for i in range(1, 3):
        if row[HALF + i] > row[HALF + side]:
            side = i
    return side


@inner_kernel
def split_across(row, at, half, low, high):
    """Fill both halves of a box, either of which may be the row itself, cut across one side.

    Its centre and half width stand in the columns ``at`` and ``half``.
    """
    step = 0.5 * row[half]
    copy_into(row, high)
    copy_into(row, low)
    low[half] = high[half] = step
    low[at] -= step
    high[at] += step


@inner_kernel
def split_position(row, side, stack, top):
    """Push the halves of a box, cut across one side; return the new top."""
    split_across(row, CENTRE + side, HALF + side, stack[top], stack[top + 1])
    return top + 2


@inner_kernel
def split_axis(row, is_horizontal, stack, top):
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
    if is_horizontal:
        side = 0 if row[FACE] == 0.0 else 1
    middle = 0.5 * (row[CELL + 2 * side] + row[CELL + 2 * side + 1])
    for child in range(2):
        copy_into(row, stack[top])
        stack[top, CELL + 2 * side + (0 if child else 1)] = middle
        top += 1
    return top


@inner_kernel
def elevations(row):
    """Return the least and the greatest ``u_z^2`` of the axes of a row's cell."""
    face = int(row[FACE])
    if face < 0:
        return 0.0, 1.0
    # squares of the two free coordinates over the cell, the face's own being one
    low, high = scratch(3), scratch(3)
    low[:], high[:] = 1.0, 1.0
    for side in range(2):
        v = (face + 1 + side) % 3
        a, b = row[CELL + 2 * side], row[CELL + 2 * side + 1]
        low[v] = 0.0 if a < 0.0 < b else min(a * a, b * b)
        high[v] = max(a * a, b * b)
    return low[2] / (low[2] + high[0] + high[1]), high[2] / (high[2] + low[0] + low[1])


@inner_kernel
def is_off_band(ends, row):
    """Check whether no axis of a row's cell has its elevation within the band."""
    least, greatest = elevations(row)
    return greatest < ends[0] * (1.0 - 1e-12) or least > ends[1] * (1.0 + 1e-12)
