"""Noise, path gain and transmit powers, and how far from its stated place a point may be."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field

from nullpose.scenario.faults import plain, rejection
from nullpose.scenario.rules import Limits
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

_NOISE = (("noise_w",), ("noise_dbm",), ("bandwidth_hz", "noise_figure_db"))
_BOLTZMANN_J_PER_K = 1.380649e-23  # exact by definition of the kelvin
_STANDARD_K = 290.0  # the temperature of noise figures (IEEE)


class Noisy(Section, ways=(Ways(_NOISE, fewest=0),)):
    """What receives, with noise of its own or that of [receiver].

    Args:
        noise_w: noise power in the receiver's bandwidth [W]; or else
        noise_dbm: the same in dBm; or else
        bandwidth_hz: the receiver's bandwidth [Hz], and
        noise_figure_db: its noise figure [dB].
    """

    noise_w: Watts | None = optional(
        "Noise power in the receiver's bandwidth, in watts. Either this, or noise_dbm, or bandwidth_hz with "
        "noise_figure_db. A node, an eavesdropper or a destination that states none has that of [receiver].",
        1e-3,
    )
    noise_dbm: DecibelMilliwatts | None = optional("The same in dBm, in place of noise_w.", -97.0)
    bandwidth_hz: (
        Annotated[float, Limits("a bandwidth in Hz", 1.0, 1e13, "20 MHz is written 20e6")] | None
    ) = optional(
        "Bandwidth of the receiver in Hz, that of one node's channel: with noise_figure_db in place of "
        "noise_dbm. The noise is k T B F at 290 K: -174 dBm/Hz + 10 log10(bandwidth) + noise figure.",
        20e6,
    )
    noise_figure_db: (
        Annotated[float, Limits("a noise figure in dB", 0.0, 100.0, "3 to 10 is usual; it is not negative")]
        | None
    ) = optional("Noise figure of the receiver in dB, with bandwidth_hz.", 6.0)

    @property
    def noise_power_w(self) -> float:
        """Noise power, however it was stated [W]: ``k T B F`` of a bandwidth; 0 where none is."""
        if self.bandwidth_hz is None:
            return power_w(self.noise_w, self.noise_dbm)
        thermal_w = _BOLTZMANN_J_PER_K * _STANDARD_K * self.bandwidth_hz
        return thermal_w * ratio_from_db(self.noise_figure_db or 0.0)


class Receiver(
    Noisy,
    ways=(Ways(_NOISE), exactly_one("reference_gain_db", "frequency_hz")),
    unstated=("attitude_error_deg", "position_error_m"),
):
    """The receiver's noise, the path gain at 1 m, and how well the vehicle holds a pose.

    Args beside those of the noise:
        reference_gain_db: path gain between isotropic antennas 1 m apart [dB]; or else
        frequency_hz: carrier frequency [Hz], from which the free-space gain at 1 m follows.
        attitude_error_deg: largest angle between the true antenna axis and the commanded one [deg].
        position_error_m: largest distance between the true position and the commanded one [m].
    """

    reference_gain_db: Decibels | None = optional(
        "Path gain at a distance of 1 m, in dB. Either this or frequency_hz.", 0.0
    )
    frequency_hz: Hertz | None = optional(
        "Carrier frequency in Hz, from which the free-space path gain at 1 m follows. "
        "Either this or reference_gain_db.",
        2.4e9,
    )
    attitude_error_deg: Annotated[
        float, Limits("an angle in degrees", 0.0, 90.0, "an error is a size, never negative; 0 means none")
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
    def reference_gain(self) -> float:
        """Path gain at 1 m, linear: as stated, or ``(c / (4 pi f))^2`` from the frequency (Friis)."""
        if self.frequency_hz is not None:
            return (SPEED_OF_LIGHT_M_PER_S / (4.0 * math.pi * self.frequency_hz)) ** 2
        return ratio_from_db(self.reference_gain_db or 0.0)


POWER = exactly_one("power_w", "power_dbm")
"""The keys of a transmit power."""


class Powered(Section, ways=(POWER,)):
    """What transmits.

    Args:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm.
    """

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
