"""A box of the tree as a row of numbers: its columns, and how it is halved."""

from __future__ import annotations

from nullpose.solve.kernels.jit import inner_kernel, kernel
from nullpose.solve.kernels.symmetric import copy_into

__all__ = [
    "AFFINE",
    "ANCHOR",
    "BALL",
    "BAND",
    "CELL",
    "CENTRE",
    "COLUMNS",
    "COUNT",
    "FACE",
    "FAR",
    "HALF",
    "INDEX",
    "KEPT_OUT",
    "KIND",
    "LEVEL",
    "NU",
    "OFF_BAND",
    "SIDE",
    "SUPPORT",
    "WEIGHT",
    "keep_largest",
    "longest_side",
    "reaching_ball",
    "split_position",
]

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
WEIGHT = INDEX + SUPPORT  # their multipliers, which sum to one
BALL = WEIGHT + SUPPORT  # a keep-out ball that reaches into the box, or -1
NU = BALL + 1  # and the multiplier of staying out of it, 1/m^2
COLUMNS = NU + 1

AFFINE = 2
FAR = 3
KEPT_OUT = 4
OFF_BAND = 5


@kernel
def keep_largest(weights, total, row):
    """Put the largest multipliers, scaled to sum to one, into a row."""
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
    for s in range(chosen):
        row[WEIGHT + s] /= gathered
    for side in range(3):  # and the band's
        row[SIDE + side] /= gathered


@inner_kernel
def reaching_ball(keep_points, keep_radius, row):
    """Return the keep-out ball that reaches farthest into a row's box, or -1 if none does."""
    ball = -1
    least = keep_radius * keep_radius
    for q in range(keep_points.shape[0]):
        d = 0.0
        for i in range(3):
            x = abs(keep_points[q, i] - row[CENTRE + i]) - row[HALF + i]
            if x > 0.0:
                d += x * x
        if d < least:
            ball, least = q, d
    return ball


@inner_kernel
def longest_side(row):
    """Return the longest side of a row's box."""
    side = 0
    for i in range(1, 3):
        if row[HALF + i] > row[HALF + side]:
            side = i
    return side


@inner_kernel
def split_position(row, side, stack, top):
    """Push the halves of a box, cut across one side; return the new top."""
    for child in range(2):
        copy_into(row, stack[top])
        stack[top, HALF + side] = 0.5 * row[HALF + side]
        stack[top, CENTRE + side] += (0.5 if child else -0.5) * row[HALF + side]
        top += 1
    return top
