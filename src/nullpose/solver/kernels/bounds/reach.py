"""Boxes of positions at two instants, and what a vehicle with a speed limit flies in between."""

from __future__ import annotations

from nullpose.solver.kernels.bounds.node import CENTRE, HALF
from nullpose.solver.kernels.compiler.jit import kernel


@kernel
def keep_near(rows, others, reach_m, keep):
    """Clear the marks of boxes that are farther than a reach from all of some others.

    Args:
        rows: (n, COLUMNS) the boxes.
        others: (m, COLUMNS).
        reach_m: between two points of them.
        keep: (n,) in and out.
    """
    square = reach_m * reach_m * (1.0 + 1e-9)
    last = 0
    for i in range(rows.shape[0]):
        if not keep[i]:
            continue
        keep[i] = False
        for step in range(others.shape[0]):
            j, apart = (last + step) % others.shape[0], 0.0  # neighbours stand near each other
            for a in range(3):
                between = abs(rows[i, CENTRE + a] - others[j, CENTRE + a])
                gap = between - rows[i, HALF + a] - others[j, HALF + a]
                apart += max(0.0, gap) ** 2
            if apart <= square:
                keep[i], last = True, j
                break
