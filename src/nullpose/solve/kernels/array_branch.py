"""Best-first branch and bound over positions and yaws of an array with digital combining."""

from __future__ import annotations

import heapq
import math

import numpy as np

from nullpose.solve.kernels.array_enclosure import box_bound
from nullpose.solve.kernels.array_response import array_value
from nullpose.solve.kernels.jit import heap_kernel, inner_kernel

__all__ = ["branch_array"]


@inner_kernel
def is_forbidden(domain, centre, half):
    """Return whether no position of a box is allowed: all of it inside one ball or one forbidden piece."""
    keep_points, keep_radius = domain.keep_out_points_m, domain.keep_out_m
    start, sides = domain.piece_start, domain.piece_sides
    for q in range(keep_points.shape[0]):
        far = 0.0
        for i in range(3):
            far += (abs(keep_points[q, i] - centre[i]) + half[i]) ** 2
        if far < keep_radius * keep_radius:
            return True
    for c in range(start.shape[0] - 1):
        inside = True
        for s in range(start[c], start[c + 1]):
            side = sides[s]
            if side[0] == 0.0:
                most = -side[4]
                for i in range(3):
                    most += side[1 + i] * centre[i] + abs(side[1 + i]) * half[i]
            else:
                across, along = abs(centre[0] - side[1]) + half[0], abs(centre[1] - side[2]) + half[1]
                most = across * across + along * along - side[4] ** 2
            if most >= 0.0:
                inside = False
                break
        if inside:
            return True
    return False


@inner_kernel
def widest(scene, radius, centre, half):
    """Return the axis along which phases and amplitudes change most over a box."""
    nearest = math.inf
    for i in range(scene[0].shape[0]):
        square = 0.0
        for c in range(3):
            square += (scene[0][i, c] - centre[c]) ** 2
        nearest = min(nearest, square)
    turn = 2.0 * math.pi * radius
    rate = (1.0 + turn) / max(math.sqrt(nearest), 1e-9)
    most, axis = turn * half[3], 3
    for i in range(3):
        if half[i] * rate > most:
            most, axis = half[i] * rate, i
    return axis


@heap_kernel
def branch_array(scene, base, domain, root, target, most, state):
    """Return what the smallest ratio exceeds nowhere, and the boxes examined; fill the best centre seen.

    The box with the highest bound is halved until none is above the target, or there are too many.

    Args:
        scene: points, strengths and number of nodes, as for the response.
        base: (k, 2) elements in body axes, wavelengths.
        domain: box, keep-out balls and forbidden pieces of a family.
        root: (8,) centre and half widths of the box to begin with: east, north, up, yaw.
        target: bound at which to stop.
        most: boxes at which to stop.
        state: output, (4,); its position may be one that is not allowed.
    """
    radius = 0.0
    for n in range(base.shape[0]):
        radius = max(radius, math.hypot(base[n, 0], base[n, 1]))
    boxes = np.empty((most + 2, 8))
    boxes[0] = root
    filled = 1
    best = -math.inf
    heap = [(-box_bound(scene, base, root[:4], root[4:]), 0)]
    middle = np.empty(4)
    while len(heap) > 0:
        negative, at = heapq.heappop(heap)
        if -negative <= target:
            break
        if filled + 2 > most:
            return -negative, filled
        centre, half = boxes[at, :4], boxes[at, 4:].copy()
        value = array_value(scene, base, False, centre)
        if value > best:
            best = value
            state[:] = centre
        axis = widest(scene, radius, centre, half)
        half[axis] *= 0.5
        for side in (-1.0, 1.0):
            middle[:] = centre
            middle[axis] += side * half[axis]
            if is_forbidden(domain, middle, half):
                continue
            bound = min(-negative, box_bound(scene, base, middle, half))
            if bound > target:
                boxes[filled, :4] = middle
                boxes[filled, 4:] = half
                heapq.heappush(heap, (-bound, filled))
                filled += 1
    return target, filled
