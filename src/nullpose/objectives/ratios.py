"""Ratios ``(u^T N_k(p) u) / (u^T D_k(p) u)`` of which the smallest is maximised, as plain arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from nullpose.channel.buildings import shadows_of
from nullpose.channel.model import CONSTANT, CUSTOM, WIDTH, padded

if TYPE_CHECKING:
    from nullpose.scenario import Scenario

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]


class Ratios(NamedTuple):
    """Ratios over the link forms of points.

    With ``r_j = points[j] - p`` and ``M(r) = (|r|^2 I - (1 - l) r r^T) / |r|^4``, or for a point with a
    dipole along the unit vector v ``M(r) = (1 - l) a a^T + l |a|^2 I``, ``a = (|r|^2 v - (v.r) r) / |r|^3``,
    or where that dipole has a leak f of its own ``1 - f`` times the second form and f times the first,
    ratio k is ``N_k = n_k I + w_k M(r_a(k))`` over ``D_g(k) = d_g I + sum_e b_e M(r_j(e))``, the sum being
    over the entries e from ``denominator_start[g]`` to ``denominator_start[g + 1]``. Ratios may share a
    denominator. Everything is dimensionless but the positions.

    Args:
        points_m: (m, 3) ground points, metres.
        numerator_isotropic: (r,) ``n_k``.
        numerator_weight: (r,) ``w_k``, m^2.
        numerator_point: (r,) index ``a(k)`` into the points.
        denominator_of: (r,) index ``g(k)`` of each ratio's denominator.
        denominator_isotropic: (g,) ``d_g``, positive.
        denominator_start: (g + 1,) bounds of each denominator's entries.
        denominator_point: (e,) index of each entry's point.
        denominator_weight: (e,) ``b_e``, m^2.
        turn: (m, 3, 3) rotations: point j sees the axis ``turn[j] u``; or (0, 3, 3), where all see u itself.
        leak: l, the antenna's gain along its axis; it is 1 across it.
        ground_axes: (m, 3) v, the unit axis of a point's dipole, zero where it has none; or (0, 3), where no
            point has one.
        ground_leaks: (m,) f, the gain of a point's dipole along its axis, 1 where it has none; or (0,), where
            no point has one.
        channels: (m, w) the row of each point's channel (:mod:`nullpose.channel`), whose excess gain
            multiplies its ``M(r)``; or (0, w), where all are in free space.
        shadows_of_point: (m + 1,) where the shadows of each point begin in ``shadow_start``, and where the
            last ones end; (1,) without buildings.
        shadow_start: (n + 1,) where the sides of each shadow begin.
        shadow_sides: (s, 5) outward unit normal and offset of each side, ``n . p <= c`` inside: there the
            excess gain is multiplied by the channel's ``BLOCKED``; and the offset of searches, a hair off.
    """

    points_m: FloatArray
    numerator_isotropic: FloatArray
    numerator_weight: FloatArray
    numerator_point: IntArray
    denominator_of: IntArray
    denominator_isotropic: FloatArray
    denominator_start: IntArray
    denominator_point: IntArray
    denominator_weight: FloatArray
    turn: FloatArray = np.zeros((0, 3, 3))
    leak: float = 0.0
    ground_axes: FloatArray = np.zeros((0, 3))
    ground_leaks: FloatArray = np.zeros(0)
    channels: FloatArray = np.zeros((0, WIDTH))
    shadows_of_point: IntArray = np.zeros(1, dtype=np.int64)
    shadow_start: IntArray = np.zeros(1, dtype=np.int64)
    shadow_sides: FloatArray = np.zeros((0, 5))


def ground_of(scenario: Scenario, *kinds: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the dipoles' axes, (m, 3), and leaks, (m,), empty without dipoles, and the largest gains, (m,).

    Args:
        scenario: with its points.
        kinds: of the points, in order, as in ``"node"``.
    """
    groups = [(getattr(scenario, f"{k}_antennas"), len(getattr(scenario, f"{k}_positions_m"))) for k in kinds]
    parts = [antennas or (np.zeros((n, 3)), np.ones(n), np.ones(n)) for antennas, n in groups]
    axes, shares, leaks = (np.concatenate(part) for part in zip(*parts, strict=True))
    return (axes, leaks, shares) if np.any(axes) else (axes[:0], leaks[:0], shares)


def channels_of(scenario: Scenario, *kinds: str, others: int = 0) -> tuple[dict[str, Any], FloatArray]:
    """Return the fields of ratios for the points' channels and buildings, and the strengths, (m,).

    There are no fields where no link's gain over free space changes with the position, functions in Python
    left aside.

    Args:
        scenario: with its points.
        kinds: of the points, in order, as in ``"node"``.
        others: the number of points after them that are in no ratio.
    """
    groups = [(getattr(scenario, f"{k}_channels"), len(getattr(scenario, f"{k}_positions_m"))) for k in kinds]
    parts = [(c.rows, c.strengths) if c else (np.zeros((n, WIDTH)), np.ones(n)) for c, n in groups]
    rows = padded([row for rows, _ in parts for row in rows])
    strengths = np.concatenate([strengths for _, strengths in parts])
    if np.isin(rows[:, 0], (CONSTANT, CUSTOM)).all() and scenario.prisms is None:
        return {}, strengths
    rows = np.pad(rows, ((0, others), (0, 0)))
    if scenario.prisms is None:
        return {"channels": rows}, strengths
    points_m = np.vstack([getattr(scenario, f"{k}_positions_m").reshape(-1, 3) for k in kinds])
    is_interferer = np.concatenate([c.is_interferer for c, _ in groups])
    of_point, start, sides = shadows_of(scenario.prisms, points_m, is_interferer)
    of_point = np.append(of_point, np.full(others, of_point[-1]))
    shadows = {"shadows_of_point": of_point, "shadow_start": start, "shadow_sides": sides}
    return {"channels": rows, **shadows}, strengths
