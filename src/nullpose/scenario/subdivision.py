"""Looking through a box for a position, by halving it until it is found or ruled out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nullpose.scenario.arrays import Floats

_TOUCHING = 1e-9  # relative to the box; a part this small that cannot be ruled out counts as found
_BATCH = 256


def find_position(
    lower_m: Floats, upper_m: Floats, clearance_m: Callable[[Floats], Floats], most_parts: int = 60_000
) -> tuple[Floats | None, bool]:
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
    parts = 0.5 * np.array([[lower_m + upper_m, upper_m - lower_m]])  # middles and half sides, (n, 2, 3)
    clearances = clearance_m(parts[:, 0])
    looked_at = 1
    while True:
        kept = np.flatnonzero(clearances >= -np.linalg.norm(parts[:, 1], axis=1))
        order = kept[np.argsort(-clearances[kept], kind="stable")]
        parts, clearances = parts[order], clearances[order]
        if not len(parts):
            return None, True
        if clearances[0] >= 0.0 or parts[0, 1].max() <= smallest_m:
            return parts[0, 0], True
        if looked_at > most_parts:
            return None, False
        halved = _halved(parts[:_BATCH])
        looked_at += len(halved)
        parts = np.concatenate([halved, parts[_BATCH:]])
        clearances = np.concatenate([clearance_m(halved[:, 0]), clearances[_BATCH:]])


def _halved(parts: Floats) -> Floats:
    """Returns both halves of each part, cut across its longest side."""
    middles, halves = parts[:, 0], parts[:, 1]
    is_longest = np.arange(3) == halves.argmax(axis=1)[:, None]
    steps = np.where(is_longest, 0.5 * halves, 0.0)
    return np.concatenate([np.stack([middles + s * steps, halves - steps], axis=1) for s in (-1.0, 1.0)])
