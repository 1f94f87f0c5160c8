"""The values that a sweep goes through."""

from __future__ import annotations

import math

from nullpose.errors import UsageError

__all__ = ["spaced"]

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
    faults = []
    for name, value in (("from", start), ("to", stop)):
        if not math.isfinite(value):
            faults.append(f"{name}: {value} given; a finite number is needed")
        elif log and value <= 0.0:
            faults.append(f"{name}: {value:g} given; a logarithmic sweep needs a number above 0")
    if start == stop:
        faults.append(f"to: {stop:g} given, the same as from; a sweep needs two different ends")
    if points < 2:
        faults.append(f"points: {points} given; a sweep needs at least 2")
    if faults:
        count = "1 fault" if len(faults) == 1 else f"{len(faults)} faults"
        raise UsageError("\n  ".join([f"range of the sweep: {count}", *faults]))
    steps = [i / (points - 1) for i in range(points)]
    if log:
        values = [start ** (1.0 - s) * stop**s for s in steps]
    else:
        values = [start * (1.0 - s) + stop * s for s in steps]
    inner = [float(f"{value:.{_DIGITS}g}") for value in values[1:-1]]
    return (start, *inner, stop)
