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
        shares: (r,) of a geometric mean ``prod_k (a + ratio_k)^share_k``, summing to one, where that is
            maximised and not the smallest ratio; all ratios have one denominator then. Or (0,).
        offset: a, 0 or 1.
        requirements: (r,) the least that each ratio of a mean may be, 0 where any will do; or (0,), where
            none has to be anything.
        pairs: (q, 2) two ratios each, where the smallest quotient of such is maximised: the first, of a
            node, over the second, of an eavesdropper. Or (0, 2), where the smallest ratio is.
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
    shares: FloatArray = np.zeros(0)
    offset: float = 0.0
    requirements: FloatArray = np.zeros(0)
    pairs: IntArray = np.zeros((0, 2), dtype=np.int64)


_KINDS = ("node", "eavesdropper", "jammer", "destination", "sender")


def points_of(scenario: Scenario, *kinds: str) -> dict[str, Any]:
    """Return the fields of ratios about their points: places, dipoles, channels and shadows.

    All other points of the scenario follow, which are in no ratio, but to be kept clear of.

    There are none of dipoles without one, and none of channels where no link's gain over free space changes
    with the position, functions in Python left aside.

    Args:
        scenario: with its points.
        kinds: of the points in the ratios, in order, as in ``"node"``.
    """
    others = [kind for kind in _KINDS if kind not in kinds]
    every = [(kind, getattr(scenario, f"{kind}_positions_m")) for kind in (*kinds, *others)]
    groups = [(getattr(scenario, f"{kind}_antennas"), len(points_m)) for kind, points_m in every]
    antennas = [(each.axes, each.leaks) if each else (np.zeros((n, 3)), np.ones(n)) for each, n in groups]
    axes, leaks = (np.concatenate(part) for part in zip(*antennas, strict=True))
    count = len(axes) if np.any(axes) else 0
    return {
        "points_m": np.vstack([points_m for _, points_m in every]),
        "ground_axes": axes[:count],
        "ground_leaks": leaks[:count],
        **_channels_of(scenario, every[: len(kinds)], len(axes)),
    }


def _channels_of(scenario: Scenario, kinds: list[tuple[str, FloatArray]], count: int) -> dict[str, Any]:
    """Return the fields about the channels and shadows of some kinds of points, of so many points in all."""
    groups = [(getattr(scenario, f"{kind}_channels"), len(points_m)) for kind, points_m in kinds]
    rows = padded([row for c, n in groups for row in (c.rows if c else np.zeros((n, WIDTH)))])
    if np.isin(rows[:, 0], (CONSTANT, CUSTOM)).all() and scenario.prisms is None:
        return {}
    others = count - len(rows)
    rows = np.pad(rows, ((0, others), (0, 0)))
    if scenario.prisms is None:
        return {"channels": rows}
    points_m = np.vstack([points_m for _, points_m in kinds])
    is_interferer = np.concatenate([c.is_interferer for c, _ in groups])
    of_point, start, sides = shadows_of(scenario.prisms, points_m, is_interferer)
    of_point = np.append(of_point, np.full(others, of_point[-1]))
    return {"channels": rows, "shadows_of_point": of_point, "shadow_start": start, "shadow_sides": sides}


def gains_of(scenario: Scenario, kind: str) -> FloatArray:
    """Return the largest gain of each point's antenna times the strength of its channel, (m,).

    Args:
        scenario: with its points.
        kind: of the points, as in ``"node"``.
    """
    antennas, channels = getattr(scenario, f"{kind}_antennas"), getattr(scenario, f"{kind}_channels")
    shares = np.ones(len(getattr(scenario, f"{kind}s"))) if antennas is None else antennas.shares
    return np.asarray(shares if channels is None else shares * channels.strengths)


def snr_weights(scenario: Scenario, kind: str) -> FloatArray:
    """Return ``g0 P / sigma_k^2`` of points that receive from the drone, times their gains, (m,), m^2.

    Args:
        scenario: with a transmitter.
        kind: of the points, as in ``"node"``.
    """
    assert scenario.transmitter is not None, "validation lets no such objective through without it"
    sent = scenario.reference_gain * scenario.transmitter.transmit_power_w
    return np.asarray(sent * gains_of(scenario, kind) / getattr(scenario, f"{kind}_noise_w"))
