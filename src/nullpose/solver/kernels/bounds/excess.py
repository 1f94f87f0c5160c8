"""An excess gain's factor by elevation over a box, which multiplies a link whose axis the position gives.

Value and relative slopes at the centre, and bounds on it and on its relative first and second derivatives
over the box, by interval arithmetic; or the end of its range alone, where that leaves out less.
"""

from __future__ import annotations

import math

from nullpose.channel.model import BY_ELEVATION
from nullpose.solver.kernels.bounds.link_field import elevation_range, product, relative_range, square, total
from nullpose.solver.kernels.compiler.jit import inner_kernel, rare_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.channel import elevation_jet
from nullpose.solver.kernels.linear_algebra.symmetric import entry
from nullpose.solver.kernels.linear_algebra.vectors import square_range

EXCESS = 10  # rows: the gain, its three relative slopes, its six relative second derivatives


@inner_kernel
def quotient(a, size):
    """Return bounds on a number over a positive one."""
    return a[0] / size[1 if a[0] > 0.0 else 0], a[1] / size[0 if a[1] > 0.0 else 1]


@inner_kernel
def within_one(a):
    """Return bounds on a cosine."""
    return max(-1.0, a[0]), min(1.0, a[1])


@inner_kernel
def fill_angle_range(r, point, centre, half, slopes, bends):
    """Fill bounds on the derivatives of the elevation over a box: first (3, 2) and second (6, 2).

    In terms of ``linear_algebra.channel.fill_elevation``.
    """
    least, most = square_range(point, centre, half, 2)
    level, s = (math.sqrt(least), math.sqrt(most)), square_range(point, centre, half, 3)
    z = -r[2] - half[2], -r[2] + half[2]
    east = within_one(quotient((-r[0] - half[0], -r[0] + half[0]), level))
    north = within_one(quotient((-r[1] - half[1], -r[1] + half[1]), level))
    across = quotient(quotient((-z[1], -z[0]), level), s)
    outwards = quotient(quotient(product((2.0 * z[0], 2.0 * z[1]), level), s), s)
    inwards = quotient((-z[1], -z[0]), s)
    upright = total(square(z), (-most, -least))
    upright = quotient(quotient(upright, s), s)
    slopes[0], slopes[1], slopes[2] = product(inwards, east), product(inwards, north), quotient(level, s)
    ee, nn = square(east), square(north)
    bends[0] = total(product(outwards, ee), product(across, nn))
    bends[1] = total(product(outwards, nn), product(across, ee))
    bends[2] = -outwards[1], -outwards[0]
    bends[3] = product(product(east, north), total(outwards, (-across[1], -across[0])))
    bends[4], bends[5] = product(upright, east), product(upright, north)


@rare_kernel
def fill_excess(row, r, is_above, point, centre, half, excess):
    """Fill the factor by elevation of an excess gain over a box, (EXCESS, 3): at the centre, and its bounds.

    Args:
        row: of the channel.
        r: from the centre to the point.
        is_above: whether the link is to be bounded from above, else from below.
        point: (3,).
        centre: of the box.
        half: its half sides.
        excess: output.
    """
    excess[:, :] = 0.0
    excess[0, :] = 1.0
    if row[0] != BY_ELEVATION:
        return
    slopes, bends, steep, bent = scratch(3), scratch(3, 3), scratch(3, 2), scratch(6, 2)
    low, high = elevation_range(r, point, centre, half)
    gain, first, _, second = relative_range(row, low, high)
    fill_angle_range(r, point, centre, half, steep, bent)
    at_centre, left_out = elevation_jet(row, r, slopes, bends), 0.0
    for e in range(6):
        i, k = entry(e)
        angle_i, angle_k = (steep[i, 0], steep[i, 1]), (steep[k, 0], steep[k, 1])
        both = square(angle_i) if i == k else product(angle_i, angle_k)
        bounds = total(product(first, (bent[e, 0], bent[e, 1])), product(second, both))
        excess[4 + e, 1], excess[4 + e, 2] = bounds
        left_out += (bounds[1] - bounds[0]) * half[i] * half[k] * (0.25 if i == k else 0.5)
    end = gain[1 if is_above else 0]
    if not left_out * at_centre < abs(end - at_centre):
        excess[:, :] = 0.0
        excess[0, :] = end
        return
    excess[0, 0], excess[0, 1], excess[0, 2] = at_centre, gain[0], gain[1]
    for i in range(3):
        excess[1 + i, 0] = slopes[i]
        excess[1 + i, 1], excess[1 + i, 2] = product(first, (steep[i, 0], steep[i, 1]))
