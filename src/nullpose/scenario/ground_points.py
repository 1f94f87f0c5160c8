"""Transmitters on the ground: the nodes to hear, and the jammers that drown them."""

from __future__ import annotations

from typing import ClassVar

from pydantic import Field

from nullpose.scenario.names import Label
from nullpose.scenario.section import Section
from nullpose.scenario.units import DecibelMilliwatts, Position, Watts, watts_from_dbm

__all__ = ["GroundPoint", "Jammer", "Node"]


class GroundPoint(Section):
    """A transmitter at a fixed place, with an isotropic antenna.

    Args:
        name: how results and overrides refer to it; a scenario names it by its place when left out.
        position_m: east, north and up from the origin [m], (3,).
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm.
    """

    pairs: ClassVar[tuple[tuple[str, str], ...]] = (("power_w", "power_dbm"),)
    letter: ClassVar[str]
    """The letter of names given by place: S1, S2 and so on for nodes, M1, M2 for jammers."""

    name: Label = Field(
        default="",
        description="Name, unique among nodes and jammers. Left out: S1, S2, ... for nodes and M1, M2, ... "
        "for jammers, by their place in the file.",
    )
    position_m: Position = Field(
        description="Position in metres from the origin: [east, north, up].",
        examples=[[17.0, 15.0, 4.0]],
    )
    power_w: Watts | None = Field(
        default=None,
        description="Transmit power in watts. Either this or power_dbm.",
        examples=[1.0],
    )
    power_dbm: DecibelMilliwatts | None = Field(
        default=None,
        description="Transmit power in dBm. Either this or power_w.",
        examples=[20.0],
    )

    @property
    def transmit_power_w(self) -> float:
        """Transmit power, however it was stated [W]."""
        if self.power_w is not None:
            return self.power_w
        assert self.power_dbm is not None, "validation lets exactly one of the two through"
        return watts_from_dbm(self.power_dbm)


class Node(GroundPoint):
    """A legitimate node whose signal the vehicle is to receive."""

    header: ClassVar[str] = "a node, in a table of its own headed [[nodes]]"
    letter: ClassVar[str] = "S"


class Jammer(GroundPoint):
    """A jammer whose signal drowns the nodes."""

    header: ClassVar[str] = "a jammer, in a table of its own headed [[jammers]]"
    letter: ClassVar[str] = "M"
