"""Cells of poses, and how the way to a point moves in body axes while the pose moves within one.

A pose is ``Q = S Ry(u) Rx(v) Rz(spin) A(p)``, body from world. A(p) turns the way to the cell's anchor, a
ground point, to the third axis: ``A = Rx(-beta) Ry(-alpha)`` with the anchor's longitude alpha and latitude
beta. So the anchor's direction in the body is a matter of u and v alone, a latitude and a longitude about the
middle of one of six faces, which S turns to. Coordinates of positions and of the body are taken in cyclic
order from ``row[CHART]`` and ``row[FACE]`` on: the poles are then far from where the cell is. The zenith as
an anchor, in the first chart, has A = I: u and v then say where the body sees the vertical.

An antenna that is the same all round hears the same under ``Rz(-spin) Q`` and ``Rz(spin) Q``, v being zero.
Near the anchor and opposite to it they turn by less than Q: ``2 sin(u/2)`` and ``2 cos(u/2)`` times as much.
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.bounds.constants import DIRECTION_BEND
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.vectors import (
    along,
    combination,
    cross,
    dot,
    minus,
    norm,
    over,
    row,
    scaled,
    store,
)

_UNWOUND = 0.75  # least cosine of the angle to the anchor's line at which spins are unwound
CENTRE, HALF, FACE, CHART, ANCHOR, BAND, WARM = 0, 6, 12, 13, 14, 15, 16
"""A cell's row: middle and half-widths of position, u, v and spin; its face, its chart, the index of its
anchor, -1 for the zenith, and the multipliers to begin with: that of the reach, and those of the ratios."""


@inner_kernel
def cyclic(array, first):
    """Return three numbers in cyclic order from one on."""
    return array[first % 3], array[(first + 1) % 3], array[(first + 2) % 3]


@inner_kernel
def into_body(face, a):
    """Return a vector of a face's axes in those of the body."""
    if face >= 3:
        a = (-a[0], a[1], -a[2])
    first = face % 3
    if first == 0:
        return a
    return (a[2], a[0], a[1]) if first == 1 else (a[1], a[2], a[0])


@inner_kernel
def fill_frame(cell, anchor_m, frame):
    """Fill how a cell's middle is turned and how that changes with its coordinates, in body axes.

    ``frame[0:3]`` are the images of the chart's axes: the columns of the rotation to the body.
    ``frame[3 + i]`` is what the body turns about, and how fast, as coordinate i grows: ``Q_i = w_i x Q``,
    positions in the chart's order, then u, v and spin. ``frame[9 + 3 i + j]`` is the derivative of w_i for
    position i along position j, as the anchor's frame sees it.

    Args:
        cell: the cell.
        anchor_m: from its middle to the anchor, in the chart's order.
        frame: output, (18, 3).
    """
    face = int(cell[FACE])
    cu, su, cv, sv = math.cos(cell[3]), math.sin(cell[3]), math.cos(cell[4]), math.sin(cell[4])
    c, s = math.cos(cell[5]), math.sin(cell[5])
    third = into_body(face, (su * cv, -sv, cu * cv))
    by_u, by_v = (cu, 0.0, -su), (su * sv, cv, cu * sv)
    first = into_body(face, along(scaled(c, by_u), s, by_v))
    second = into_body(face, along(scaled(c, by_v), -s, by_u))
    axes = (first, second, third)  # of the anchor's frame
    x, y, z = anchor_m
    flat = x * x + z * z
    level, square = math.sqrt(flat), flat + y * y
    length = math.sqrt(square)
    ca, sa, cb, sb = z / level, x / level, level / length, -y / length
    store(combination(axes, (ca, sa * sb, sa * cb)), frame[0])
    store(combination(axes, (0.0, cb, -sb)), frame[1])
    store(combination(axes, (-sa, ca * sb, ca * cb)), frame[2])
    store(into_body(face, (0.0, 1.0, 0.0)), frame[6])
    store(into_body(face, by_u), frame[7])
    store(third, frame[8])
    # of alpha = atan2(x, z) and beta = -atan2(y, level), by the way's coordinates
    slope_a = (z / flat, 0.0, -x / flat)
    xx, xz = -2.0 * x * z / flat**2, (x * x - z * z) / flat**2
    bend_a = ((xx, 0.0, xz), (0.0, 0.0, 0.0), (xz, 0.0, -xx))
    by_y, by_level = -level / square, y / square
    yy, y_level = 2.0 * y * level / square**2, -(y * y - flat) / square**2
    ox, oz = x / level, z / level
    xx = -yy * ox**2 + by_level * oz**2 / level
    zz = -yy * oz**2 + by_level * ox**2 / level
    xz = -yy * ox * oz - by_level * ox * oz / level
    slope_b = (by_level * ox, by_y, by_level * oz)
    xy, yz = y_level * ox, y_level * oz
    bend_b = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    for i in range(3):
        store(combination(axes, (slope_b[i], slope_a[i] * cb, -slope_a[i] * sb)), frame[3 + i])
        for j in range(3):
            # the pole's image (0, cb, -sb) turns by -beta_j; the position moves against the way
            turn = slope_a[i] * slope_b[j]
            bent = (-bend_b[i][j], turn * sb - bend_a[i][j] * cb, turn * cb + bend_a[i][j] * sb)
            store(combination(axes, bent), frame[9 + 3 * i + j])


