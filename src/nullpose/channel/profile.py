"""The gain of a ground antenna by elevation, as a table gives it: one more factor of a channel.

``ln g`` meets the table at its rows. Between two rows it is made of two parabolas that meet in the middle.
Its slope is continuous: at a row it is the harmonic mean of the table's slopes beside it, or 0 at peaks, dips
and ends. So the gain rises and falls where the table does, and nowhere else. Source: Schumaker, "On shape
preserving quadratic spline interpolation", SIAM Journal on Numerical Analysis 1983.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from nullpose.channel.convex import FloatArray
from nullpose.channel.model import KNOTS

MOST_ROWS = 721
"""Rows of a table: steps of a quarter of a degree."""


def knots_of(elevation_deg: ArrayLike, gain_dbi: ArrayLike) -> FloatArray:
    """Return the knots of a table, (2 n - 1, 3): its rows, and the middle of any two.

    Args:
        elevation_deg: (n,) rising from -90 to 90.
        gain_dbi: (n,) the gains there.

    Example:
        >>> knots_of([-90.0, 0.0, 90.0], [-10.0, 0.0, -10.0])[2]
        array([0., 0., 0.])
    """
    angle, gain = np.radians(elevation_deg), np.asarray(gain_dbi, dtype=np.float64)
    log = (gain - np.max(gain)) * (math.log(10.0) / 10.0)
    step = np.diff(angle)
    rise = np.diff(log) / step
    before, after, is_steady = rise[:-1], rise[1:], rise[:-1] * rise[1:] > 0.0
    beside = np.divide(2.0 * before * after, before + after, out=np.zeros(len(before)), where=is_steady)
    slope, middle = np.pad(beside, 1), angle[:-1] + 0.5 * step
    ahead, behind = middle - angle[:-1], angle[1:] - middle  # the same but for rounding
    slope_there = 2.0 * rise - (ahead * slope[:-1] + behind * slope[1:]) / step
    half_way = log[:-1] + 0.5 * ahead * (slope[:-1] + slope_there)
    rows, middles = np.column_stack([angle, log, slope]), np.column_stack([middle, half_way, slope_there])
    return np.insert(rows, np.arange(1, len(angle)), middles, axis=0)


def log_gain(row: ArrayLike, elevation_rad: ArrayLike) -> FloatArray:
    """Evaluate ``ln g`` of profiles; 0 of a channel without one.

    Args:
        row: (w,) numbers of a channel; or (w, m) of several.
        elevation_rad: of the drone, at the ground point, any shape; or (..., m).
    """
    numbers, at = np.asarray(row), np.asarray(elevation_rad)
    if numbers.ndim > 1:
        parts = [log_gain(each, at[..., point]) for point, each in enumerate(numbers.T)]
        return np.reshape(np.moveaxis(np.array(parts), 0, -1), at.shape)
    if len(numbers) <= KNOTS or not numbers[KNOTS]:
        return np.zeros(at.shape)
    knots = np.reshape(numbers[KNOTS + 1 :], (-1, 3))[: int(numbers[KNOTS])]
    which = np.clip(np.searchsorted(knots[:, 0], at, "right") - 1, 0, len(knots) - 2)
    (angle, log, slope), (end, _, last) = (np.moveaxis(knots[which + i], -1, 0) for i in (0, 1))
    step = at - angle
    return np.asarray(log + step * (slope + 0.5 * (last - slope) / (end - angle) * step))


def profile_gain(rows: FloatArray, to_points_m: FloatArray) -> FloatArray:
    """Evaluate the gains of ground antennas over their peaks, (m,), towards the drone; 1 without a profile.

    Args:
        rows: (m, w) numbers of the points' channels.
        to_points_m: (m, 3) from the drone to each point, metres.
    """
    east_m, north_m, down_m = to_points_m.T
    return np.exp(log_gain(rows.T, np.arctan2(-down_m, np.hypot(east_m, north_m))))


def mean_gain(elevation_deg: ArrayLike, gain_dbi: ArrayLike) -> float:
    """Return the mean gain of a table over the sphere: what is radiated of the power that is fed."""
    knots = knots_of(elevation_deg, gain_dbi)
    angle = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 7201)
    gain = np.exp(log_gain([*np.zeros(KNOTS), len(knots), *knots.ravel()], angle))
    share = 0.25 * np.sum((gain[1:] + gain[:-1]) * np.diff(np.sin(angle)))
    return float(10.0 ** (0.1 * np.max(gain_dbi)) * share)
