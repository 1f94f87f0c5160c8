"""Ground points that are known only up to a ball."""

from __future__ import annotations

import math
from typing import Annotated

from nullpose.scenario.faults import rejection
from nullpose.scenario.rules import Limits
from nullpose.scenario.section import Section, optional
from nullpose.scenario.wording import plain


class _Radius(Limits):
    """The radius of a ball; the three semi-axes of an ellipsoid are refused with the ball that holds it."""

    def read(self, value: object) -> float:
        """Return the radius, or raise the fault that says what is wrong with it."""
        members = plain(value)
        sizes = members if isinstance(members, list | tuple) else ()
        if len(sizes) == 3 and all(
            isinstance(size, int | float) and 0.0 <= size < math.inf for size in sizes
        ):
            raise rejection(
                f"got the three semi-axes of an ellipsoid, must be {self.allowed}; write "
                f"{float(max(sizes))!r}, the radius of the ball that contains it"
            )
        return super().read(value)


class Uncertain(Section):
    """What a ground point has whose position is known only up to a ball.

    Args:
        uncertainty_m: radius of the ball [m] about the stated position; None for a position that is known.
    """

    uncertainty_m: (
        Annotated[float, _Radius("a radius in m", 0.0, 1e7, "an error is a size; 0 means none")] | None
    ) = optional(
        "How far the true position may be from the stated one, in metres: the radius of a ball. "
        "Used by robust solving. Left out: exactly there.",
        3.0,
    )

    @property
    def uncertainty_reach_m(self) -> float:
        """The greatest distance of the true position from the stated one [m]."""
        return self.uncertainty_m or 0.0