@inner_kernel
def in_body(frame, vector):
    """Return a way in the chart's order in body axes."""
    return combination((row(frame, 0), row(frame, 1), row(frame, 2)), vector)


@inner_kernel
def move(frame, a, pace, firsts, seconds):
    """Fill how the way to a point, or a direction of the world, moves in body axes, to second order.

    Args:
        frame: of the cell.
        a: the way at its middle, in body axes.
        pace: 1 for a way, which shortens as the position moves along it, or 0 for a direction.
        firsts: output, (6, 3): derivatives along the coordinates.
        seconds: output, (6, 6, 3): likewise; the upper half.
    """
    for i in range(3):
        store(along(cross(row(frame, 3 + i), a), -pace, row(frame, i)), firsts[i])
        store(cross(row(frame, 6 + i), a), firsts[3 + i])
    for i in range(3):
        about, step, slope = row(frame, 3 + i), row(frame, i), row(firsts, i)
        for j in range(i, 3):
            bent = along(cross(row(frame, 9 + 3 * i + j), a), 1.0, cross(about, row(firsts, j)))
            store(along(bent, -pace, cross(row(frame, 3 + j), step)), seconds[i, j])
            store(cross(row(frame, 6 + i), row(firsts, 3 + j)), seconds[3 + i, 3 + j])
        for j in range(3):
            store(cross(row(frame, 6 + j), slope), seconds[i, 3 + j])


@inner_kernel
def unwound(cell, spins):
    """Return the turn about the body's axis a radian of spin, -1, 0 or 1, by which frames turn least."""
    if not spins or abs(math.cos(cell[3])) < _UNWOUND:
        return 0.0
    return -math.copysign(1.0, math.cos(cell[3]))


@inner_kernel
def rates(cell, spins, reach_m, anchor_m, anchor_near_m):
    """Bound how fast a cell's frames turn along any straight line from its middle into it.

    Bounds of the turning, of its first and of its second derivative, for the frame that holds the anchor
    alone and for the whole; infinite where the chart's pole is too near.

    Args:
        cell: the cell.
        spins: whether the antenna is the same all round.
        reach_m: half-diagonal of its positions.
        anchor_m: from its middle to the anchor, in the chart's order.
        anchor_near_m: the least distance between anchor and cell.
    """
    hu, hv, hs = cell[9], cell[10], cell[11]
    wy = math.hypot(hu, hv)
    held = (wy, hu * hv, hu * hu * hv)
    we, we2 = wy + hs, hu * hv + hs * wy
    we3 = held[2] + hs * (hu * hv + wy * wy)
    if spins:
        we = math.hypot(hu, hs)
    if unwound(cell, spins) != 0.0:  # the largest sin u, and 2 sin(u/2) or 2 cos(u/2)
        across = min(1.0, abs(math.sin(cell[3])) + hu)
        chord = min(2.0, math.sqrt(2.0 - 2.0 * abs(math.cos(cell[3]))) + hu)
        we, we2 = math.hypot(hu, chord * hs), hs * math.hypot(2.0 * hu, hs * across)
        we3 = hs * (3.0 * hu * hs + across * hs * hs + hu * hu)
    level = math.hypot(anchor_m[0], anchor_m[2]) - reach_m
    if level <= 0.0 or anchor_near_m <= 0.0:
        return held, (math.inf, math.inf, math.inf)
    high = abs(anchor_m[1]) + reach_m
    sb = min(1.0, high / math.hypot(high, level))  # of the largest latitude
    k = 1.0 / math.sqrt(max(1e-12, 1.0 - sb * sb))
    e, ea = reach_m / anchor_near_m, reach_m / level
    alpha = (ea, ea * ea, 2.0 * ea**3)  # of the angle to a point on a straight line
    b1, b2 = e, k * (DIRECTION_BEND + sb) * e * e
    b3 = 3.0 * k * e**3 + 3.0 * sb * k * b1 * b2 + b1**3
    r1 = min(k * e, math.hypot(alpha[0], b1))
    r2 = math.sqrt(b2 * b2 + alpha[1] ** 2 + (alpha[0] * b1) ** 2)
    r3 = math.sqrt(
        b3 * b3 + (alpha[2] + alpha[0] * b1 * b1) ** 2 + (2.0 * alpha[1] * b1 + alpha[0] * b2) ** 2
    )
    turning = we + r1
    second = we2 + we * r1 + r2
    third_rate = we3 + we2 * r1 + we * we * r1 + 2.0 * we * r2 + r3
    return held, (turning, second, third_rate)


