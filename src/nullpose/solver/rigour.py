"""How a solve ended and how sure its bound is: the words that users read, each with its sentence."""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.errors import SolveError

_ROUNDING = 1e-9  # relative: far more than the rounding of a value and of its bound


class Status(StrEnum):
    """How a solve ended."""

    CERTIFIED = "certified"
    GAP_NOT_REACHED = "gap-not-reached"
    BEST_FOUND = "best-found"
    POSE_GIVEN = "given"

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return _ENDS[self]


_ENDS = {
    Status.CERTIFIED: "certified optimal within the requested gap",
    Status.GAP_NOT_REACHED: "the upper bound is valid, but the requested gap was not reached",
    Status.BEST_FOUND: "best of many local optima, not proved to be global",
    Status.POSE_GIVEN: "the pose was given, not searched for",
}


class Rigour(StrEnum):
    """How sure a bound is. A status says how near it is to the value."""

    VERIFIED = "verified"
    VERIFIABLE = "verifiable"
    FLOATING_POINT = "floating-point"
    NONE = "none"

    @property
    def message(self) -> str:
        """The rigour as a sentence."""
        return _MESSAGES[self]


_MESSAGES = {
    Rigour.VERIFIED: "verified (the bound was checked in interval arithmetic)",
    Rigour.VERIFIABLE: "verifiable (to check the bound: solve --certificate, then verify)",
    Rigour.FLOATING_POINT: "floating-point (the bound is not checked against rounding, no certificate)",
    Rigour.NONE: "none (there is no bound)",
}


def bound_above(value: ArrayLike, bound: ArrayLike) -> NDArray[np.float64]:
    """Return a bound that is not below its value: the larger of both, which differ by rounding if at all.

    Args:
        value: power ratios, any shape.
        bound: what was proved of them, the same shape.

    Raises:
        SolveError: a bound is below its value by more than 1e-9, relative: a fault of nullpose.
    """
    value, bound = np.asarray(value, dtype=float), np.asarray(bound, dtype=float)
    wrong = bound < value * (1.0 - _ROUNDING)
    if wrong.any():
        raise SolveError(
            f"the bound {float(bound[wrong][0])!r} is below the value {float(value[wrong][0])!r} of a pose; "
            "this is a fault of nullpose: please report it with the scenario"
        )
    return np.asarray(np.maximum(value, bound))
