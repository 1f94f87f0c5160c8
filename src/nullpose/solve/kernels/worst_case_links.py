"""The strongest link that a point known only up to a set can have: closed form for a ball.

The link ``|y x q|^2 / |q|^4`` of a point at q is ``|y x v|^2`` with ``v = q / |q|^2``: the squared distance
of the inverted point from the line of the axis. Inversion takes the ball of radius rho about q to the ball of
radius ``rho / (|q|^2 - rho^2)`` about ``q / (|q|^2 - rho^2)``. Proofs: docs/robust.md.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel, kernel

__all__ = ["ROUND", "across", "clearance", "loudest", "loudest_ball", "loudest_ellipsoid"]

ROUND = 4e-15  # of a cross product of two vectors, relative to the product of their lengths
_ARCS = 8
_MOST_ARCS = 64
_ITERATIONS = 40
_QUICK = 12
_CLIMB = 6


@inner_kernel
def across(y, q):
    """Return ``|y x q|``."""
    a = y[1] * q[2] - y[2] * q[1]
    b = y[2] * q[0] - y[0] * q[2]
    c = y[0] * q[1] - y[1] * q[0]
    return math.sqrt(a * a + b * b + c * c)


@inner_kernel
def loudest_ball(y, q, radius, point):
    """Return the largest ``|y x q'| / |q'|^2`` over the ball of a radius about q, y a unit vector.

    Fills the place where it is attained. Infinite if the ball reaches the origin.
    """
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
    clear = square - radius * radius
    if not clear > 0.0:
        for i in range(3):
            point[i] = 0.0
        return math.inf
    along = y[0] * q[0] + y[1] * q[1] + y[2] * q[2]
    side = 0.0
    for i in range(3):
        point[i] = q[i] - along * y[i]
        side += point[i] * point[i]
    side = math.sqrt(side)
    if not side > 1e-12 * math.sqrt(square):  # the axis points at the centre: any direction across it
        least = 0
        for i in range(1, 3):
            if abs(y[i]) < abs(y[least]):
                least = i
        i, j = (least + 1) % 3, (least + 2) % 3
        side = math.sqrt(y[i] * y[i] + y[j] * y[j])
        point[least], point[i], point[j] = 0.0, y[j], -y[i]
    norm = 0.0
    for i in range(3):
        point[i] = (q[i] + radius * point[i] / side) / clear
        norm += point[i] * point[i]
    for i in range(3):
        point[i] /= norm
    return (across(y, q) + radius) / clear


@inner_kernel
def touching(w, q, semi, normal, x):
    """Return (s, an upper bound on the largest s) where an ellipsoid is farthest along a normal.

    ``s = (w.q') / |q'|^2`` at ``q' = q + semi x``; fills x. The ellipsoid lies in the half-space that touches
    it there, which inverted is a ball. Overwrites the normal with that of the level of s.
    """
    reach = length = dot = away = size = 0.0
    for i in range(3):
        reach += (semi[i] * normal[i]) ** 2
        length += normal[i] * normal[i]
        dot += w[i] * normal[i]
        away -= normal[i] * q[i]
        size += q[i] * q[i]
    reach, length = math.sqrt(reach), math.sqrt(length)
    # |n| - w.n without cancellation
    wedge = length - dot
    if dot > 0.0:
        a = w[1] * normal[2] - w[2] * normal[1]
        b = w[2] * normal[0] - w[0] * normal[2]
        c = w[0] * normal[1] - w[1] * normal[0]
        wedge = (math.sqrt(a * a + b * b + c * c) + ROUND * length) ** 2 / (length + dot)
    away -= reach + ROUND * (length * math.sqrt(size) + reach)
    s = square = 0.0
    for i in range(3):
        x[i] = semi[i] * normal[i] / reach
        at = q[i] + semi[i] * x[i]
        s += w[i] * at
        square += at * at
    s /= square
    for i in range(3):
        normal[i] = w[i] - 2.0 * s * (q[i] + semi[i] * x[i])
    return s, (wedge / (2.0 * away) * (1.0 + 1e-13) if away > 0.0 else math.inf)


@inner_kernel
def support(w, q, semi, tolerance, normal, x):
    """Return (s, rigorous upper bound on it) for s the largest ``(w.q') / |q'|^2`` over an ellipsoid.

    ``q' = q + semi x`` with ``|x| <= 1``, in the frame of the ellipsoid's axes; w a unit vector. The gradient
    of the quotient is along ``w - 2 s q'``: the touching point moves to where that is the normal, which
    settles at once for a small set; Dinkelbach's method, a trust region problem in each step, for a large
    one.
    """
    ahead = reach = 0.0
    for i in range(3):
        ahead += w[i] * q[i]
        reach += (semi[i] * w[i]) ** 2
        normal[i] = w[i]
    if not ahead + math.sqrt(reach) > 0.0:
        return 0.0, ROUND * math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2])
    s, upper = touching(w, q, semi, normal, x)
    for _ in range(_QUICK):
        if upper <= s * (1.0 + tolerance):
            return s, max(s, upper)
        s, upper = touching(w, q, semi, normal, x)
    for i in range(3):
        normal[i] = w[i]
    s, _ = touching(w, q, semi, normal, x)
    for _ in range(_ITERATIONS):
        sphere_step(w, q, semi, s, x)
        dot = square = 0.0
        for i in range(3):
            at = q[i] + semi[i] * x[i]
            dot += w[i] * at
            square += at * at
            normal[i] = w[i] - 2.0 * dot / square * at
        done = not dot / square > s * (1.0 + 1e-14)
        s = max(s, dot / square)
        if done:
            break
    for i in range(3):
        normal[i] = w[i] - 2.0 * s * (q[i] + semi[i] * x[i])
    s, upper = touching(w, q, semi, normal, x)
    return s, max(s, upper)


@inner_kernel
def sphere_step(w, q, semi, s, x):
    """Fill the x of the unit ball with the largest ``w.q' - s |q'|^2``, ``q' = q + semi x``."""
    shift = 0.0
    for i in range(3):
        x[i] = semi[i] * (0.5 * w[i] - s * q[i])
        shift = max(shift, abs(x[i]) - s * semi[i] * semi[i])
    for _ in range(_ITERATIONS):
        norm = slope = 0.0
        for i in range(3):
            d = s * semi[i] * semi[i] + shift
            if d > 0.0:
                norm += (x[i] / d) ** 2
                slope += (x[i] / d) ** 2 / d
        if not norm > 1.0 + 1e-15:
            break
        step = norm * (math.sqrt(norm) - 1.0) / slope
        shift += step
        if not step > 1e-16 * shift:
            break
    norm = 0.0
    for i in range(3):
        d = s * semi[i] * semi[i] + shift
        x[i] = x[i] / d if d > 0.0 else 0.0
        norm += x[i] * x[i]
    if norm > 1.0:
        for i in range(3):
            x[i] /= math.sqrt(norm)


@inner_kernel
def arc_bound(low, high, width):
    """Return a bound on a support function over an arc of unit vectors from its values at the ends.

    It is sublinear, so between the ends it lies under the sinusoid through both values.
    """
    c, s = math.cos(width), math.sin(width)
    if high - low * c > 0.0 and low - high * c > 0.0:
        return math.sqrt(max(0.0, low * low + high * high - 2.0 * low * high * c)) / s * (1.0 + 1e-13)
    return max(low, high)


@inner_heap_kernel
def loudest_ellipsoid(y, q, axes, semi, tolerance, point):
    """Return (attained, upper bound) of the largest ``|y x q'| / |q'|^2`` over an ellipsoid about q.

    ``|y x q'|`` is the largest ``w.q'`` over the unit vectors w across the unit vector y: a support function
    on a circle, bounded arc by arc until the bound is within the tolerance. Fills where it is attained.
    """
    scratch = np.zeros((8, 3))
    turned, centre, first, second = scratch[0], scratch[1], scratch[2], scratch[3]
    w, x, normal, most = scratch[4], scratch[5], scratch[6], scratch[7]
    square = along = 0.0
    for i in range(3):
        turned[i] = axes[0, i] * y[0] + axes[1, i] * y[1] + axes[2, i] * y[2]
        centre[i] = axes[0, i] * q[0] + axes[1, i] * q[1] + axes[2, i] * q[2]
        square += (centre[i] / semi[i]) ** 2
        point[i] = 0.0
    if not square > 1.0 + 1e-9:
        return math.inf, math.inf
    least = 0
    for i in range(1, 3):
        if abs(turned[i]) < abs(turned[least]):
            least = i
    i, j = (least + 1) % 3, (least + 2) % 3
    along = math.sqrt(turned[i] * turned[i] + turned[j] * turned[j])
    first[least], first[i], first[j] = 0.0, turned[j] / along, -turned[i] / along
    second[0] = turned[1] * first[2] - turned[2] * first[1]
    second[1] = turned[2] * first[0] - turned[0] * first[2]
    second[2] = turned[0] * first[1] - turned[1] * first[0]
    arcs = np.empty((4, _MOST_ARCS))
    start, width, low, high = arcs[0], arcs[1], arcs[2], arcs[3]
    best = upper = 0.0
    for a in range(_ARCS):
        start[a], width[a] = 2.0 * math.pi * a / _ARCS, 2.0 * math.pi / _ARCS
        for m in range(3):
            w[m] = math.cos(start[a]) * first[m] + math.sin(start[a]) * second[m]
        s, low[a] = support(w, centre, semi, 0.2 * tolerance, normal, x)
        high[(a - 1) % _ARCS] = low[a]
        if s > best:
            best = s
            for m in range(3):
                most[m] = x[m]
    best = climb(turned, centre, semi, best, w, normal, x, most)
    top = np.int64(_ARCS)
    while top > 0:
        top -= 1
        a = top
        bound = arc_bound(low[a], high[a], width[a])
        if bound <= best * (1.0 + tolerance) or width[a] < 1e-4 or top + 2 > _MOST_ARCS:
            upper = max(upper, bound)
            continue
        half = 0.5 * width[a]
        for m in range(3):
            w[m] = math.cos(start[a] + half) * first[m] + math.sin(start[a] + half) * second[m]
        s, between = support(w, centre, semi, 0.2 * tolerance, normal, x)
        if s > best * (1.0 + 1e-9):
            for m in range(3):
                most[m] = x[m]
            best = climb(turned, centre, semi, s, w, normal, x, most)
        start[a + 1], width[a + 1], low[a + 1], high[a + 1] = start[a] + half, half, between, high[a]
        width[a], high[a] = half, between
        top += 2
    square = 0.0
    for m in range(3):
        w[m] = centre[m] + semi[m] * most[m]
        square += w[m] * w[m]
        for i in range(3):
            point[i] += axes[i, m] * w[m]
    best = across(turned, w) / square
    # w is across y up to rounding only, and no point inverted is longer than 1 over the least distance
    return best, upper * (1.0 + 1e-13) + ROUND / least_distance(centre, semi)


@inner_kernel
def least_distance(q, semi):
    """Return a lower bound on the distance from the origin to an ellipsoid about q; negative if inside."""
    size = outer = form = normal = 0.0
    for i in range(3):
        size += q[i] * q[i]
        outer = max(outer, semi[i])
        form += (q[i] / semi[i]) * (q[i] / semi[i])
        normal += (q[i] / (semi[i] * semi[i])) * (q[i] / (semi[i] * semi[i]))
    # the tangent plane across the line to the centre, as the ellipsoid's form sees it
    return 0.999 * max(math.sqrt(size) - outer, (form - math.sqrt(form)) / math.sqrt(normal))


@heap_kernel
def clearance(radius, axes, semi, j, q):
    """Return a lower bound on the distance from the origin to set j about q; not positive if it is inside."""
    if axes is not None:  # noqa: SIM102 - alone, so that the branch is left out of the types without axes
        if radius < 0.0:
            centre = np.empty(3)
            for i in range(3):
                centre[i] = axes[j, 0, i] * q[0] + axes[j, 1, i] * q[1] + axes[j, 2, i] * q[2]
            return least_distance(centre, semi[j])
    return math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) - radius


@kernel
def loudest(radius, axes, semi, j, y, q, tolerance, point):
    """Return (attained, upper bound) of the square root of the strongest link of set j about q.

    Where there are no ellipsoids their axes are None, and the branch for them is not even compiled.
    """
    if axes is not None:  # noqa: SIM102 - alone, so that the branch is left out of the types without axes
        if radius < 0.0:
            return loudest_ellipsoid(y, q, axes[j], semi[j], tolerance, point)
    value = loudest_ball(y, q, radius, point)
    return value, value


@inner_kernel
def climb(y, q, semi, best, w, normal, new, x):
    """Return the link's square root at a local maximum over the ellipsoid, uphill from x, overwritten."""
    for _ in range(_CLIMB):
        along = norm = 0.0
        for i in range(3):
            w[i] = q[i] + semi[i] * x[i]
            along += w[i] * y[i]
        for i in range(3):
            w[i] -= along * y[i]
            norm += w[i] * w[i]
        norm = math.sqrt(norm)
        for i in range(3):
            w[i] /= norm
        for i in range(3):
            normal[i] = w[i] - 2.0 * best * (q[i] + semi[i] * x[i])
        s, _ = touching(w, q, semi, normal, new)
        if not s > best:
            break
        gain = s - best
        best = s
        for i in range(3):
            x[i] = new[i]
        if gain < 1e-12 * best:
            break
    return best
