"""Free space with line of sight, the paper's channel."""

from __future__ import annotations

from nullpose.channel.convex import FloatArray
from nullpose.channel.model import CONSTANT, ChannelModel, LinkChannel, channel_row


def constant_channel(strength: float) -> LinkChannel:
    """Return free space with another strength.

    Args:
        strength: the power over that of free space, a ratio.
    """
    return LinkChannel(strength, channel_row(CONSTANT), _no_excess)


def _no_excess(
    row: FloatArray, distance_m: FloatArray, elevation_rad: FloatArray, azimuth_rad: FloatArray
) -> FloatArray:
    return distance_m * 0.0 + 1.0


FREE_SPACE = ChannelModel(
    "free space with line of sight, as in the paper", lambda is_interferer: constant_channel(1.0)
)
