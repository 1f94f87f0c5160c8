"""A power law: the gain falls with a power of the distance (log-distance path loss), as in free space."""

from __future__ import annotations

import numpy as np

from nullpose.channel.convex import FloatArray
from nullpose.channel.model import (
    BY_DISTANCE,
    CONSTANT,
    EXPONENT,
    REFERENCE_M,
    ChannelModel,
    LinkChannel,
    channel_row,
)


def distance_excess(
    row: FloatArray, distance_m: FloatArray, elevation_rad: FloatArray, azimuth_rad: FloatArray
) -> FloatArray:
    """Evaluate ``(d / d0)^(2 - alpha)``: a gain of ``(d / d0)^-alpha`` over that of free space.

    Args:
        row: with ``2 - alpha`` and d0 [m].
        distance_m: d.
        elevation_rad: of no effect.
        azimuth_rad: likewise.
    """
    return np.asarray((distance_m / row[REFERENCE_M]) ** row[EXPONENT])


def constant_channel(strength: float) -> LinkChannel:
    """Return free space with another strength.

    Args:
        strength: the power over that of free space, a ratio.
    """
    return LinkChannel(strength, channel_row(CONSTANT), distance_excess)


def power_law(exponent: float, reference_distance_m: float, is_interferer: bool = False) -> LinkChannel:
    """Return the channel of gain ``reference gain * (d / d0)^-alpha``.

    Args:
        exponent: alpha, 1.6 to 6; 2 with d0 = 1 m is free space.
        reference_distance_m: d0, at which the reference gain holds; links are no shorter.
        is_interferer: of no effect.

    Example:
        >>> channel = power_law(3.0, 1.0)
        >>> float(channel.strength * channel.excess(channel.row, 100.0, 0.5, 0.0) / 100.0**2)
        1e-06
    """
    if exponent == 2.0:
        return constant_channel(reference_distance_m**2)
    row = channel_row(BY_DISTANCE, (2.0 - exponent, reference_distance_m))
    return LinkChannel(reference_distance_m**2, row, distance_excess)


FREE_SPACE = ChannelModel(
    "free space with line of sight, as in the paper", lambda is_interferer: constant_channel(1.0)
)
POWER_LAW = ChannelModel(
    "a gain that falls with a power of the distance",
    power_law,
    {"exponent": None, "reference_distance_m": 1.0},
)
