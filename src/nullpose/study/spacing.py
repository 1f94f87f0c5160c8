"""The values that a sweep goes through."""

from __future__ import annotations

import math

import numpy as np

from nullpose.errors import UsageError

_DIGITS = 12  # significant digits kept, so that a decade lands on 0.01 and not on 0.009999999999999998


def spaced(start: float, stop: float, points: int, *, log: bool = False) -> tuple[float, ...]:
    """Return evenly spaced values, both ends included.

    Evenly in the value, or in its logarithm (a constant ratio from one to the next).

    Args:
        start: the first value, finite; positive if ``log``.
        stop: the last value, finite and other than ``start``; positive if ``log``.
        points: how many, at least 2.
        log: space the logarithms evenly.

    Raises:
        UsageError: any of these does not hold; the message lists all that do not.
    """
    needed = "a finite number above 0" if log else "a finite number"
    faults = [
        f"{name}: {value:g} given; {'a logarithmic' if log else 'a'} sweep needs {needed}"
        for name, value in (("from", start), ("to", stop))
        if not math.isfinite(value) or (log and value <= 0.0)
    ]
    if start == stop:
        faults.append(f"to: {stop:g} given, the same as from; a sweep needs two different ends")
    if points < 2:
        faults.append(f"points: {points} given; a sweep needs at least 2")
    if faults:
        count = "1 fault" if len(faults) == 1 else f"{len(faults)} faults"
        raise UsageError("\n  ".join([f"range of the sweep: {count}", *faults]))
    values = (np.geomspace if log else np.linspace)(start, stop, points)
    return (start, *(float(f"{value:.{_DIGITS}g}") for value in values[1:-1]), stop)
