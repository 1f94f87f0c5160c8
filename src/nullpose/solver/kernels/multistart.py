"""The search with its last climbs, in one kernel: whatever a solve asks of the search is compiled once."""

from __future__ import annotations

import math

from nullpose.solver.kernels.jit import heap_kernel
from nullpose.solver.kernels.polish import polish
from nullpose.solver.kernels.search import search

_LEAST_GAIN = 1e-12


@heap_kernel
def search_and_climb(
    family, domain, axis_field, landmarks, shift, settings, climbs, most_steps, best_p, best_u, best_z
):
    """Fill the best pose of a search and of climbs from it; return its value, the starts and the evaluations.

    Along a flat, curved ridge the search's own steps may not suffice.

    Args:
        family: the ratios.
        domain: the positions.
        axis_field: the axes.
        landmarks: (m, 3) positions polished first, each after being moved into the domain.
        shift: (3,) offset in [0, 1) of the low-discrepancy sequence: the seed.
        settings: how hard the search tries; with fewer than no rounds it is left out, and the pose that is
            given is climbed from.
        climbs: first barrier weights of the climbs, in units of the log ratio.
        most_steps: of each climb.
        best_p: (3,) in and out.
        best_u: (3,) in and out.
        best_z: output, (ratios,): the ratios' multipliers at that pose.
    """
    value, starts, evaluations = search(
        family, domain, axis_field, landmarks, shift, settings, best_p, best_u, best_z
    )
    if settings.rounds >= 0 and not math.isfinite(value):
        return value, starts, evaluations
    for mu in climbs:
        before = value
        value, steps = polish(family, domain, axis_field, best_p, best_u, mu, most_steps, best_z)
        evaluations += steps
        if steps < most_steps and value <= before + _LEAST_GAIN:
            break
    return value, starts, evaluations
