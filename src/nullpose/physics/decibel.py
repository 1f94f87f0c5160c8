"""Decibels of a power ratio."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.types import FloatArray


def to_db(ratio: ArrayLike) -> FloatArray:
    """Return ``10 log10(ratio)``, minus infinity where the ratio is zero.

    Args:
        ratio: power ratios, any shape, at least 0.
    """
    with np.errstate(divide="ignore"):
        return np.asarray(10.0 * np.log10(np.asarray(ratio, dtype=float)))


def from_db(ratio_db: ArrayLike) -> FloatArray:
    """Return the power ratio ``10^(ratio_db / 10)``.

    Args:
        ratio_db: decibels, any shape.
    """
    return np.asarray(10.0 ** (np.asarray(ratio_db, dtype=float) / 10.0))
