"""The worst error case of one ratio at a pose: its value under an error, and a descent over the errors.

Everything is seen from the nominal position. A point's set is moved by an error of the position; the point's
place within it is worst for itself.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nullpose.objectives import FloatArray
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.linear_algebra.vectors import (
    along,
    combination,
    components,
    dot,
    minus,
    norm,
    over,
    row,
    scaled,
    store,
    unit,
)
from nullpose.solver.kernels.search.set_links import Sets, channel_slopes, has_dipole
from nullpose.solver.kernels.search.worst_case_links import strongest_link

_LOOSE = 1e-3  # tolerance of a ball's strongest link in the search, which asks for what is attained
_STEPS = 200
_TRIES = 40
_SMALL = 1e-13
_NO_OFFSET = (0.0, 0.0, 0.0)
Vector = tuple[float, float, float]


class Ratio(NamedTuple):
    """A ratio ``(a + c (|y x v|^2 + l (y.v)^2)) / (1 + sum_j b_j L_j)``.

    v is the node's inverted point, L_j the link of set j, and l the antenna's leak. A node with a dipole has
    ``(1 - l) (y.a)^2 + l |a|^2`` in place of the bracket, a being its link vector (lemma 5). Links are
    multiplied by the excess gains of their channels.
    """

    isotropic: float  # a
    weight: float  # c
    node: Vector
    shares: FloatArray  # (n,) b_j
    centres: FloatArray  # (n, 3) of the sets
    sets: Sets
    leak: float  # l
    dipole: Vector  # the node's axis; zero where it has none


class Errors(NamedTuple):
    """Axes within a cone about the nominal one, and offsets of the position no longer than a reach."""

    frame: tuple[Vector, Vector, Vector]  # the nominal axis, and two across it
    cosine: float  # of the cone
    sine: float
    reach: float


@inner_kernel
def ratio_at(ratio, y, offset, places):
    """Return the ratio at an axis y (unit) and an offset, the sets at their worst, and its derivatives.

    Fills the sets' places from the actual position.
    """
    channels, below, below_y, below_d = ratio.sets.channels, 1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for j in range(ratio.shares.shape[0]):
        share, q = ratio.shares[j], minus(row(ratio.centres, j), offset)
        root, _, place = strongest_link(ratio.sets, j, y, q, ratio.leak, _LOOSE)
        store(place, places[j])
        below += share * root * root
        if root < math.inf:
            axis = row(ratio.sets.dipoles, j)
            _, by_axis, by_place = channel_slopes(channels, j, y, place, axis, ratio.leak)
            below_y, below_d = along(below_y, share, by_axis), along(below_d, -share, by_place)
    q = minus(ratio.node, offset)
    square = dot(q, q)
    if not (square > 0.0 and below < math.inf):
        return 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    node = ratio.shares.shape[0]  # the last of the channels
    link, by_axis, by_place = channel_slopes(channels, node, y, q, ratio.dipole, ratio.leak)
    value = (ratio.isotropic + ratio.weight * link) / below
    by_axis, by_offset = scaled(ratio.weight, by_axis), scaled(-ratio.weight, by_place)
    return value, over(along(by_axis, -value, below_y), below), over(along(by_offset, -value, below_d), below)


@inner_kernel
def into_cone(errors, y):
    """Return the unit vector of the cone that is nearest to the line of y."""
    ahead, first, second = components(errors.frame, y)
    if ahead < 0.0:
        ahead, first, second = -ahead, -first, -second
    across = math.sqrt(first * first + second * second)
    if across * errors.cosine > ahead * errors.sine:
        rim = (errors.cosine, errors.sine * first / across, errors.sine * second / across)
        return combination(errors.frame, rim)
    length = math.sqrt(ahead * ahead + across * across)
    return over(combination(errors.frame, (ahead, first, second)), length)


@inner_kernel
def into_ball(reach, offset):
    """Return the nearest offset that is no longer than the reach."""
    length = norm(offset)
    return scaled(reach / length, offset) if length > reach else offset


@inner_kernel
def descend(ratio, errors, y, offset, places):
    """Return a local minimum of the ratio over the errors, downhill from y and offset, and where it is.

    Projected gradient, each error measured by its largest size, with steps that grow and shrink.
    """
    angle, reach = math.atan2(errors.sine, errors.cosine), errors.reach
    value, by_axis, by_offset = ratio_at(ratio, y, offset, places)
    step = -1.0
    for _ in range(_STEPS):
        by_axis = along(by_axis, -dot(by_axis, y), y)
        slope = angle * norm(by_axis) + reach * norm(by_offset)
        if not slope > _SMALL * value:
            break
        if step < 0.0:
            step = 4.0 / slope
        gain = 0.0
        for _ in range(_TRIES):
            new_y = into_cone(errors, along(y, -step * angle * angle, by_axis))
            new_offset = into_ball(reach, along(offset, -step * reach * reach, by_offset))
            new, new_by_axis, new_by_offset = ratio_at(ratio, new_y, new_offset, places)
            gain = value - new
            if gain > 0.0:
                break
            step *= 0.25
        if not gain > 0.0:
            break
        value, y, offset, by_axis, by_offset = new, new_y, new_offset, new_by_axis, new_by_offset
        step *= 2.0
        if gain < _SMALL * value:
            break
    return value, y, offset


@inner_kernel
def null_within_reach(node, errors):
    """Check whether some error points the null at the node, and the axis and offset that come closest."""
    y = into_cone(errors, node)
    ahead = dot(y, node)
    offset = along(node, -ahead, y)
    side, reach = dot(offset, offset), errors.reach
    spare = 0.5 * math.sqrt(max(0.0, reach * reach - side))
    if abs(ahead) < spare:  # not onto the node itself
        offset = along(offset, ahead - spare, y)
    return side <= reach * reach or side <= 1e-28 * dot(node, node), y, offset


@inner_kernel
def crossed_within_reach(ratio, errors):
    """Check whether an error of the axis alone crosses the node's dipole, and that axis."""
    nominal, q = errors.frame[0], ratio.node
    a = along(scaled(dot(q, q), ratio.dipole), -dot(ratio.dipole, q), q)
    lean, square = dot(nominal, a), dot(a, a)
    reached = lean * lean <= errors.sine**2 * square or errors.cosine <= 0.0
    return reached, unit(along(nominal, -lean / square if square > 0.0 else 0.0, a))


@inner_kernel
def worst_found(ratio, errors, places):
    """Return the smallest ratio that descents from several errors end at, and the axis and offset there."""
    silent, y, offset = null_within_reach(ratio.node, errors)
    if has_dipole(ratio.dipole) and not silent:
        silent, y = crossed_within_reach(ratio, errors)
        offset = _NO_OFFSET
    if ratio.isotropic == ratio.leak == 0.0 and silent:
        return 0.0, y, offset
    nominal, first, second = errors.frame
    best = math.inf
    for start in range(5 if errors.sine > 0.0 else 1):  # the nominal axis, then four of the cone's rim
        begin = nominal
        if start > 0:
            angle = 0.5 * math.pi * start
            tilt = along(scaled(math.cos(angle), first), math.sin(angle), second)
            begin = along(scaled(errors.cosine, nominal), errors.sine, tilt)
        value, new_y, new_offset = descend(ratio, errors, into_cone(errors, begin), _NO_OFFSET, places)
        if value < best:
            best, y, offset = value, new_y, new_offset
    return best, y, offset
