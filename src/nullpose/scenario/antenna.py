"""Which antenna the drone carries."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from nullpose.antenna import ANTENNAS, SHORT_DIPOLE, QuadraticAntenna
from nullpose.scenario.rules import Choice
from nullpose.scenario.section import Section
from nullpose.scenario.units import NullDepthDecibels

_Kind = Annotated[str, Choice("an antenna", tuple(ANTENNAS))]


class Antenna(Section):
    """The drone's antenna.

    Args:
        kind: the name of an antenna in :mod:`nullpose.antenna`.
        null_depth_db: how far its gain along the axis is below that across it [dB]; None for a perfect null.
    """

    unstated: ClassVar[frozenset[str]] = frozenset({"kind"})

    kind: _Kind = Field(
        default=SHORT_DIPOLE.name,
        description='Which antenna: "dipole", a short dipole.',
        examples=list(ANTENNAS),
    )
    null_depth_db: NullDepthDecibels | None = Field(
        default=None,
        description="How deep the dipole's null is, in dB below its broadside gain: on an airframe 15 to 35. "
        "Left out: the null is perfect.",
        examples=[30.0],
    )

    @property
    def record(self) -> QuadraticAntenna:
        """What the antenna states of itself."""
        return ANTENNAS[self.kind](self.null_depth_db)
