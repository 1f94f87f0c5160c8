"""The search variables of a pose, and the constraints on it.

A pose is six numbers, the position and the axis. It is an affine function of the search variables: a step in
position, scaled by the distance to the nearest node; for a free axis a step in its tangent plane and a part
that rotates with the position (see ``rotation_rates``), the axis being renormalised after every step. In a
narrow band the axis has its azimuth and its height, u_z, in which the band's ends are straight: a step in the
tangent plane leaves the band at second order. On a cone about the vertical it has its azimuth alone.

The slacks of a pose are those of six faces, of the keep-out balls, of the chosen side of each forbidden
piece, and of the two ends of an elevation band.
"""

from __future__ import annotations

import math

from nullpose.problem.records import AFFINE_AXIS, BAND_AXIS, CONE_AXIS, NARROW_AXIS
from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.links import isotropic_share, strongest_point
from nullpose.solver.kernels.linear_algebra.symmetric import (
    add_scaled,
    copy_into,
    inner,
    normalise,
    squared_distance,
    tangents,
)
from nullpose.solver.kernels.linear_algebra.vectors import along, dot, minus, row, scaled, store

_TIP = 1e-6  # squared sine from a dipole's own null below which nothing follows it


@kernel
def axis_at(axis_field, p, u):
    """Overwrite ``u`` with the axis that an affine field gives at p; leave a free axis as it is."""
    if axis_field.kind == AFFINE_AXIS:
        for i in range(3):
            u[i] = axis_field.offset[i] + dot(axis_field.matrix[i], p)


@kernel
def clamp_elevation(least, greatest, u):
    """Bring a unit axis to the nearest one whose ``u_z^2`` is within a band."""
    wanted = min(max(u[2] * u[2], least), greatest)
    if wanted == u[2] * u[2]:
        return
    raise_to(math.copysign(math.sqrt(wanted), u[2]), u)


@kernel
def raise_to(height, u):
    """Bring an axis to unit length and to a height, u_z, its azimuth kept."""
    across = math.hypot(u[0], u[1])
    if not across > 1e-12:
        u[0], u[1], across = 1.0, 0.0, 1.0
    scale = math.sqrt(max(0.0, 1.0 - height * height)) / across
    u[0], u[1], u[2] = scale * u[0], scale * u[1], height


@kernel
def clamp_axis(axis_field, u):
    """Bring an axis to unit length and, where the field is a band or a cone, to the nearest in it."""
    normalise(u)
    if axis_field.kind >= BAND_AXIS:
        clamp_elevation(axis_field.offset[0], axis_field.offset[1], u)


@kernel
def nearest_node(family, p):
    """Return the distance to the nearest numerator point."""
    nearest = math.inf
    for point in family.numerator_point:
        nearest = min(nearest, squared_distance(family.points_m[point], p))
    return math.sqrt(nearest)


@kernel
def rotation_rates(family, p, u, out):
    """Fill how the axis should change with a step along each world axis, (3, 3), per metre.

    A straight step ``(dp, -dp / rho)`` keeps an axis that points at the strongest interferer on it exactly,
    where a step in the tangent plane alone leaves it at second order, times that interferer's power. Where
    that has a dipole, its link vector a is what the axis stays across: ``du = -a (u.da) / |a|^2``.
    """
    out[:, :] = 0.0
    # points that see different axes have no common rotation
    j = strongest_point(family, p) if family.turn.shape[0] == 0 else -1
    if j < 0:
        return
    r = minus(row(family.points_m, j), p)
    rho2 = dot(r, r)
    if isotropic_share(family.ground_leaks, j) == 1.0:
        for i in range(3):
            out[i, i] = math.copysign(1.0 / math.sqrt(rho2), -dot(u, r))
        return
    v = row(family.ground_axes, j)
    ahead = dot(v, r)
    a = along(scaled(rho2, v), -ahead, r)  # link vector times |r|^3
    size = dot(a, a)
    for i in range(3 if size > _TIP * rho2 * rho2 else 0):
        change = u[i] * ahead + dot(u, v) * r[i] + dot(u, r) * (v[i] - 3.0 * ahead * r[i] / rho2)
        for m in range(3):
            out[i, m] = -a[m] * change / size