@inner_kernel
def direction_rate(cell, spins, frame, a, turning, away):
    """Bound how far the direction to a point moves from a cell's middle into it, radians.

    From its derivatives at the middle, and a bound on the second derivative between; or from the turning and
    the way moved alone, where that is less.

    Args:
        cell: the cell.
        spins: whether the antenna is the same all round.
        frame: its frame.
        a: the way to the point at its middle, in body axes.
        turning: bounds of the turning and of its derivatives.
        away: distance moved over the least distance.
    """
    whole = turning[0] + away
    if not whole < 1.0:
        return whole
    length = norm(a)
    b = over(a, length)
    sides, steps, total = cyclic(cell[HALF : HALF + 3], int(cell[CHART])), scratch(6, 3), 0.0
    for i in range(3):
        shift = minus(cross(row(frame, 3 + i), b), over(row(frame, i), length))
        store(scaled(sides[i], shift), steps[i])
        store(scaled(cell[HALF + 3 + i], cross(row(frame, 6 + i), b)), steps[3 + i])
    turn = cell[HALF + 5] * unwound(cell, spins)
    store(along(row(steps, 5), turn, cross((0.0, 0.0, 1.0), b)), steps[5])
    for i in range(6):
        along_i = dot(steps[i], b)
        for j in range(i, 6):
            both = abs(dot(steps[i], steps[j]) - along_i * dot(steps[j], b))
            total += both if i == j else 2.0 * both
    between = turning[1] + turning[0] ** 2 + 2.0 * turning[0] * away + DIRECTION_BEND * away * away
    return min(whole, math.sqrt(total) + between)


@inner_kernel
def third(turning, v, e, away, g0, g1, g2, g3):
    """Return a bound on a sixth of the third derivative of ``g(b) / r^2``, times the least r^2.

    Along a straight line in the cell's coordinates, from its middle into it. ``|b'|`` is at most v
    and the derivatives of ``1 / r^2`` at most ``2 e``, ``6 e^2`` and ``24 e^3`` of it.

    Args:
        turning: bounds of the turning w of the frame that b is held in, and of its two derivatives.
        v: how far b moves.
        e: way over least distance.
        away: the same for the direction's part of it: 0 for the anchor, which the frame follows.
        g0: largest gain over the directions met.
        g1: its largest derivative.
        g2: its largest second derivative.
        g3: its largest third derivative.
    """
    w1, w2, w3 = turning
    bent = w2 + 0.5 * w1 * w1 + 2.0 * w1 * away + away * away
    jerk = (
        w3
        + 3.0 * w2 * w1
        + w1**3
        + 3.0 * (w2 + w1 * w1) * away
        + 3.0 * w1 * DIRECTION_BEND * away**2
        + 3.0 * away**3
    )
    curve = g3 * v**3 + 3.0 * g2 * v * bent + g1 * (jerk + v**3)
    return (24.0 * e**3 * g0 + 18.0 * e * e * g1 * v + 6.0 * e * (g2 * v * v + g1 * bent) + curve) / 6.0
