"""Transmit powers, and that of the drone where it transmits."""

from __future__ import annotations

from typing import ClassVar

from pydantic import Field

from nullpose.scenario.section import Section
from nullpose.scenario.units import DecibelMilliwatts, Watts, power_w
from nullpose.scenario.ways import Ways, exactly_one

POWER = exactly_one("power_w", "power_dbm")
"""The keys of a transmit power."""


class Powered(Section):
    """What transmits.

    Args:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm.
    """

    ways: ClassVar[tuple[Ways, ...]] = (POWER,)

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
        """Transmit power, however it was stated [W]; 0 where none is."""
        return power_w(self.power_w, self.power_dbm)


class Transmitter(Powered):
    """The drone's own transmit power, for the downlink.

    Args:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm.
    """
