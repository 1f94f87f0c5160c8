"""The strongest link that a point known only up to a set can have: lemmas 1 to 3 of docs/robust.md.

The link ``|y x q|^2 / |q|^4`` of a point at q is ``|y x v|^2`` with ``v = q / |q|^2``: the squared distance
of the inverted point from the line of the axis (lemma 1). An antenna with a leak l adds ``l (y.v)^2``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.solve.kernels.jit import inner_kernel, kernel
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.vectors import (
    along,
    combination,
    components,
    cross,
    dot,
    norm,
    over,
    perpendicular,
    row,
    rows,
    scaled,
    times,
    unit,
)

ROUND = 4e-15  # of a cross product of two vectors, relative to the product of their lengths
_HAIR = 1e-13  # of a bound: what its few operations may lose
_ARCS = 8
_MOST_ARCS = 64
_NARROWEST = 1e-4  # arc that is still halved, radians
_ITERATIONS = 40
_QUICK = 12
_CLIMB = 6
_ORIGIN = (0.0, 0.0, 0.0)

FloatArray = NDArray[np.float64]


class Sets(NamedTuple):
    """The sets that points are known up to, about a centre each: balls and ellipsoids.

    Where all are balls, the axes are None, and what ellipsoids need is not even compiled.
    """

    radii: FloatArray  # (n,) of a ball; negative for an ellipsoid
    axes: FloatArray | None  # (n, 3, 3) an ellipsoid's axes, as rows
    semi: FloatArray | None  # (n, 3) and its half lengths


class Touching(NamedTuple):
    """What the point of an ellipsoid farthest along a normal says about lemma 3's support function h."""

    attained: float  # ``w.v`` there: h is not below
    upper: float  # and not above
    x: tuple[float, float, float]  # the point ``q + semi x``
    normal: tuple[float, float, float]  # of the level of ``w.v`` there


@inner_kernel
def root_link(y, q, leak):
    """Return the square root of a link."""
    across = norm(cross(y, q))
    return (math.hypot(across, math.sqrt(leak) * dot(y, q)) if leak > 0.0 else across) / dot(q, q)


@inner_kernel
def strongest_in_ball(y, q, radius, leak):
    """Return lemma 2, (a bound on the largest root link over a ball about q, where it is about attained).

    Infinite if the ball reaches the origin.
    """
    clear = dot(q, q) - radius * radius
    if not clear > 0.0:
        return math.inf, _ORIGIN
    ahead = dot(q, y)
    side = along(q, -ahead, y)
    # where the axis points at the centre any direction across it will do
    side = side if norm(side) > 1e-12 * norm(q) else perpendicular(y)
    most, lean = (norm(cross(y, q)) + radius) / clear, 0.0
    if leak > 0.0 and radius > 0.0:
        most, lean = leaking_bound(norm(cross(y, q)), ahead, radius, leak)
        most = most / clear
    elif leak > 0.0:
        most = math.hypot(norm(cross(y, q)), math.sqrt(leak) * ahead) / clear
    across = math.sqrt(max(0.0, radius * radius - lean * lean))
    step = along(over(scaled(across, side), norm(side)), lean, y)
    inverted = over(along(q, 1.0, step), clear)
    return most, over(inverted, dot(inverted, inverted))


@inner_kernel
def leaking_bound(across, ahead, radius, leak):
    """Return (the largest ``|y x v|^2 + l (y.v)^2`` over a ball, its root; the step along y to where it is).

    The ball's centre has distance ``across`` from the line of y and is ``ahead`` along it. Lagrange's dual
    ``m radius^2 + m across^2 / (m - 1) + m l ahead^2 / (m - l)`` is a bound for every m > 1; the least is
    where its slope vanishes, between the two ends that the search starts from.
    """
    low = 1.0 + max(across / radius, 1e-12)
    high = 1.0 + max(math.hypot(across, leak * ahead) / radius, 1e-12)
    for _ in range(_ITERATIONS):
        m = 0.5 * (low + high)
        slope = radius * radius - (across / (m - 1.0)) ** 2 - (leak * ahead / (m - leak)) ** 2
        low, high = (m, high) if slope < 0.0 else (low, m)
    m = high
    bound = m * (radius * radius + across * across / (m - 1.0) + leak * ahead * ahead / (m - leak))
    lean = leak * ahead / (m - leak)
    return math.sqrt(bound) * (1.0 + _HAIR), math.copysign(min(abs(lean), radius), ahead)


