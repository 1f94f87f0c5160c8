"""Looking through a box for a position, by halving it until it is found or ruled out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

__all__ = ["find_position"]

Array = NDArray[np.float64]

_TOUCHING = 1e-9  # relative to the box; a part this small that cannot be ruled out counts as found
_BATCH = 256


def find_position(
    lower_m: Array, upper_m: Array, clearance_m: Callable[[Array], Array], most_parts: int = 60_000
) -> tuple[Array | None, bool]:
    """Returns a position [m] in a box at which a clearance is not negative, or None; and whether it is sure.

    A clearance may change by no more than the distance gone (distances from sets do, and the least of
    several). So a part of the box whose middle has a clearance below minus its half diagonal holds no such
    position. The parts with the greatest clearance are halved first, across their longest side.

    Args:
        lower_m: lower corner of the box [m], (3,), finite.
        upper_m: upper corner [m], (3,), finite.
        clearance_m: from positions [m], (n, 3), to clearances [m], (n,).
        most_parts: parts that are looked at before it gives up.
    """
    if (lower_m > upper_m).any():
        return None, True
    smallest_m = _TOUCHING * (1.0 + np.abs([lower_m, upper_m]).max())
    middles, halves = (0.5 * (lower_m + upper_m))[None], (0.5 * (upper_m - lower_m))[None]
    clearances = clearance_m(middles)
    looked_at = 1
    while True:
        best = int(clearances.argmax())
        if clearances[best] >= 0.0:
            return middles[best], True
        kept = clearances >= -np.linalg.norm(halves, axis=1)
        middles, halves, clearances = middles[kept], halves[kept], clearances[kept]
        if not len(middles):
            return None, True
        best = int(clearances.argmax())
        if halves[best].max() <= smallest_m:
            return middles[best], True
        if looked_at > most_parts:
            return None, False
        order = np.argsort(-clearances)
        chosen, rest = order[:_BATCH], order[_BATCH:]
        new_middles, new_halves = _halved(middles[chosen], halves[chosen])
        looked_at += len(new_middles)
        middles = np.concatenate([new_middles, middles[rest]])
        halves = np.concatenate([new_halves, halves[rest]])
        clearances = np.concatenate([clearance_m(new_middles), clearances[rest]])


def _halved(middles: Array, halves: Array) -> tuple[Array, Array]:
    rows, longest = np.arange(len(halves)), halves.argmax(axis=1)
    smaller = halves.copy()
    smaller[rows, longest] *= 0.5
    step = np.zeros_like(halves)
    step[rows, longest] = smaller[rows, longest]
    return np.concatenate([middles - step, middles + step]), np.concatenate([smaller, smaller])
