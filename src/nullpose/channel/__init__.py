"""The channels: what power a link carries beside that of free space.

A link of length d carries the reference gain times ``strength * excess / d^2``; in free space both are 1.
Physics, solver and certificate ask the channel for these two.
"""

from __future__ import annotations

from nullpose.channel.custom import Custom
from nullpose.channel.elevation import ELEVATION, ENVIRONMENTS
from nullpose.channel.model import ChannelModel, LinkChannel, PointChannels, excess_gain
from nullpose.channel.power_law import FREE_SPACE, POWER_LAW

__all__ = [
    "CHANNELS",
    "ENVIRONMENTS",
    "ChannelModel",
    "Custom",
    "LinkChannel",
    "PointChannels",
    "excess_gain",
]

CHANNELS: dict[str, ChannelModel] = {
    "free-space": FREE_SPACE,
    "power-law": POWER_LAW,
    "elevation": ELEVATION,
}
"""By the model in a scenario file."""