@inner_kernel
def touching(w, q, semi, normal):
    """Return lemma 3 (2): what the point of an ellipsoid that is farthest along a normal says about h(w)."""
    spread = times(semi, normal)
    reach, length, ahead = norm(spread), norm(normal), dot(w, normal)
    wedge = length - ahead  # without cancellation:
    if ahead > 0.0:
        wedge = (norm(cross(w, normal)) + ROUND * length) ** 2 / (length + ahead)
    delta = -dot(normal, q) - (reach + ROUND * (length * norm(q) + reach))
    x = over(spread, reach)
    place = along(q, 1.0, times(semi, x))
    attained = dot(w, place) / dot(place, place)
    upper = wedge / (2.0 * delta) * (1.0 + _HAIR) if delta > 0.0 else math.inf
    return Touching(attained, upper, x, along(w, -2.0 * attained, place))


@inner_kernel
def support(w, q, semi, tolerance):
    """Return (attained, upper bound, x) of h(w), w a unit vector, for the ellipsoid ``q + semi x``.

    The touching point moves to where the gradient is the normal, which settles at once for a small set;
    Dinkelbach's method, a trust region problem in each step, for a large one.
    """
    if not dot(w, q) + norm(times(semi, w)) > 0.0:
        return 0.0, ROUND * norm(q), _ORIGIN
    at = first = touching(w, q, semi, w)
    for _ in range(_QUICK):
        if at.upper <= at.attained * (1.0 + tolerance):
            return at.attained, max(at.attained, at.upper), at.x
        at = touching(w, q, semi, at.normal)
    best, normal = first.attained, first.normal
    for _ in range(_ITERATIONS):
        place = along(q, 1.0, times(semi, sphere_step(w, q, semi, best)))
        new = dot(w, place) / dot(place, place)
        normal = along(w, -2.0 * max(best, new), place)
        if not new > best * (1.0 + 1e-14):
            break
        best = new
    at = touching(w, q, semi, normal)
    return at.attained, max(at.attained, at.upper), at.x


@inner_kernel
def sphere_step(w, q, semi, s):
    """Return the x of the unit ball with the largest ``w.q' - s |q'|^2``, ``q' = q + semi x``."""
    slope, bend = times(semi, along(scaled(0.5, w), -s, q)), scaled(s, times(semi, semi))
    shift = 0.0
    for i in range(3):
        shift = max(shift, abs(slope[i]) - bend[i])
    for _ in range(_ITERATIONS):
        square = change = 0.0
        for i in range(3):
            if bend[i] + shift > 0.0:
                part = (slope[i] / (bend[i] + shift)) ** 2
                square += part
                change += part / (bend[i] + shift)
        if not square > 1.0 + 1e-15:
            break
        step = square * (math.sqrt(square) - 1.0) / change
        shift += step
        if not step > 1e-16 * shift:
            break
    x = (
        slope[0] / (bend[0] + shift) if bend[0] + shift > 0.0 else 0.0,
        slope[1] / (bend[1] + shift) if bend[1] + shift > 0.0 else 0.0,
        slope[2] / (bend[2] + shift) if bend[2] + shift > 0.0 else 0.0,
    )
    return scaled(1.0 / max(1.0, norm(x)), x)


@inner_kernel
def arc_bound(low, high, width):
    """Return lemma 3 (3): what h does not exceed on an arc, by its values at the ends.

    It lies under the sinusoid through both.
    """
    c, s = math.cos(width), math.sin(width)
    if high - low * c > 0.0 and low - high * c > 0.0:
        return math.sqrt(max(0.0, low * low + high * high - 2.0 * low * high * c)) / s * (1.0 + _HAIR)
    return max(low, high)


@inner_kernel
def climb(y, q, semi, best, x):
    """Return a local maximum of the root link over the ellipsoid, uphill from x, and its x."""
    for _ in range(_CLIMB):
        place = along(q, 1.0, times(semi, x))
        w = unit(along(place, -dot(place, y), y))
        at = touching(w, q, semi, along(w, -2.0 * best, place))
        if not at.attained > best:
            break
        gain, best, x = at.attained - best, at.attained, at.x
        if gain < 1e-12 * best:
            break
    return best, x


@inner_kernel
def on_circle(y, angle):
    """Return the unit vector across y at an angle."""
    first = unit(perpendicular(y))
    return along(scaled(math.cos(angle), first), math.sin(angle), cross(y, first))


