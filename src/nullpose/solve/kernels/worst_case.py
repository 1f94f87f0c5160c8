"""The worst error case of one ratio at a pose: its value at errors, and a descent over them.

A ratio is ``(a + c |y x v|^2) / (1 + sum_j b_j L_j)``, ``v`` the inverted point of the numerator and ``L_j``
the strongest link that jammer j's set allows. Errors are an axis y within a cone about the nominal one and an
offset d of the position, |d| at most so much; a jammer's place within its set is worst for itself.

A ratio travels as ``(a, c, node, b, centres, radii, axes, semi)``: the node and the centres of the jammers'
sets from the nominal position, a ball of radius ``radii[j]`` or, where that is negative, an ellipsoid with
the columns of ``axes[j]`` as its axes and the half lengths ``semi[j]``; both None if all are balls. Errors
travel as ``(frame, cosine, sine, reach)``: rows of the frame are the nominal axis and two across it.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.jit import inner_heap_kernel, inner_kernel
from nullpose.solve.kernels.worst_case_links import loudest

__all__ = ["descend", "into_cone", "ratio_at", "worst_found"]

_LOOSE = 1e-3  # tolerance of an ellipsoid's strongest link in the search, which asks for what is attained
_STEPS = 200
_SMALL = 1e-13


@inner_kernel
def link_gradient(y, q, scale, by_axis, by_offset):
    """Add the derivatives, by the axis and by an offset of the position, of ``scale |y x q|^2 / |q|^4``."""
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
    along = y[0] * q[0] + y[1] * q[1] + y[2] * q[2]
    quartic = square * square
    link = (square - along * along) / quartic
    for i in range(3):
        by_axis[i] += 2.0 * scale * (y[i] * square - along * q[i]) / quartic
        by_offset[i] -= scale * (2.0 * (q[i] - along * y[i]) / quartic - 4.0 * link * q[i] / square)


@inner_heap_kernel
def ratio_at(ratio, y, offset, places, by_axis, by_offset):
    """Return the ratio at an axis y (unit) and an offset, the jammers at their worst.

    Fills the jammers' places from the actual position and the derivatives by the axis and by the offset.
    """
    a, c, node, b, centres, radii, axes, semi = ratio
    n_links = b.shape[0]
    q = np.empty(3)
    jamming_y, jamming_d = np.zeros(3), np.zeros(3)
    denominator = 1.0
    for j in range(n_links):
        for i in range(3):
            q[i] = centres[j, i] - offset[i]
        link, _ = loudest(radii[j], axes, semi, j, y, q, _LOOSE, places[j])
        denominator += b[j] * link * link
        if link < math.inf:
            link_gradient(y, places[j], b[j], jamming_y, jamming_d)
    for i in range(3):
        q[i] = node[i] - offset[i]
        by_axis[i] = by_offset[i] = 0.0
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
    if not (square > 0.0 and denominator < math.inf):
        return 0.0
    w0, w1, w2 = y[1] * q[2] - y[2] * q[1], y[2] * q[0] - y[0] * q[2], y[0] * q[1] - y[1] * q[0]
    value = (a + c * (w0 * w0 + w1 * w1 + w2 * w2) / (square * square)) / denominator
    link_gradient(y, q, c, by_axis, by_offset)
    for i in range(3):
        by_axis[i] = (by_axis[i] - value * jamming_y[i]) / denominator
        by_offset[i] = (by_offset[i] - value * jamming_d[i]) / denominator
    return value


@inner_heap_kernel
def into_cone(errors, y):
    """Overwrite y with the unit vector of the cone that is nearest to its line."""
    frame, cosine, sine = errors[:3]
    part = np.zeros(3)
    for m in range(3):
        for i in range(3):
            part[m] += frame[m, i] * y[i]
    if part[0] < 0.0:
        for m in range(3):
            part[m] = -part[m]
    across = math.sqrt(part[1] * part[1] + part[2] * part[2])
    length = math.sqrt(part[0] * part[0] + across * across)
    if across > 0.0 and across * cosine > part[0] * sine:
        part[0], part[1], part[2] = cosine, sine * part[1] / across, sine * part[2] / across
        length = 1.0
    for i in range(3):
        y[i] = (part[0] * frame[0, i] + part[1] * frame[1, i] + part[2] * frame[2, i]) / length


@inner_kernel
def into_ball(reach, offset):
    """Overwrite an offset with the nearest one that is no longer than the reach."""
    length = math.sqrt(offset[0] ** 2 + offset[1] ** 2 + offset[2] ** 2)
    if length > reach:
        for i in range(3):
            offset[i] *= reach / length


@inner_heap_kernel
def descend(ratio, errors, y, offset, places):
    """Return the ratio at a local minimum over the errors, downhill from y and offset, which it overwrites.

    Projected gradient, each error measured by its largest size, with steps that grow and shrink.
    """
    angle, reach = math.atan2(errors[2], errors[1]), errors[3]
    gy, gd, hy, hd = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    y_new, d_new = np.empty(3), np.empty(3)
    value = ratio_at(ratio, y, offset, places, gy, gd)
    step = -1.0
    for _ in range(_STEPS):
        along = gy[0] * y[0] + gy[1] * y[1] + gy[2] * y[2]
        slope_y = slope_d = 0.0
        for i in range(3):
            gy[i] -= along * y[i]
            slope_y += gy[i] * gy[i]
            slope_d += gd[i] * gd[i]
        slope = angle * math.sqrt(slope_y) + reach * math.sqrt(slope_d)
        if not slope > _SMALL * value:
            break
        if step < 0.0:
            step = 4.0 / slope
        moved = False
        for _ in range(40):
            for i in range(3):
                y_new[i] = y[i] - step * angle * angle * gy[i]
                d_new[i] = offset[i] - step * reach * reach * gd[i]
            into_cone(errors, y_new)
            into_ball(reach, d_new)
            new = ratio_at(ratio, y_new, d_new, places, hy, hd)
            if new < value:
                moved = True
                break
            step *= 0.25
        if not moved:
            break
        gain = value - new
        value = new
        for i in range(3):
            y[i], offset[i], gy[i], gd[i] = y_new[i], d_new[i], hy[i], hd[i]
        step *= 2.0
        if gain < _SMALL * value:
            break
    return value


@inner_kernel
def null_within_reach(ratio, errors, y, offset):
    """Return whether some error points the null at the node; fills it if so."""
    node, reach = ratio[2], errors[3]
    square = along = 0.0
    for i in range(3):
        y[i] = node[i]
        square += node[i] * node[i]
    into_cone(errors, y)
    for i in range(3):
        along += y[i] * node[i]
    side = 0.0
    for i in range(3):
        offset[i] = node[i] - along * y[i]
        side += offset[i] * offset[i]
    spare = 0.5 * math.sqrt(max(0.0, reach * reach - side))
    if abs(along) < spare:  # not onto the node itself
        for i in range(3):
            offset[i] += (along - spare) * y[i]
    return side <= reach * reach or side <= 1e-28 * square


@inner_heap_kernel
def worst_found(ratio, errors, y, offset):
    """Return the smallest ratio that descents from several errors end at, and fill that error.

    Args:
        ratio: the ratio, as above.
        errors: what may be wrong, as above.
        y: output, (3,): the actual axis, of unit length.
        offset: output, (3,): the position's error.
    """
    frame, cosine, sine = errors[:3]
    n_links = ratio[3].shape[0]
    places = np.empty((n_links, 3))
    if ratio[0] == 0.0 and null_within_reach(ratio, errors, y, offset):
        return 0.0
    best = math.inf
    trial, shift = np.empty(3), np.empty(3)
    n_starts = np.int64(5 if sine > 0.0 else 1)
    for start in range(n_starts):
        turn = 0.5 * math.pi * start
        lean = sine if start > 0 else 0.0
        for i in range(3):
            shift[i] = 0.0
            trial[i] = frame[0, i] * (cosine if start > 0 else 1.0) + lean * (
                math.cos(turn) * frame[1, i] + math.sin(turn) * frame[2, i]
            )
        into_cone(errors, trial)
        value = descend(ratio, errors, trial, shift, places)
        if value < best:
            best = value
            for i in range(3):
                y[i], offset[i] = trial[i], shift[i]
    return best
