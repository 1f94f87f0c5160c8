"""One's own channel: a gain that is a function of distance, elevation and azimuth."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from nullpose.channel.convex import FloatArray
from nullpose.channel.model import CUSTOM, LinkChannel, channel_row
from nullpose.errors import UsageError, require_usage

_PAIRS = 4000  # of links at which the bounds are tried
_DISTANCES_M = 1.0, 1e5
_NEAR = 1e-3  # how far apart the links of every other pair are, as a share of all
_ROUNDING = 1e-9
_LOG_PER_RAD = math.radians(1.0) ** -1 * math.log(10.0) / 10.0  # of 1 dB/deg


@dataclass(frozen=True, kw_only=True)
class Custom:
    """A channel whose gain is a function in Python.

    It stands wherever a scenario takes a channel: ``Scenario.from_arrays(..., channel=Custom(gain=...))``.
    Without ``exponents`` and ``db_per_deg`` poses are searched and nothing is bounded; with both there is a
    bound, in floating point, which is as true as they are: pairs of links are tried, and refused if they
    contradict.

    Args:
        gain: from arrays of the distance [m], and of the elevation and the azimuth of the drone seen from the
            ground point [rad, the azimuth clockwise from north] to the power gain over the reference gain of
            the receiver: ``1 / distance**2`` is free space.
        exponents: least and largest path-loss exponent: bounds on ``-d ln(gain) / d ln(distance)``; the least
            is above 0.
        db_per_deg: a bound on the change of the gain by the elevation [dB/deg].
        azimuth_db_per_deg: likewise by the azimuth.
        name: for outputs.

    Raises:
        UsageError: the gain is not a positive number for each link, or contradicts the bounds.

    Example:
        >>> import numpy as np
        >>> from nullpose.channel import Custom
        >>> street = Custom(
        ...     gain=lambda d, elevation, azimuth: np.minimum(d**-2.0, 80.0**1.5 * d**-3.5),
        ...     exponents=(2.0, 3.5),
        ...     db_per_deg=0.0,
        ... )
        >>> street.is_bounded
        True
    """

    gain: Callable[[FloatArray, FloatArray, FloatArray], FloatArray]
    exponents: tuple[float, float] | None = None
    db_per_deg: float | None = None
    azimuth_db_per_deg: float = 0.0
    name: str = "custom"

    def __post_init__(self) -> None:
        shares = np.random.default_rng(0).uniform(size=(3, 2, _PAIRS))
        shares[:, 1, ::2] = shares[:, 0, ::2] * (1.0 - _NEAR) + shares[:, 1, ::2] * _NEAR
        low_m, high_m = np.log(_DISTANCES_M)
        distance_m = np.exp(low_m + (high_m - low_m) * shares[0])
        elevation_rad, azimuth_rad = 0.5 * np.pi * shares[1], 2.0 * np.pi * shares[2]
        excess = np.log(self.excess((), distance_m, elevation_rad, azimuth_rad))
        if not self.is_bounded:
            return
        turns_rad = np.abs(np.diff(elevation_rad, axis=0)[0]), np.abs(np.diff(azimuth_rad, axis=0)[0])
        low, high = self._log_range(np.log(distance_m[1] / distance_m[0])[None], *turns_rad)
        change = excess[1] - excess[0]
        if len(wrong := np.flatnonzero((change < low - _ROUNDING) | (change > high + _ROUNDING))):
            keys = {
                "distances of {} m": distance_m,
                "elevations of {} rad": elevation_rad,
                "azimuths of {} rad": azimuth_rad,
            }
            at = [
                words.format("{:.6g} and {:.6g}".format(*x[:, wrong[0]].tolist()))
                for words, x in keys.items()
            ]
            raise UsageError(
                f"{self.name}: the gain contradicts its bounds between two links with {', '.join(at)}; try "
                "wider exponents, or a larger db_per_deg or azimuth_db_per_deg"
            )

    @property
    def is_bounded(self) -> bool:
        """Whether bounds on its changes are stated."""
        return self.exponents is not None and self.db_per_deg is not None

    def link(self) -> LinkChannel:
        """Make the channel of a link."""
        return LinkChannel(1.0, channel_row(CUSTOM), self.excess)

    def excess(
        self, row: Sequence[float], distance_m: ArrayLike, elevation_rad: ArrayLike, azimuth_rad: ArrayLike
    ) -> FloatArray:
        """Evaluate the gain over that of free space; the row has no effect.

        Raises:
            UsageError: the gain is not a positive number for each link.
        """
        links = np.broadcast_arrays(distance_m, elevation_rad, azimuth_rad)
        gain = np.asarray(self.gain(*links), dtype=float)
        require_usage(
            gain.shape in ((), links[0].shape) and np.all(np.isfinite(gain) & (gain > 0.0)),
            f"{self.name}: the function of the gain must return a positive number for each link, from "
            "arrays of distances, elevations and azimuths",
        )
        return np.asarray(gain * links[0] ** 2)

    def excess_range(
        self, point_m: FloatArray, centre_m: FloatArray, half_m: FloatArray, keep_out_m: float
    ) -> tuple[float, float]:
        """Bound the gain over that of free space for positions of a box.

        Args:
            point_m: the ground point, (3,), metres.
            centre_m: of the box, (3,), metres.
            half_m: its half sides, (3,), metres.
            keep_out_m: the least distance of positions from the point, metres.

        Returns:
            The least and the most.
        """
        offset_m = np.asarray(centre_m) - point_m
        level_m = math.hypot(offset_m[0], offset_m[1])
        distance_m, elevation_rad = math.hypot(level_m, offset_m[2]), math.atan2(offset_m[2], level_m)
        excess = float(self.excess((), distance_m, elevation_rad, math.atan2(offset_m[0], offset_m[1])))
        if not np.any(half_m):
            return excess, excess
        near_m, far_m = np.maximum(np.abs(offset_m) - half_m, 0.0), np.abs(offset_m) + half_m
        levels_m = math.hypot(near_m[0], near_m[1]), math.hypot(far_m[0], far_m[1])
        low_m, high_m = offset_m[2] - half_m[2], offset_m[2] + half_m[2]
        lowest_rad = math.atan2(low_m, levels_m[1 if low_m > 0.0 else 0])
        highest_rad = math.atan2(high_m, levels_m[0 if high_m > 0.0 else 1])
        across_m = math.hypot(half_m[0], half_m[1])
        around_rad = math.asin(across_m / level_m) if across_m < level_m else math.pi
        ends_m = np.maximum([np.linalg.norm(near_m), np.linalg.norm(far_m)], keep_out_m)
        raised_rad = max(elevation_rad - lowest_rad, highest_rad - elevation_rad)
        low, high = self._log_range(np.log(ends_m / distance_m), raised_rad, around_rad)
        return excess * math.exp(low), excess * math.exp(high)

    def reach_m(self, least_gain: float, near_m: float) -> float:
        """Bound the distance at which the gain is so much, for links of at least ``near_m``, metres."""
        assert self.exponents is not None, "the caller asks"
        _, rise = self._log_range(np.zeros(1), 0.75 * math.pi, math.pi)
        most = float(self.excess((), near_m, 0.25 * math.pi, 0.0)) / near_m**2 * math.exp(rise)
        return float(near_m * max(1.0, (most / least_gain) ** (1.0 / self.exponents[0])))

    def _log_range(
        self, log_distances: FloatArray, elevation_rad: ArrayLike, azimuth_rad: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Bound the change of the logarithm of the excess gain from one link to others.

        Args:
            log_distances: (k, ...) logarithms of distances over that of the link.
            elevation_rad: how far their elevations are at most from that of the link.
            azimuth_rad: likewise the azimuths.
        """
        assert self.exponents is not None, "the caller asks"
        assert self.db_per_deg is not None, "likewise"
        turned = _LOG_PER_RAD * (
            self.db_per_deg * np.abs(elevation_rad) + self.azimuth_db_per_deg * np.abs(azimuth_rad)
        )
        by_distance = np.multiply.outer(2.0 - np.asarray(self.exponents), log_distances)
        return by_distance.min(axis=(0, 1)) - turned, by_distance.max(axis=(0, 1)) + turned
