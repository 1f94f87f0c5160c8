"""The three summaries of times that the tables give."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

__all__ = ["median", "percentile_95", "shifted_geometric_mean"]


def median(values: Iterable[float]) -> float:
    """Return the median, NaN of nothing."""
    found = np.fromiter(values, dtype=float)
    return float(np.median(found)) if found.size else float("nan")


def percentile_95(values: Iterable[float]) -> float:
    """Return the 95th percentile, NaN of nothing."""
    found = np.fromiter(values, dtype=float)
    return float(np.percentile(found, 95.0)) if found.size else float("nan")


def shifted_geometric_mean(values: Iterable[float], shift: float) -> float:
    """Return ``exp(mean(log(values + shift))) - shift``, NaN of nothing.

    Neither the slowest instances nor differences too small to matter rule it, which is why solvers are
    customarily compared by it (Achterberg, "Constraint Integer Programming", 2007, appendix A.3).

    Args:
        values: not negative.
        shift: what counts as small, in the unit of the values; positive.
    """
    found = np.fromiter(values, dtype=float)
    return float(np.exp(np.mean(np.log(found + shift))) - shift) if found.size else float("nan")
