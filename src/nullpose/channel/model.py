"""What a channel model states of itself, and the channels of several links."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.float64]

WIDTH = 5
"""Numbers in the row of a link's channel: its kind, and up to four of its own."""

CONSTANT, BY_DISTANCE, BY_ELEVATION = 0, 1, 2
"""Kinds: an excess gain of 1, one of the distance alone, one of the elevation alone."""


class LinkChannel(NamedTuple):
    """The channel of a link, as numbers.

    Args:
        strength: the largest excess over free space [a power ratio; for a power law that at its reference
            distance d0, times d0^2].
        row: (WIDTH,) its kind and the numbers of its excess gain.
        excess: from the row, the distance [m] and the elevation angle [rad] of the drone at the ground point
            to the excess gain, a power ratio; for arrays as for numbers.
    """

    strength: float
    row: tuple[float, float, float, float, float]
    excess: Callable[..., FloatArray]


class ChannelModel(NamedTuple):
    """A channel model, as ``model`` in the table ``[channel]`` names it.

    Args:
        summary: what it is, for the schema of scenario files.
        make: from the values of ``keys``, by name, and whether the link is an interferer's, to its channel.
        keys: of the table ``[channel]`` that have a meaning for it, beside ``model``.
    """

    summary: str
    make: Callable[..., LinkChannel]
    keys: tuple[str, ...] = ()


class PointChannels(NamedTuple):
    """The channels between the drone and several ground points.

    Args:
        strengths: (m,) the strength of each.
        rows: (m, WIDTH) the row of each.
        groups: the excess gain and the places of the points that it is for, one pair for each kind.
    """

    strengths: FloatArray
    rows: FloatArray
    groups: tuple[tuple[Callable[..., FloatArray], NDArray[np.int64]], ...]

    @classmethod
    def of(cls, channels: list[LinkChannel]) -> PointChannels:
        """Collect the channels of points, in their order."""
        places: dict[Callable[..., FloatArray], list[int]] = {}
        for place, channel in enumerate(channels):
            places.setdefault(channel.excess, []).append(place)
        return cls(
            np.array([channel.strength for channel in channels]),
            np.array([channel.row for channel in channels]).reshape(-1, WIDTH),
            tuple((excess, np.array(group, dtype=np.int64)) for excess, group in places.items()),
        )


def excess_gain(channels: PointChannels, to_points_m: FloatArray) -> FloatArray:
    """Evaluate ``strength * excess`` of links: their power gain over that of free space.

    Args:
        channels: of the points.
        to_points_m: from the drone to each point, (..., m, 3), metres.

    Returns:
        Array of shape (..., m), power ratios.
    """
    x, y, z = to_points_m[..., 0], to_points_m[..., 1], -to_points_m[..., 2]
    level_m = np.hypot(x, y)
    distance_m, elevation_rad = np.hypot(level_m, z), np.arctan2(z, level_m)
    gain = np.ones(distance_m.shape)
    for excess, places in channels.groups:
        row = channels.rows[places].T
        gain[..., places] = excess(row, distance_m[..., places], elevation_rad[..., places])
    return np.asarray(channels.strengths * gain)
