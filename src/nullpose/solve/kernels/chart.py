"""The search variables of a pose, and the constraints on its position.

The pose is an affine function of the search variables: a step in position, scaled by the distance to the
nearest node; for a free axis a step in its tangent plane and a part that turns with the position (see
``turning``), the axis being renormalised after every step. On a cone about the vertical (kind 3) the axis has
one variable, and is put back on the cone.

The slacks of a pose are those of six faces, of the keep-out balls, of the chosen side of each forbidden
piece, and of the two ends of a band of elevations.
"""

from __future__ import annotations

import math

from nullpose.solve.kernels.jit import kernel
from nullpose.solve.kernels.scratch import scratch, zeroed
from nullpose.solve.kernels.symmetric import tangents

__all__ = [
    "axis_at",
    "chart",
    "choose_sides",
    "clamp_axis",
    "domain_slacks",
    "move",
    "nearest_node",
    "reduce_hessian",
    "side_slack",
    "slack_count",
    "turning",
]


@kernel
def axis_at(field, offset, matrix, p, u):
    """Overwrite ``u`` with the axis that an affine field gives at p; leave a free axis as it is."""
    if field == 1:
        for i in range(3):
            u[i] = offset[i] + matrix[i, 0] * p[0] + matrix[i, 1] * p[1] + matrix[i, 2] * p[2]


@kernel
def nearest_node(family, p):
    """Return the distance to the nearest numerator point."""
    points, npt = family.points_m, family.numerator_point
    nearest = math.inf
    for k in range(npt.shape[0]):
        d = 0.0
        for i in range(3):
            d += (points[npt[k], i] - p[i]) ** 2
        nearest = min(nearest, d)
    return math.sqrt(nearest)


@kernel
def turning(family, p, u):
    """Return the rate, per metre and with its sign, at which the axis should turn with a step in position.

    A straight step ``(dp, -dp / rho)`` keeps an axis that points at the strongest interferer on it exactly,
    where a step in the tangent plane alone leaves it at second order, times that interferer's power.
    """
    points, dpt, dw = family.points_m, family.denominator_point, family.denominator_weight
    strongest = 0.0
    rate = 0.0
    if family.turn.shape[0] > 0:  # points that see different axes have no common turning
        return rate
    for e in range(dw.shape[0]):
        x, y, z = points[dpt[e], 0] - p[0], points[dpt[e], 1] - p[1], points[dpt[e], 2] - p[2]
        rho2 = x * x + y * y + z * z
        if dw[e] / rho2 > strongest:
            strongest = dw[e] / rho2
            along = u[0] * x + u[1] * y + u[2] * z
            rate = math.copysign(1.0 / math.sqrt(rho2), -along)
    return rate


@kernel
def chart(field, matrix, rate, u, free, length, jacobian):
    """Fill the Jacobian (6, n) of (p, u) in the search variables; return n."""
    for i in range(6):
        for m in range(5):
            jacobian[i, m] = 0.0
    n = 0
    for i in range(3):
        if free[i]:
            jacobian[i, n] = length
            if field == 1:
                for m in range(3):
                    jacobian[3 + m, n] = length * matrix[m, i]
            elif field != 3:
                jacobian[3 + i, n] = length * rate
            n += 1
    if field == 3:
        across = math.sqrt(u[0] ** 2 + u[1] ** 2)
        jacobian[3, n], jacobian[4, n] = -u[1] / across, u[0] / across
        n += 1
    elif field != 1:
        a, b = scratch(3), scratch(3)
        tangents(u, a, b)
        for i in range(3):
            jacobian[3 + i, n] = a[i]
            jacobian[3 + i, n + 1] = b[i]
        n += 2
    return n


