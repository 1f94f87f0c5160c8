"""What a channel model states of itself, and the channels of several links."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import zip_longest
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.channel.buildings import Prisms, is_blocked
from nullpose.channel.convex import FloatArray

WIDTH = 8
"""Numbers in the row of a link's channel: its kind, and what stands at the places below.

Where any ground antenna has a profile, rows go on with it (:mod:`nullpose.channel.profile`).
"""
EXPONENT, REFERENCE_M, ONSET, RATE, HIDDEN, AVERAGE, BLOCKED = range(1, WIDTH)
"""Where in a row each number stands.

The excess gain of any kind has the factor ``(d / d0)^e`` where e is not 0: e and d0 [m]. One by elevation
has ``ln a + a b`` and b per radian of the probability of line of sight, the gain without line of sight over
that with it, and which average. The last multiplies the gain where a building blocks the line of sight; it
is 1 without buildings.
"""

KNOTS = WIDTH
"""Where in a row the number of the profile's knots stands, or 0; the knots follow.

A knot is three numbers: its elevation [rad], ``ln g`` over that of the peak, and the slope of this [1/rad].
"""

CONSTANT, BY_DISTANCE, BY_ELEVATION, CUSTOM = 0, 1, 2, 3
"""Kinds: an excess gain of 1, one of the distance alone, one of the elevation, and any function."""


class LinkChannel(NamedTuple):
    """The channel of a link, as numbers.

    Args:
        strength: the largest excess over free space [a power ratio; for a power law that at its reference
            distance d0, times d0^2].
        row: (WIDTH,) its kind and the numbers of its excess gain; longer with a profile.
        excess: from the row, the distance [m], and the elevation and the azimuth [rad] of the drone at the
            ground point to the excess gain, a power ratio; for arrays as for numbers.
    """

    strength: float
    row: tuple[float, ...]
    excess: Callable[..., FloatArray]

    def behind_buildings(self, blocked: float) -> LinkChannel:
        """Return the channel of which so much is left, a power ratio, where a building blocks it."""
        return self._replace(row=(*self.row[:BLOCKED], blocked))


def channel_row(
    kind: int, law: tuple[float, ...] = (0.0, 1.0), sight: tuple[float, ...] = (0.0, 0.0, 1.0, 0.0)
) -> tuple[float, ...]:
    """Return the row of a channel without buildings.

    Args:
        kind: which kind.
        law: the exponent and the reference distance of its factor by distance; 1 everywhere, if left out.
        sight: the four numbers of a gain by elevation; likewise.
    """
    return (kind, *law, *sight, 1.0)


class ChannelModel(NamedTuple):
    """A channel model, as ``model`` in the table ``[channel]`` names it.

    Args:
        summary: what it is, for the schema of scenario files.
        make: from the values of ``keys``, by name, and whether the link is an interferer's, to its channel.
        keys: of the table ``[channel]`` that have a meaning for it, beside ``model``: each with its value
            where it is left out, None where it may not be.
    """

    summary: str
    make: Callable[..., LinkChannel]
    keys: Mapping[str, float | str | None] = MappingProxyType({})


class PointChannels(NamedTuple):
    """The channels between the drone and several ground points.

    Args:
        strengths: (m,) the strength of each.
        rows: (m, w) the row of each, padded with zeros.
        groups: the excess gain and the places of the points that it is for, one pair for each kind.
        prisms: the buildings; None without any.
        is_interferer: (m,) whether each is a jammer or an eavesdropper, which the lower roofs count for.
    """

    strengths: FloatArray
    rows: FloatArray
    groups: tuple[tuple[Callable[..., FloatArray], NDArray[np.int64]], ...]
    prisms: Prisms | None = None
    is_interferer: NDArray[np.bool_] = np.zeros(0, dtype=bool)

    @classmethod
    def of(
        cls, channels: list[LinkChannel], prisms: Prisms | None = None, is_interferer: Sequence[bool] = ()
    ) -> PointChannels:
        """Collect the channels of points, in their order."""
        places: dict[Callable[..., FloatArray], list[int]] = {}
        for place, channel in enumerate(channels):
            places.setdefault(channel.excess, []).append(place)
        return cls(
            np.array([channel.strength for channel in channels]),
            padded([channel.row for channel in channels]),
            tuple((excess, np.array(group, dtype=np.int64)) for excess, group in places.items()),
            prisms,
            np.array(is_interferer, dtype=bool),
        )

    def blocked_gain(self, positions_m: FloatArray, points_m: FloatArray) -> FloatArray:
        """Evaluate what buildings leave of each link, 1 where its line of sight is clear, (..., m).

        Args:
            positions_m: of the drone, (..., 3), metres.
            points_m: the ground points, (m, 3), or (..., m, 3) where they differ, metres.
        """
        if self.prisms is None:
            return np.ones(np.broadcast_shapes(positions_m[..., None, :].shape, points_m.shape)[:-1])
        blocked = is_blocked(self.prisms, positions_m, points_m, self.is_interferer)
        return np.where(blocked, self.rows[:, BLOCKED], 1.0)


def padded(rows: Iterable[Sequence[float] | FloatArray]) -> FloatArray:
    """Stack the rows of channels, (m, w), shorter ones with zeros behind."""
    columns = zip_longest(np.zeros(WIDTH), *rows, fillvalue=0.0)
    return np.ascontiguousarray(np.array([*columns], dtype=np.float64).T[1:])


_ELEVATIONS_RAD = np.radians(np.linspace(-90.0, 90.0, 721))


def largest_excess_gain(channels: PointChannels, distance_m: FloatArray) -> FloatArray:
    """Evaluate the largest of ``strength * excess`` at a distance, at elevations a quarter of a degree apart.

    Args:
        channels: of the points.
        distance_m: of the drone from each, (m,).
    """
    level, up = np.cos(_ELEVATIONS_RAD), np.sin(_ELEVATIONS_RAD)
    to_points = np.column_stack([level, np.zeros(len(up)), -up])[:, None]
    return np.asarray(excess_gain(channels, np.asarray(distance_m)[:, None] * to_points).max(axis=0))


def excess_gain(
    channels: PointChannels, to_points_m: FloatArray, points_m: FloatArray | None = None
) -> FloatArray:
    """Evaluate ``strength * excess`` of links: their power gain over that of free space.

    Args:
        channels: of the points.
        to_points_m: from the drone to each point, (..., m, 3), metres.
        points_m: where they are, (m, 3), or (..., m, 3) where that differs, metres: then buildings count.

    Returns:
        Array of shape (..., m), power ratios.
    """
    x, y, z = to_points_m[..., 0], to_points_m[..., 1], -to_points_m[..., 2]
    level_m = np.hypot(x, y)
    distance_m, elevation_rad, azimuth_rad = np.hypot(level_m, z), np.arctan2(z, level_m), np.arctan2(-x, -y)
    gain = np.ones(distance_m.shape)
    for excess, places in channels.groups:
        row = channels.rows[places].T
        gain[..., places] = excess(
            row, distance_m[..., places], elevation_rad[..., places], azimuth_rad[..., places]
        )
    if channels.prisms is not None and points_m is not None:
        gain *= channels.blocked_gain(points_m[..., 0, :] - to_points_m[..., 0, :], points_m)
    return np.asarray(channels.strengths * gain)
