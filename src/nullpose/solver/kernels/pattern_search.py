"""Poses of an antenna with a pattern: their ratios, and climbs among them."""

from __future__ import annotations

import math

from nullpose.solver.kernels.domain import contains
from nullpose.solver.kernels.harmonics import gain_at
from nullpose.solver.kernels.jit import inner_kernel, kernel
from nullpose.solver.kernels.symmetric import copy_into, copy_table
from nullpose.solver.kernels.vectors import cross, dot, norm, row, scaled, unit

_FIRST_STEP, _LONGEST_STEP, _LONGER, _SHORTER = 0.1, 0.5, 1.5, 0.91  # radians; a fifth of steps succeed


@kernel
def fill_log_ratios(family, pattern, position, rotation, links, out):
    """Fill the logarithm of every ratio at a pose, minus infinity where there is none; return the least.

    Args:
        family: the ratios.
        pattern: the antenna's arrays.
        position: (3,) metres.
        rotation: (3, 3) to the world from the antenna's axes.
        links: (m,) scratch.
        out: output, (ratios,).
    """
    for j in range(family.points_m.shape[0]):
        x = family.points_m[j, 0] - position[0]
        y = family.points_m[j, 1] - position[1]
        z = family.points_m[j, 2] - position[2]
        square = x * x + y * y + z * z
        length = math.sqrt(square)
        a = (rotation[0, 0] * x + rotation[1, 0] * y + rotation[2, 0] * z) / length
        b = (rotation[0, 1] * x + rotation[1, 1] * y + rotation[2, 1] * z) / length
        c = (rotation[0, 2] * x + rotation[1, 2] * y + rotation[2, 2] * z) / length
        links[j] = gain_at(pattern, a, b, c) / square
    least = math.inf
    for k in range(family.numerator_point.shape[0]):
        g = family.denominator_of[k]
        below = family.denominator_isotropic[g]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            below += family.denominator_weight[e] * links[family.denominator_point[e]]
        above = family.numerator_isotropic[k] + family.numerator_weight[k] * links[family.numerator_point[k]]
        out[k] = math.log(above / below) if above > 0.0 else -math.inf
        least = min(least, out[k])
    return least


@kernel
def judge(family, domain, pattern, positions, rotations, links, logs, out):
    """Fill the smallest log ratio of many poses, (n, 3) and (n, 3, 3), minus infinity if not allowed."""
    for i in range(positions.shape[0]):
        out[i] = -math.inf
        if contains(domain, positions[i]):
            out[i] = fill_log_ratios(family, pattern, positions[i], rotations[i], links, logs)


@inner_kernel
def turned_by(rotation, x, y, z, out):
    """Fill a rotation times that by a small rotation vector (Rodrigues)."""
    angle = math.sqrt(x * x + y * y + z * z)
    s, c = 1.0, 0.5
    if angle > 1e-9:
        s, c = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    w = (x, y, z)
    for i in range(3):
        a = row(rotation, i)
        first = cross(a, w)  # a row times the matrix of the vector
        second = cross(first, w)
        for k in range(3):
            out[i, k] = a[k] + s * first[k] + c * second[k]


@inner_kernel
def tilt_of(reach, vertical):
    """Return the tilt of an attitude, radians, which is negative from the mount's angle inwards if it spins.

    And the axis that a turn about adds to it, of any length.

    Args:
        reach: which attitudes there are.
        vertical: the vertical in the antenna's axes.
    """
    upright, mount = (reach.up[0], reach.up[1], reach.up[2]), 0.0
    if reach.spins:
        upright, mount = (0.0, 0.0, -1.0 if reach.even and vertical[2] < 0.0 else 1.0), reach.mount_rad
    about = cross(vertical, upright)
    return math.atan2(norm(about), dot(vertical, upright)) - mount, about


@kernel
def bring_within_reach(reach, rotation):
    """Turn an attitude to the nearest that the airframe reaches, in place.

    Args:
        reach: which attitudes there are.
        rotation: (3, 3) to the world from the antenna's axes.
    """
    tilt, about = tilt_of(reach, row(rotation, 2))
    turn = min(max(tilt, -reach.tilt_max_rad), reach.tilt_max_rad) - tilt
    if turn != 0.0:
        x, y, z = scaled(turn, unit(about)) if norm(about) > 0.0 else (0.0, turn, 0.0)
        turned_by(rotation, x, y, z, rotation)


@kernel
def wander(family, domain, pattern, reach, noise, scale_m, position, rotation, links, logs, p, r):
    """Climb by random steps, each kept if it is better and allowed; return the smallest log ratio there.

    Steps grow where they succeed and shrink where they do not: ridges, of which a smallest ratio is full, do
    not throw it off. The pose is changed in place.

    Args:
        family: the ratios.
        domain: what is allowed of positions.
        pattern: the antenna's arrays.
        reach: which attitudes there are.
        noise: (steps, 6) normal numbers.
        scale_m: metres that count as much as a radian.
        position: (3,) start and end.
        rotation: (3, 3) likewise.
        links: (m,) scratch.
        logs: (ratios,) scratch.
        p: (3,) scratch.
        r: (3, 3) scratch.
    """
    step = _FIRST_STEP
    best = fill_log_ratios(family, pattern, position, rotation, links, logs)
    for t in range(noise.shape[0]):
        for i in range(3):
            p[i] = min(max(position[i] + step * scale_m * noise[t, i], domain.low_m[i]), domain.high_m[i])
        turned_by(rotation, step * noise[t, 3], step * noise[t, 4], step * noise[t, 5], r)
        bring_within_reach(reach, r)
        value = -math.inf
        if contains(domain, p):
            value = fill_log_ratios(family, pattern, p, r, links, logs)
        if value > best:
            best = value
            copy_into(p, position)
            copy_table(r, rotation)
            step = min(_LONGEST_STEP, step * _LONGER)
        else:
            step *= _SHORTER
    return best