@kernel
def move(axis_field, p, u, jacobian, n, step, scale, new_p, new_u):
    """Fill the pose reached by ``scale * step`` in the search variables."""
    field, offset, matrix = axis_field.kind, axis_field.offset, axis_field.matrix
    for i in range(3):
        new_p[i] = p[i]
        new_u[i] = u[i]
        for m in range(n):
            new_p[i] += scale * jacobian[i, m] * step[m]
            if field != 1:
                new_u[i] += scale * jacobian[3 + i, m] * step[m]
    if field == 3:
        clamp_axis(axis_field, new_u)
    elif field != 1:
        norm = math.sqrt(new_u[0] ** 2 + new_u[1] ** 2 + new_u[2] ** 2)
        for i in range(3):
            new_u[i] /= norm
    else:
        axis_at(field, offset, matrix, new_p, new_u)


@kernel
def clamp_axis(axis_field, u):
    """Bring an axis to unit length and, where the field is a band, to the nearest elevation within it."""
    norm = math.sqrt(u[0] ** 2 + u[1] ** 2 + u[2] ** 2)
    for i in range(3):
        u[i] /= norm
    if axis_field.kind < 2:
        return
    wanted = min(max(u[2] * u[2], axis_field.offset[0]), axis_field.offset[1])
    if wanted == u[2] * u[2]:
        return
    across = math.sqrt(u[0] ** 2 + u[1] ** 2)
    if not across > 1e-12:
        u[0], u[1], across = 1.0, 0.0, 1.0
    scale = math.sqrt(1.0 - wanted) / across
    u[0], u[1], u[2] = scale * u[0], scale * u[1], math.copysign(math.sqrt(wanted), u[2])


@kernel
def reduce_hessian(hess, jacobian, n, out):
    """Fill ``J^T H J`` for the (6, n) Jacobian."""
    half = zeroed(6, 5)
    for i in range(6):
        for m in range(n):
            s = 0.0
            for k in range(6):
                s += hess[i, k] * jacobian[k, m]
            half[i, m] = s
    for a in range(n):
        for b in range(n):
            s = 0.0
            for i in range(6):
                s += jacobian[i, a] * half[i, b]
            out[a, b] = s


@kernel
def slack_count(domain):
    """Return how many slacks a pose has."""
    return 8 + domain.keep_out_points_m.shape[0] + domain.piece_start.shape[0] - 1


@kernel
def side_slack(side, p):
    """Return the slack of a piece's side: how far outside, squared for a cylinder."""
    if side[0] == 0.0:
        return side[1] * p[0] + side[2] * p[1] + side[3] * p[2] - side[4]
    return (p[0] - side[1]) ** 2 + (p[1] - side[2]) ** 2 - side[4] ** 2


@kernel
def choose_sides(domain, p, chosen):
    """Fill, for every forbidden piece, the side that a position is farthest outside of."""
    start, sides = domain.piece_start, domain.piece_sides
    for c in range(start.shape[0] - 1):
        most = -math.inf
        for s in range(start[c], start[c + 1]):
            away = side_slack(sides[s], p)
            if sides[s, 0] == 1.0:
                away = math.sqrt(away + sides[s, 4] ** 2) - sides[s, 4]
            if away > most:
                chosen[c], most = s, away


@kernel
def domain_slacks(p, u, domain, axis_field, chosen, out):
    """Fill the slacks of a pose: faces, keep-out balls (as squares), pieces' chosen sides, ends of a band."""
    low, high, keep_points = domain.low_m, domain.high_m, domain.keep_out_points_m
    keep_radius = domain.keep_out_m
    for i in range(3):
        out[i] = p[i] - low[i]
        out[3 + i] = high[i] - p[i]
    c = 6
    for q in range(keep_points.shape[0]):
        d = 0.0
        for i in range(3):
            d += (p[i] - keep_points[q, i]) ** 2
        out[c] = d - keep_radius * keep_radius
        c += 1
    for s in chosen:
        out[c] = side_slack(domain.piece_sides[s], p)
        c += 1
    out[c] = out[c + 1] = 1.0
    if axis_field.kind == 2:
        size = u[0] ** 2 + u[1] ** 2 + u[2] ** 2
        out[c] = u[2] * u[2] - axis_field.offset[0] * size
        out[c + 1] = axis_field.offset[1] * size - u[2] * u[2]
