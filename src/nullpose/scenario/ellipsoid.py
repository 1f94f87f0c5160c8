"""Distances from ellipsoids."""

from __future__ import annotations

import numpy as np

from nullpose.scenario.arrays import Floats

_HALVINGS = 100  # of the multiplier's range, which is bounded relative to the answer


def distance_m(points_m: Floats, centre_m: Floats, matrix_m: Floats) -> Floats:
    """Returns how far points are from the set ``{centre + A x : |x| <= 1}`` [m]; 0 inside it.

    With y the offset from the centre along the principal axes, of lengths a, the nearest point of the set is
    ``a^2 y / (a^2 + t)``; the multiplier t is 0 inside and else the positive root of
    ``sum (a y / (a^2 + t))^2 = 1``, which falls as t grows.

    Args:
        points_m: points [m], (n, 3).
        centre_m: middle of the set [m], (3,).
        matrix_m: the matrix A [m], (3, 3); it may be singular.

    Returns:
        Array of shape ``(n,)``.
    """
    squares, axes = np.linalg.eigh(matrix_m @ matrix_m.T)
    squares = np.where(squares > 1e-14 * max(squares.max(), 0.0), squares, 0.0)
    offsets = (points_m - centre_m) @ axes
    low = np.zeros(len(offsets))
    high = np.sqrt(squares.max()) * np.linalg.norm(offsets, axis=1)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        reach = np.linalg.norm(np.sqrt(squares) * _share(offsets, squares, middle), axis=1)
        low, high = np.where(reach > 1.0, middle, low), np.where(reach > 1.0, high, middle)
    return np.asarray(np.linalg.norm(offsets - squares * _share(offsets, squares, high), axis=1))


def _share(offsets: Floats, squares: Floats, multiplier: Floats) -> Floats:
    """Returns ``y / (a^2 + t)``, and 0 where both are 0."""
    total = squares + multiplier[:, None]
    return np.divide(offsets, total, out=np.zeros_like(offsets), where=total > 0.0)