@kernel
def strongest_in_ellipsoid(y, q, frame, semi, leak, tolerance):
    """Return (attained, upper bound, place) of the largest root link over an ellipsoid about q.

    By lemma 3 (1) it is the largest h(w) over the unit vectors w across y: a circle, bounded arc by arc until
    the bound is within the tolerance. What leaks is bounded by itself, at the least distance.
    """
    y, q = components(frame, y), components(frame, q)
    if not (q[0] / semi[0]) ** 2 + (q[1] / semi[1]) ** 2 + (q[2] / semi[2]) ** 2 > 1.0 + 1e-9:
        return math.inf, math.inf, _ORIGIN
    start, width = scratch(_MOST_ARCS), scratch(_MOST_ARCS)
    low, high = scratch(_MOST_ARCS), scratch(_MOST_ARCS)
    best = upper = 0.0
    most = _ORIGIN
    for a in range(_ARCS):
        start[a], width[a] = 2.0 * math.pi * a / _ARCS, 2.0 * math.pi / _ARCS
        s, low[a], x = support(on_circle(y, start[a]), q, semi, 0.2 * tolerance)
        high[(a - 1) % _ARCS] = low[a]
        if s > best:
            best, most = s, x
    best, most = climb(y, q, semi, best, most)
    top = _ARCS
    while top > 0:
        a = top = top - 1
        bound = arc_bound(low[a], high[a], width[a])
        if bound <= best * (1.0 + tolerance) or width[a] < _NARROWEST or top + 2 > _MOST_ARCS:
            upper = max(upper, bound)
            continue
        half = 0.5 * width[a]
        s, between, x = support(on_circle(y, start[a] + half), q, semi, 0.2 * tolerance)
        if s > best * (1.0 + 1e-9):
            best, most = climb(y, q, semi, s, x)
        start[a + 1], width[a + 1], low[a + 1], high[a + 1] = start[a] + half, half, between, high[a]
        width[a], high[a] = half, between
        top += 2
    place = along(q, 1.0, times(semi, most))
    # w is across y up to rounding only, and no point inverted is longer than 1 over the least distance
    near = least_distance(q, semi)
    upper = upper * (1.0 + _HAIR) + ROUND / near
    if leak > 0.0:
        most = 1.0 / near if near > 0.0 else math.inf
        upper = math.hypot(math.sqrt(1.0 - leak) * upper, math.sqrt(leak) * most) * (1.0 + _HAIR)
    return root_link(y, place, leak), upper, combination(frame, place)


@inner_kernel
def least_distance(q, semi):
    """Return a lower bound on the distance from the origin to an ellipsoid about q; negative if inside."""
    size = (q[0] / semi[0], q[1] / semi[1], q[2] / semi[2])
    normal = norm((size[0] / semi[0], size[1] / semi[1], size[2] / semi[2]))
    # the tangent plane across the line to the centre, as the ellipsoid's form sees it
    return 0.999 * max(
        norm(q) - max(semi[0], max(semi[1], semi[2])), norm(size) * (norm(size) - 1.0) / normal
    )


@inner_kernel
def clearance_of(radius, axes, semi, j, q):
    """Return what ``clearance`` does; compiled without the branch where there are no axes."""
    if axes is not None:  # noqa: SIM102  this test alone is decided when it is compiled
        if radius < 0.0:
            return least_distance(components(rows(axes[j]), q), row(semi, j))
    return norm(q) - radius


@inner_kernel
def strongest_of(radius, axes, semi, j, y, q, leak, tolerance):
    """Return what ``strongest_link`` does; compiled without the branch where there are no axes."""
    if axes is not None:  # noqa: SIM102  this test alone is decided when it is compiled
        if radius < 0.0:
            return strongest_in_ellipsoid(y, q, rows(axes[j]), row(semi, j), leak, tolerance)
    most, place = strongest_in_ball(y, q, radius, leak)
    attained = root_link(y, place, leak) if leak > 0.0 and most < math.inf else most
    return attained, most + ROUND * norm(q) / (dot(q, q) - radius * radius), place


@kernel
def clearance(sets, j, q):
    """Return a lower bound on the distance from the origin to set j about q; not positive if it is inside."""
    return clearance_of(sets.radii[j], sets.axes, sets.semi, j, q)


@kernel
def strongest_link(sets, j, y, q, leak, tolerance):
    """Return (attained, upper bound, place) of the largest root link of set j about q, y a unit vector."""
    return strongest_of(sets.radii[j], sets.axes, sets.semi, j, y, q, leak, tolerance)
