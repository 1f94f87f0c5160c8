"""A number that a run is judged by: what it is, which way is better, and how much worse is still the same."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

__all__ = ["EXACT", "TIMING", "Direction", "Metric", "Tolerance"]


class Direction(StrEnum):
    """Which way is better."""

    LOWER = "lower"
    HIGHER = "higher"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """How much worse than the baseline still passes: the sum of both parts.

    Args:
        relative: a share of the baseline's size.
        absolute: in the metric's unit.
    """

    relative: float = 0.0
    absolute: float = 0.0

    def margin(self, baseline: float) -> float:
        """Return the margin around a baseline value, in the metric's unit."""
        return self.absolute + self.relative * abs(baseline)


EXACT = Tolerance()
TIMING = Tolerance(relative=1.0)
"""For times: another machine, or a busy one, may well take twice as long."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Metric:
    """One measured number.

    Args:
        key: dotted name, its workload first.
        value: what was measured.
        unit: its unit, or "1" for a pure number.
        direction: which way is better.
        tolerance: how much worse than the baseline still passes.
        about: what it is, in words.
        limit: a value that must be met whatever the baseline says; None if none is promised.
    """

    key: str
    value: float
    unit: str
    direction: Direction
    tolerance: Tolerance
    about: str
    limit: float | None = None

    @property
    def meets_limit(self) -> bool:
        """Whether the promised value, if there is one, is met; NaN meets nothing."""
        return self.limit is None or self._is_no_worse(self.limit)

    def regressed_from(self, baseline: float) -> bool:
        """Return whether the value is worse than a baseline by more than the tolerance."""
        margin = self.tolerance.margin(baseline)
        return not self._is_no_worse(
            baseline + margin if self.direction is Direction.LOWER else baseline - margin
        )

    def _is_no_worse(self, bar: float) -> bool:
        if math.isnan(self.value):
            return False
        return self.value <= bar if self.direction is Direction.LOWER else self.value >= bar
