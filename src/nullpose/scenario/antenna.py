"""Which antenna the drone carries."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from nullpose.antenna import RECORDS, SHORT_DIPOLE, QuadraticAntenna
from nullpose.scenario.rules import Choice
from nullpose.scenario.section import Section

__all__ = ["Antenna"]

_Kind = Annotated[str, Choice("an antenna", tuple(RECORDS))]


class Antenna(Section):
    """The drone's antenna.

    Args:
        kind: the name of a record in :mod:`nullpose.antenna`.
    """

    kind: _Kind = Field(
        default=SHORT_DIPOLE.name,
        description="Which antenna: "
        + ", or ".join(f"{name} ({one.label})" for name, one in RECORDS.items())
        + ".",
        examples=list(RECORDS),
    )

    @property
    def record(self) -> QuadraticAntenna:
        """What the antenna states of itself."""
        return RECORDS[self.kind]
