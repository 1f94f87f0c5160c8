"""Where the vehicle may be."""

from __future__ import annotations

import math
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from nullpose.scenario.arrays import read_only
from nullpose.scenario.section import Section
from nullpose.scenario.units import KeepOutMetres, Range

__all__ = ["Airspace"]


class Airspace(Section):
    """The positions allowed to the vehicle: a box, less a ball around every ground point.

    World frame: east, north, up (ENU), in metres. Without ``x_m`` or ``y_m`` that direction is
    unbounded, as in the paper, which bounds the altitude only (eq. 2.2).

    Args:
        altitude_m: lowest and highest altitude [m]; equal ends fix the altitude.
        x_m: westmost and eastmost position [m], or None for no bound.
        y_m: southmost and northmost position [m], or None for no bound.
        keep_out_m: smallest distance from any node or jammer [m], since the model has no limit there.
    """

    header: ClassVar[str] = "a table headed [airspace]"

    altitude_m: Range = Field(
        description="Lowest and highest altitude of the vehicle above the origin, in metres: [low, high].",
        examples=[[8.0, 30.0]],
    )
    x_m: Range | None = Field(
        default=None,
        description="Range of the vehicle's position towards the east, in metres: [west end, east end]. "
        "Left out: unbounded.",
        examples=[[-100.0, 100.0]],
    )
    y_m: Range | None = Field(
        default=None,
        description="Range of the vehicle's position towards the north, in metres: [south end, north end]. "
        "Left out: unbounded.",
        examples=[[-100.0, 150.0]],
    )
    keep_out_m: KeepOutMetres = Field(
        default=1.0,
        description="Smallest distance in metres between the vehicle and any node or jammer.",
        examples=[1.0],
    )

    @cached_property
    def lower_m(self) -> NDArray[np.float64]:
        """The box's lower corner, (3,), in m; minus infinity where unbounded."""
        return read_only([low for low, _ in self._ranges()], (3,))

    @cached_property
    def upper_m(self) -> NDArray[np.float64]:
        """The box's upper corner, (3,), in m; infinity where unbounded."""
        return read_only([high for _, high in self._ranges()], (3,))

    def _ranges(self) -> tuple[tuple[float, float], tuple[float, float], tuple[float, float]]:
        unbounded = (-math.inf, math.inf)
        return self.x_m or unbounded, self.y_m or unbounded, self.altitude_m
