"""The strongest link that a point known up to a set can have: lemmas 1 to 3 of docs/robust.md."""

from __future__ import annotations

import math

from nullpose.channel.model import CONSTANT
from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.linear_algebra.channel import excess_in_sight
from nullpose.solver.kernels.linear_algebra.vectors import (
    along,
    cross,
    dot,
    norm,
    over,
    perpendicular,
    row,
)
from nullpose.solver.kernels.search.ball_links import strongest_by_parts
from nullpose.solver.kernels.search.set_links import ORIGIN, ROUND, ROUNDING, has_dipole, link_and_slopes


@inner_kernel
def strongest_in_ball(y, q, radius):
    """Return lemma 2, (the largest root link over a ball about q, where it is), of a dipole without a leak.

    Infinite if the ball reaches the origin.
    """
    clear = dot(q, q) - radius * radius
    if not clear > 0.0:
        return math.inf, ORIGIN
    side = along(q, -dot(q, y), y)
    # where the axis points at the centre any direction across it will do
    side = side if norm(side) > 1e-12 * norm(q) else perpendicular(y)
    inverted = over(along(q, radius / norm(side), side), clear)
    return (norm(cross(y, q)) + radius) / clear, over(inverted, dot(inverted, inverted))


@kernel
def strongest_link(sets, j, y, q, leak, tolerance):
    """Return (attained, upper bound, place) of the largest root link of set j about q, y a unit vector."""
    radius, dipole = sets.radii[j], row(sets.dipoles, j)
    if radius == 0.0:
        scale = 1.0
        if sets.channels.shape[0] > 0:
            scale = math.sqrt(excess_in_sight(sets.channels[j], q))
        root = scale * math.sqrt(link_and_slopes(y, q, dipole, leak)[0])
        return root, root * (1.0 + ROUNDING) + 4.0 * ROUND * scale / norm(q), q
    is_free = sets.channels.shape[0] == 0 or sets.channels[j, 0] == CONSTANT
    if leak > 0.0 or has_dipole(dipole) or not is_free:
        return strongest_by_parts(sets, sets.channels, j, y, q, leak, tolerance)
    most, place = strongest_in_ball(y, q, radius)
    return most, most + ROUND * norm(q) / (dot(q, q) - radius * radius), place
