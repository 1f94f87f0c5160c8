"""Whether an airspace box holds any position outside the keep-out balls."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, islice, product

import numpy as np
from numpy.typing import NDArray

__all__ = ["has_room"]

Array = NDArray[np.float64]

_SLACK = 1e-9  # relative; a position this little inside a ball counts as outside it
_BATCH = 4096  # combinations of balls looked at together


def has_room(lower_m: Array, upper_m: Array, centres_m: Array, radius_m: float) -> bool:
    """Returns whether the box, less the open balls, holds a position.

    Exact up to rounding. What is left of a bounded box is compact, so some linear function in general
    position attains its least value there; and at that place three independent boundaries meet, because a
    step along the tangents of fewer leaves the balls (they are convex) and so could be bent to a lower value.
    Hence the box has room exactly if one of these does not lie in a ball: its corners, the places where a
    sphere meets an edge, two spheres meet on a face, or three spheres meet.

    Args:
        lower_m: lower corner of the box [m], (3,); minus infinity where unbounded.
        upper_m: upper corner of the box [m], (3,); infinity where unbounded.
        centres_m: centres of the balls [m], (n, 3).
        radius_m: their common radius [m].
    """
    if not (np.isfinite(lower_m).all() and np.isfinite(upper_m).all()):
        return True
    nearest_in_box = np.clip(centres_m, lower_m, upper_m)
    centres_m = centres_m[np.linalg.norm(centres_m - nearest_in_box, axis=1) < radius_m]
    corners = np.array(list(product(*zip(lower_m, upper_m, strict=True))))
    if _any_free(corners, lower_m, upper_m, centres_m, radius_m):
        return True
    distances = np.linalg.norm(corners[:, None] - centres_m, axis=-1)
    if (distances.max(axis=0) < radius_m * (1.0 - _SLACK)).any():  # one ball holds the whole box
        return False
    batches = _meeting_points(lower_m, upper_m, np.unique(centres_m, axis=0), radius_m)
    return any(_any_free(batch, lower_m, upper_m, centres_m, radius_m) for batch in batches)


def _any_free(points: Array, lower: Array, upper: Array, centres: Array, radius: float) -> bool:
    slack = _SLACK * (radius + np.abs(points).max(initial=0.0))
    points = points[((points >= lower - slack) & (points <= upper + slack)).all(axis=1)]
    distances = np.linalg.norm(points[:, None] - centres, axis=-1)  # (points, centres)
    return bool((distances >= radius * (1.0 - _SLACK)).all(axis=1).any())


def _meeting_points(lower: Array, upper: Array, centres: Array, radius: float) -> Iterator[Array]:
    for axis in range(3):
        others = [a for a in range(3) if a != axis]
        for ends in product(*zip(lower[others], upper[others], strict=True)):
            yield _on_edge(centres, radius, axis, others, ends)
        for face in (lower[axis], upper[axis]):
            for first, second in _batches(len(centres), 2):
                yield _on_face(centres[first], centres[second], radius, axis, others, face)
    for first, second, third in _batches(len(centres), 3):
        yield _of_three(centres[first], centres[second], centres[third], radius)


def _batches(count: int, size: int) -> Iterator[NDArray[np.intp]]:
    """Yields all combinations of so many indices below count, as (size, at most _BATCH) arrays."""
    remaining = combinations(range(count), size)
    while batch := list(islice(remaining, _BATCH)):
        yield np.array(batch, dtype=np.intp).T


def _on_edge(
    centres: Array, radius: float, axis: int, others: list[int], ends: tuple[np.float64, ...]
) -> Array:
    """Returns where the spheres meet the edge along an axis, (m, 3)."""
    squared = radius**2 - ((centres[:, others] - np.array(ends)) ** 2).sum(axis=1)
    centres, half = centres[squared >= 0.0], np.sqrt(squared[squared >= 0.0])
    points = np.empty((2 * len(half), 3))
    points[:, others] = ends
    points[:, axis] = np.concatenate([centres[:, axis] - half, centres[:, axis] + half])
    return points


def _on_face(
    first: Array, second: Array, radius: float, axis: int, others: list[int], face: np.float64
) -> Array:
    """Returns where pairs of spheres meet on the face at a value of an axis, (m, 3)."""
    first_squared = radius**2 - (first[:, axis] - face) ** 2  # of the circles on the face
    second_squared = radius**2 - (second[:, axis] - face) ** 2
    start, step = first[:, others], second[:, others] - first[:, others]
    length_squared = (step**2).sum(axis=1)
    apart = length_squared > 0.0
    start, step, length_squared = start[apart], step[apart], length_squared[apart]
    first_squared, second_squared = first_squared[apart], second_squared[apart]
    along = 0.5 * (1.0 + (first_squared - second_squared) / length_squared)
    across_squared = first_squared / length_squared - along**2
    meets = across_squared >= 0.0
    start, step, along = start[meets], step[meets], along[meets, None]
    across = np.sqrt(across_squared[meets])[:, None]
    normal = np.stack([-step[:, 1], step[:, 0]], axis=1)
    flat = np.concatenate([start + along * step + sign * across * normal for sign in (-1.0, 1.0)])
    points = np.empty((len(flat), 3))
    points[:, others] = flat
    points[:, axis] = face
    return points


def _of_three(first: Array, second: Array, third: Array, radius: float) -> Array:
    """Returns where triples of spheres meet: above and below the circumcentres of their centres, (m, 3)."""
    b, c = second - first, third - first
    normal = np.cross(b, c)
    area_squared = (normal**2).sum(axis=1)
    b_squared, c_squared = (b**2).sum(axis=1), (c**2).sum(axis=1)
    independent = area_squared > 1e-24 * b_squared * c_squared  # not on one line
    first, b, c, normal = (v[independent] for v in (first, b, c, normal))
    area_squared, b_squared, c_squared = (v[independent, None] for v in (area_squared, b_squared, c_squared))
    centre = np.cross(normal, b * c_squared - c * b_squared) / (2.0 * area_squared)
    height_squared = (radius**2 - (centre**2).sum(axis=1, keepdims=True)) / area_squared
    meets = height_squared[:, 0] >= 0.0
    height = np.sqrt(height_squared[meets]) * normal[meets]
    middle = first[meets] + centre[meets]
    return np.concatenate([middle - height, middle + height])
