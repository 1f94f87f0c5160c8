"""Noise, path gain and transmit powers."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar

from pydantic import Field

from nullpose.scenario.rules import Quantity
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import (
    SPEED_OF_LIGHT_M_PER_S,
    DecibelMilliwatts,
    Decibels,
    ErrorMetres,
    Hertz,
    Watts,
    power_w,
    ratio_from_db,
)
from nullpose.scenario.ways import Ways, exactly_one


class Receiver(Section):
    """The receiver's noise power, the path gain at 1 m, and how well the vehicle holds a pose.

    Args:
        noise_w: noise power in the receiver's bandwidth [W]; or else
        noise_dbm: the same in dBm.
        reference_gain_db: path gain between isotropic antennas 1 m apart [dB]; or else
        frequency_hz: carrier frequency [Hz], from which the free-space gain at 1 m follows.
        attitude_error_deg: largest angle between the true antenna axis and the commanded one [deg].
        position_error_m: largest distance between the true position and the commanded one [m].
    """

    ways: ClassVar[tuple[Ways, ...]] = (
        exactly_one("noise_w", "noise_dbm"),
        exactly_one("reference_gain_db", "frequency_hz"),
    )
    unstated: ClassVar[frozenset[str]] = frozenset({"attitude_error_deg", "position_error_m"})

    noise_w: Watts | None = optional(
        "Noise power in the receiver's bandwidth, in watts. Either this or noise_dbm.", 1e-3
    )
    noise_dbm: DecibelMilliwatts | None = optional(
        "Noise power in the receiver's bandwidth, in dBm. Either this or noise_w.", -97.0
    )
    reference_gain_db: Decibels | None = optional(
        "Path gain at a distance of 1 m, in dB. Either this or frequency_hz.", 0.0
    )
    frequency_hz: Hertz | None = optional(
        "Carrier frequency in Hz, from which the free-space path gain at 1 m follows. "
        "Either this or reference_gain_db.",
        2.4e9,
    )
    attitude_error_deg: Annotated[
        float, Quantity("an angle in degrees", 0.0, 90.0, "an error is a size, never negative; 0 means none")
    ] = Field(
        default=0.0,
        description="Largest angle between the true antenna axis and the commanded one, in degrees. Used by "
        "robust solving.",
        examples=[2.0],
    )
    position_error_m: ErrorMetres = Field(
        default=0.0,
        description="Largest distance between the vehicle's true position and the commanded one, in metres. "
        "Used by robust solving.",
        examples=[0.5],
    )

    @property
    def noise_power_w(self) -> float:
        """Noise power, however it was stated [W]."""
        return power_w(self.noise_w, self.noise_dbm)

    @property
    def reference_gain(self) -> float:
        """Path gain at 1 m, linear: as stated, or ``(c / (4 pi f))^2`` from the frequency (Friis)."""
        if self.frequency_hz is not None:
            return (SPEED_OF_LIGHT_M_PER_S / (4.0 * math.pi * self.frequency_hz)) ** 2
        return ratio_from_db(self.reference_gain_db or 0.0)


POWER = exactly_one("power_w", "power_dbm")
"""The keys of a transmit power."""


class Powered(Section):
    """What transmits.

    Args:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm.
    """

    ways: ClassVar[tuple[Ways, ...]] = (POWER,)

    power_w: Watts | None = optional("Transmit power in watts. Either this or power_dbm.", 1.0)
    power_dbm: DecibelMilliwatts | None = optional("Transmit power in dBm. Either this or power_w.", 20.0)

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