@kernel
def local_coordinates(family, axis_field, pose, free, directions):
    """Fill the change of the pose by each search variable, (5, 6); return how many there are."""
    p, u = pose[:3], pose[3:]
    length, rates = nearest_node(family, p), scratch(3, 3)
    rotation_rates(family, p, u, rates)
    directions[:, :] = 0.0
    n = 0
    for i in range(3):
        if free[i]:
            directions[n, i] = length
            if axis_field.kind == AFFINE_AXIS:
                add_scaled(length, axis_field.matrix[:, i], directions[n, 3:])
            elif axis_field.kind < NARROW_AXIS:
                add_scaled(length, rates[i], directions[n, 3:])
            n += 1
    if axis_field.kind >= NARROW_AXIS:
        across = math.hypot(u[0], u[1])
        directions[n, 3], directions[n, 4] = -u[1] / across, u[0] / across
        n += 1
        if axis_field.kind == NARROW_AXIS:
            store((-u[2] * u[0] / across, -u[2] * u[1] / across, across), directions[n, 3:])
            n += 1
    elif axis_field.kind != AFFINE_AXIS:
        tangents(u, directions[n, 3:], directions[n + 1, 3:])
        n += 2
    return n


@kernel
def move(axis_field, pose, directions, n, step, scale, moved):
    """Fill the pose reached by ``scale * step`` in the search variables."""
    copy_into(pose, moved)
    for m in range(n):
        add_scaled(scale * step[m], directions[m], moved)
    if axis_field.kind == AFFINE_AXIS:
        axis_at(axis_field, moved[:3], moved[3:])
    elif axis_field.kind >= NARROW_AXIS:
        raise_to(moved[5], moved[3:])
    else:
        normalise(moved[3:])


@kernel
def reduce_hessian(hess, directions, n, out):
    """Fill the Hessian in n search variables from that in the pose."""
    half = scratch(6)
    for a in range(n):
        for i in range(6):
            half[i] = inner(hess[i], directions[a], 6)
        for b in range(n):
            out[a, b] = inner(half, directions[b], 6)


@kernel
def slack_count(domain):
    """Count the slacks of a pose."""
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
    """Fill the slacks of a pose: faces, keep-out balls (as squares), pieces' chosen sides, ends of a band.

    Infinite where there is no such constraint.
    """
    for i in range(3):
        out[i], out[3 + i] = p[i] - domain.low_m[i], domain.high_m[i] - p[i]
    c = 6
    for point in domain.keep_out_points_m:
        out[c] = squared_distance(p, point) - domain.keep_out_m**2
        c += 1
    for s in chosen:
        out[c] = side_slack(domain.piece_sides[s], p)
        c += 1
    out[c] = out[c + 1] = math.inf
    if BAND_AXIS <= axis_field.kind < CONE_AXIS:
        least, greatest, size = axis_field.offset[0], axis_field.offset[1], dot(u, u)
        out[c] = u[2] * u[2] - least * size if least > 0.0 else math.inf
        out[c + 1] = greatest * size - u[2] * u[2] if greatest < 1.0 else math.inf


@inner_kernel
def add_slack_slopes(domain, axis_field, chosen, pose, duals, slopes, hess):
    """Fill the slopes of the slacks by the pose, (s, 6); add their curvatures, weighted, to a Hessian.

    All curvatures are diagonal.
    """
    slopes[:, :] = 0.0
    for i in range(3):
        slopes[i, i], slopes[3 + i, i] = 1.0, -1.0
    c = 6
    for point in domain.keep_out_points_m:
        for i in range(3):
            slopes[c, i] = 2.0 * (pose[i] - point[i])
            hess[i, i] += 2.0 * duals[c]
        c += 1
    for s in chosen:
        side = domain.piece_sides[s]
        if side[0] == 0.0:
            copy_into(side[1:4], slopes[c])
        else:
            for i in range(2):
                slopes[c, i] = 2.0 * (pose[i] - side[1 + i])
                hess[i, i] += 2.0 * duals[c]
        c += 1
    if BAND_AXIS <= axis_field.kind < CONE_AXIS:
        for end in range(2):
            for i in range(3):
                weight = (2.0 - 4.0 * end) * ((1.0 if i == 2 else 0.0) - axis_field.offset[end])
                slopes[c + end, 3 + i] = weight * pose[3 + i]
                hess[3 + i, 3 + i] += weight * duals[c + end]
