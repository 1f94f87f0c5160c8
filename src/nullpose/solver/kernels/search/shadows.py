"""Shadows of buildings as a search keeps out of them, or inside of them: pieces of the domain around a start.

Across a shadow's edge a link changes by leaps. A climb keeps the line of sight that it begins with: nodes'
links in the clear stay out of each shadow, and interferers' links that are blocked stay in it.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.problem.records import Domain
from nullpose.solver.kernels.compiler.jit import inner_heap_kernel, inner_kernel
from nullpose.solver.kernels.linear_algebra.symmetric import copy_table
from nullpose.solver.kernels.linear_algebra.vectors import dot


@inner_kernel
def add_side(side, sign, sides, s):
    """Put a shadow's side, or its inside with a sign of -1, among the sides of a domain's pieces."""
    sides[s, 0] = 0.0
    for i in range(3):
        sides[s, 1 + i] = sign * side[i]
    sides[s, 4] = sign * side[4]


@inner_heap_kernel
def domain_in_sight(family, domain, p):
    """Return the domain in which the line of sight of every link stays as good as at a position."""
    shadows, old = family.shadow_start.shape[0] - 1, domain.piece_start.shape[0] - 1
    pieces = old + family.shadow_sides.shape[0]
    start, sides = np.empty(pieces + 1, np.int64), np.empty((domain.piece_sides.shape[0] + pieces - old, 5))
    copy_table(domain.piece_sides, sides)
    for piece in range(old + 1):
        start[piece] = domain.piece_start[piece]
    pieces, last = old, domain.piece_sides.shape[0]
    for shadow in range(shadows):
        first, end = family.shadow_start[shadow], family.shadow_start[shadow + 1]
        outside = -math.inf
        for s in range(first, end):
            outside = max(outside, dot(family.shadow_sides[s], p) - family.shadow_sides[s, 4])
        keeps_out = family.shadow_sides[first, 4] > family.shadow_sides[first, 3]  # a node's
        if keeps_out == (outside > 0.0):
            for s in range(first, end):
                add_side(family.shadow_sides[s], 1.0 if keeps_out else -1.0, sides, last)
                last += 1
                if not keeps_out or s == end - 1:
                    pieces += 1
                    start[pieces] = last
    return Domain(
        domain.low_m, domain.high_m, domain.keep_out_points_m, domain.keep_out_m, start[: pieces + 1],
        sides[:last], domain.zone_kind, domain.zone_start, domain.zone_edges, domain.zone_range_m,
    )  # fmt: skip
