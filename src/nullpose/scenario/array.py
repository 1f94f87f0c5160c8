"""Several dipoles in place of one."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from nullpose.scenario.rules import Choice, Count
from nullpose.scenario.section import Section
from nullpose.scenario.units import Wavelengths

_Elements = Annotated[int, Count("a number of elements", 1, 64, "count the dipoles")]


_Layout = Annotated[Literal["linear", "circular"], Choice("a layout", ("linear", "circular"))]


class Array(Section):
    """Upright dipoles on a horizontal vehicle, in a row or on a circle, with yaw free.

    Args:
        elements: number of dipoles.
        layout: linear, evenly spaced on a horizontal line; or circular, evenly spaced on such a circle.
        spacing_wavelengths: distance between neighbours in wavelengths.
    """

    elements: _Elements = Field(description="Number of upright dipoles.", examples=[4])
    layout: _Layout = Field(
        description="How they stand: linear (on a horizontal line) or circular (on a horizontal circle).",
        examples=["linear"],
    )
    spacing_wavelengths: Wavelengths = Field(
        description="Distance between neighbours, in wavelengths.", examples=[0.5]
    )
