"""The domain of positions: what is in it."""

from __future__ import annotations

from nullpose.solver.kernels.jit import kernel
from nullpose.solver.kernels.zones import in_zone


@kernel
def contains(domain, p):
    """Check whether a position is in the box, outside of every keep-out ball and in no zone."""
    for i in range(3):
        if not domain.low_m[i] <= p[i] <= domain.high_m[i]:
            return False
    for q in range(domain.keep_out_points_m.shape[0]):
        square = 0.0
        for i in range(3):
            square += (domain.keep_out_points_m[q, i] - p[i]) ** 2
        if not square >= domain.keep_out_m * domain.keep_out_m:
            return False
    forbidden = False
    for z in range(domain.zone_kind.shape[0]):
        forbidden = forbidden or in_zone(domain, z, p)
    return not forbidden
