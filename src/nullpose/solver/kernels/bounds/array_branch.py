"""Best-first branch and bound over positions and yaws of an array with digital combining."""

from __future__ import annotations

import heapq
import math

import numpy as np

from nullpose.solver.kernels.bounds.array_enclosure import box_bound
from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel
from nullpose.solver.kernels.linear_algebra.vectors import minus, norm, row
from nullpose.solver.kernels.search.array_response import array_value
from nullpose.solver.kernels.search.domain import forbidding


@inner_kernel
def widest(problem, centre, half):
    """Choose the axis along which phases and amplitudes change most over a box."""
    radius, nearest = 0.0, math.inf
    for n in range(len(problem.base)):
        radius = max(radius, math.hypot(problem.base[n, 0], problem.base[n, 1]))
    for i in range(len(problem.ratios.points_m)):
        nearest = min(nearest, norm(minus(row(problem.ratios.points_m, i), centre)))
    phase = 2.0 * math.pi * radius
    rate = (1.0 + phase) / max(nearest, 1e-9)
    most, axis = phase * half[3], 3
    for i in range(3):
        if half[i] * rate > most:
            most, axis = half[i] * rate, i
    return axis


@heap_kernel
def branch_array(problem, domain, root, target, most, state):
    """Bound the smallest ratio, and count the boxes examined; fill the best centre seen.

    The box with the highest bound is halved until none is above the target, or there are too many.

    Args:
        problem: the array and its scene, each node with its own weights.
        domain: box, keep-out balls and zones of a family.
        root: (2, 4) centre and half widths of the box to begin with: east, north, up, yaw.
        target: bound at which to stop.
        most: boxes at which to stop.
        state: output, (4,); its position may be one that is not allowed.
    """
    boxes = np.empty((most + 2, 2, 4))
    boxes[0] = root
    filled, best = 1, -math.inf
    heap = [(-box_bound(problem, root[0], root[1]), 0)]
    while len(heap) > 0:
        negative, at = heapq.heappop(heap)
        if -negative <= target:
            break
        if filled + 2 > most:
            return -negative, filled
        centre, half = boxes[at, 0], boxes[at, 1]
        value = array_value(problem, centre)
        if value > best:
            best = value
            state[:] = centre
        axis = widest(problem, centre, half)
        for side in (-0.5, 0.5):
            child = boxes[filled]
            child[:] = boxes[at]
            child[0, axis] += side * half[axis]
            child[1, axis] *= 0.5
            if forbidding(domain, child[0], child[1]) < 0:
                bound = min(-negative, box_bound(problem, child[0], child[1]))
                if bound > target:
                    heapq.heappush(heap, (-bound, filled))
                    filled += 1
    return target, filled
