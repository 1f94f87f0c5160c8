"""Leaves of a free axis: a weighted sum of forms that is negative definite all over the box.

The same lemmas as the solver's (see "The certificate explained"), written down again: in world coordinates,
turned into a convenient basis by a congruence, which changes no sign, and in interval arithmetic.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.boxes import Boxes, mix_slots
from nullpose.certificate.certificate import TOWARDS, FloatArray, Leaves
from nullpose.certificate.interval import Interval, dot, stack
from nullpose.family import Family

__all__ = ["free_holds", "negative_definite"]

_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
_AREA = 4.0 / np.sqrt(3.0) * (1.0 + 1e-12)  # twice the largest |b''| of the turning, 2 / sqrt(3), rounded up
_SWING = (1.0 + np.sqrt(2.0)) * (1.0 + 1e-12)  # of a constant form in a turning frame, rounded up


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """Where each box's forms are looked at from.

    Args:
        turning: (b,) whether the frame turns towards a point.
        anchor: (b,) that point.
        direction: (b, 3) the unit vector to it, zero where the frame stands still.
        rho: (b,) its distance from the centre, and from the box at least.
        rho_least: (b,) the latter.
        basis: (b, 3, 3) columns: the coordinates that definiteness is asked in.
        gram: basis^T basis, as six numbers.
    """

    turning: np.ndarray
    anchor: np.ndarray
    direction: Interval
    rho: Interval
    rho_least: Interval
    basis: FloatArray
    gram: list[Interval]


def frames_of(family: Family, leaves: Leaves, boxes: Boxes) -> Frames:
    """Return the frames of the boxes' leaves."""
    turning = leaves.test[boxes.leaf] == TOWARDS
    anchor = np.where(turning, leaves.point[boxes.leaf], 0)
    way = Interval(family.points_m[anchor]) - boxes.centre
    rho = dot(way, way).sqrt()
    still = np.where(turning, 1.0, 0.0)
    direction = way / rho[:, None] * still[:, None]
    basis = np.tile(np.eye(3), (len(boxes), 1, 1))
    third = direction.middle()
    for b in np.flatnonzero(turning):
        q, _ = np.linalg.qr(np.column_stack([third[b], np.eye(3)[np.argmin(np.abs(third[b]))]]), "complete")
        basis[b] = np.column_stack([q[:, 1], q[:, 2], third[b]])
    gram = [dot(Interval(basis[:, :, i]), basis[:, :, j]) for i, j in _PAIRS]
    least = Interval(boxes.nearest2(family.points_m[anchor])).sqrt()
    return Frames(turning, anchor, direction, rho, Interval(least.low), basis, gram)


def turned(frames: Frames, vector: Interval) -> list[Interval]:
    """Return basis^T v as three numbers."""
    return [dot(Interval(frames.basis[:, :, i]), vector) for i in range(3)]


def expansion(
    family: Family, frames: Frames, boxes: Boxes, point: np.ndarray
) -> tuple[list[Interval], list[list[Interval]], Interval, Interval]:
    """Return the form of one point for each box: value, three slopes, and bounds on the second derivative.

    The bounds, up and (positive) down, multiply the identity; for the anchor of a turning frame, the
    projector across its direction, which is what its form is made of.
    """
    a = Interval(family.points_m[point]) - boxes.centre
    s = dot(a, a)
    here = turned(frames, a)
    anchored = frames.turning & (point == frames.anchor)
    along = dot(frames.direction, a)
    form = [(g * s - here[i] * here[j]) / s.squared() for g, (i, j) in zip(frames.gram, _PAIRS, strict=True)]
    if np.any(anchored):  # (I - d d^T) / rho^2, without the rounding of a - rho d
        across = projector(frames)
        form = [choose(anchored, q / s, f) for q, f in zip(across, form, strict=True)]
    slopes = []
    for e in range(3):
        unit = np.zeros(3)
        unit[e] = 1.0
        # b' = -e + (e (d.a) - d (a.e)) / rho, and rho d for the anchor itself
        swing = (Interval(unit) * along[:, None] - frames.direction * a[:, e][:, None]) / frames.rho[:, None]
        w = Interval(
            np.where(frames.turning[:, None], swing.low, 0.0),
            np.where(frames.turning[:, None], swing.high, 0.0),
        )
        w = w - unit
        rate = dot(a, w) * 2.0
        moving = turned(frames, w)
        slope = []
        for g, (i, j) in zip(frames.gram, _PAIRS, strict=True):
            bent = (moving[i] * here[j] + here[i] * moving[j] + rate * g) / s.squared()
            slope.append(rate * here[i] * here[j] * 2.0 / (s.squared() * s) - bent)
        if np.any(anchored):
            pull = frames.direction[:, e] * 2.0 / (s * frames.rho)
            slope = [choose(anchored, q * pull, x) for q, x in zip(projector(frames), slope, strict=True)]
        slopes.append(slope)
    near = Interval(boxes.nearest2(family.points_m[point])).sqrt()
    near = Interval(near.low)
    fourth = 1.0 / near.squared().squared()
    turn = frames.turning & ~anchored
    mixed = 1.0 / (near.squared() * near * frames.rho_least) * np.where(turn, 1.0, 0.0)
    both = 1.0 / (near.squared() * frames.rho_least.squared()) * np.where(turn, 1.0, 0.0)
    up = fourth * 6.0 + mixed * 16.0 + both * (6.0 + _AREA)
    down = fourth * np.where(anchored, 2.0, 4.0) + mixed * 12.0 + both * (4.0 + _AREA)
    return form, slopes, Interval(finite(up.high)), Interval(finite(down.high))


def finite(x: FloatArray) -> FloatArray:
    """Return bounds with infinity for those that are undefined."""
    return np.where(np.isnan(x), np.inf, x)


def projector(frames: Frames) -> list[Interval]:
    """Return I - d d^T in the basis, as six numbers."""
    d = turned(frames, frames.direction)
    return [g - d[i] * d[j] for g, (i, j) in zip(frames.gram, _PAIRS, strict=True)]


def choose(mask: np.ndarray, a: Interval, b: Interval) -> Interval:
    """Return a where the mask holds, else b."""
    return Interval(np.where(mask, a.low, b.low), np.where(mask, a.high, b.high))


def free_holds(family: Family, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes their leaf's multipliers exclude, whatever the axis in the leaf's cell.

    Args:
        family: the ratios, one shared denominator.
        leaves: with frame, multipliers and level.
        boxes: to be tested.
    """
    frames = frames_of(family, leaves, boxes)
    ratio, weight = mix_slots(leaves, boxes)
    zero = Interval(np.zeros(len(boxes)))
    total = plain = zero
    for k, w in zip(ratio, weight, strict=True):
        total = total + w
        plain = plain + Interval(w) * family.numerator_isotropic[k]
    level = total * leaves.level[boxes.leaf]
    half2 = boxes.half2 * 0.5
    rest = across = zero
    matrix = [g * (plain - level * family.denominator_isotropic[0]) for g in frames.gram]
    slopes = [[zero] * 6 for _ in range(3)]
    for k, w in zip(ratio, weight, strict=True):
        scale = Interval(w) * family.numerator_weight[k]
        up, _ = add_point(family, frames, boxes, family.numerator_point[k], scale, matrix, slopes)
        # a numerator's remainder is bounded by the identity, anchored or not
        rest = rest + np.where(w > 0.0, (scale * up * half2).high, 0.0)
    for e, j in enumerate(family.denominator_point):
        where = np.full(len(boxes), j)
        scale = level * family.denominator_weight[e]
        _, down = add_point(family, frames, boxes, where, -scale, matrix, slopes)
        used = np.where(scale.high > 0.0, (scale * down * half2).high, 0.0)
        anchored = frames.turning & (where == frames.anchor)
        rest = rest + np.where(anchored, 0.0, used)
        across = across + np.where(anchored, used, 0.0)
    rest = add_sides(leaves, boxes, frames, half2, matrix, slopes, rest)
    rest = add_ball(family, leaves, boxes, frames, matrix, slopes, rest)
    cover = projector(frames)
    matrix = [m + g * rest + q * across for m, g, q in zip(matrix, frames.gram, cover, strict=True)]
    return at_corners(boxes, matrix, slopes)


def add_point(
    family: Family,
    frames: Frames,
    boxes: Boxes,
    point: np.ndarray,
    scale: Interval,
    matrix: list[Interval],
    slopes: list[list[Interval]],
) -> tuple[Interval, Interval]:
    """Add a multiple of one point's form and slopes; return the bounds on its second derivative."""
    form, slope, up, down = expansion(family, frames, boxes, point)
    for m in range(6):
        matrix[m] = matrix[m] + scale * form[m]
        for e in range(3):
            slopes[e][m] = slopes[e][m] + scale * slope[e][m]
    return up, down


def add_sides(
    leaves: Leaves,
    boxes: Boxes,
    frames: Frames,
    half2: Interval,
    matrix: list[Interval],
    slopes: list[list[Interval]],
    rest: Interval,
) -> Interval:
    """Add the sides of the cells, ``(v - low a)(high a - v) >= 0``, with their multipliers."""
    cell, sides = leaves.cell[boxes.leaf], leaves.sides[boxes.leaf]
    for side in range(2):
        weight = np.where(cell[:, 0] >= 0, sides[:, side], 0.0)
        if not np.any(weight > 0.0):
            continue
        a = np.maximum(cell[:, 0], 0)
        v = (a + 1 + side) % 3
        width = np.ldexp(2.0, -cell[:, 1 + 2 * side])
        low = -1.0 + cell[:, 2 + 2 * side] * width
        high = low + width  # exact: dyadic numbers of few bits
        form_low, row = np.zeros((len(boxes), 3, 3)), np.arange(len(boxes))
        form_low[row, v, v] = -1.0
        form_low[row, a, v] = form_low[row, v, a] = 0.5 * (low + high)
        form_high = form_low.copy()
        ends = -(Interval(low) * high)
        form_low[row, a, a], form_high[row, a, a] = ends.low, ends.high
        q = Interval(form_low, form_high)
        form = congruent(frames, q)
        for m in range(6):
            matrix[m] = matrix[m] + form[m] * weight
        if np.any(frames.turning):
            size = (
                Interval(q.low.reshape(-1, 9), q.high.reshape(-1, 9)).squared().total().sqrt()
                * np.sqrt(2.0)
                * (1.0 + 1e-12)
            )
            bend = size / frames.rho_least.squared() * _SWING * weight * half2
            rest = rest + np.where(frames.turning, finite(bend.high), 0.0)
            for e in range(3):
                for m, x in enumerate(congruent(frames, turning_rate(frames, q, e))):
                    slopes[e][m] = slopes[e][m] + x * np.where(frames.turning, weight, 0.0)
    return rest


def congruent(frames: Frames, q: Interval) -> list[Interval]:
    """Return basis^T Q basis as six numbers."""
    columns = [stack([dot(q[:, i, :], frames.basis[:, :, c]) for i in range(3)]) for c in range(3)]
    return [dot(Interval(frames.basis[:, :, i]), columns[j]) for i, j in _PAIRS]


def turning_rate(frames: Frames, q: Interval, e: int) -> Interval:
    """Return the derivative of ``R^T Q R`` along a world axis, (b, 3, 3).

    With ``K = (e d^T - d e^T) / rho`` the frame's transpose changes by K, which keeps d on the anchor; the
    form, by ``K Q + Q K^T``.
    """
    unit = np.zeros(3)
    unit[e] = 1.0
    d = frames.direction
    k = stack(
        [stack([(d[:, j] * unit[i] - d[:, i] * unit[j]) / frames.rho for j in range(3)]) for i in range(3)]
    )
    k = Interval(np.swapaxes(k.low, 1, 2), np.swapaxes(k.high, 1, 2))
    rows = []
    for i in range(3):
        row = []
        for j in range(3):
            one = dot(k[:, i, :], Interval(q.low[:, :, j], q.high[:, :, j]))
            two = dot(q[:, i, :], k[:, j, :])
            row.append(one + two)
        rows.append(stack(row))
    low = np.stack([r.low for r in rows], 1)
    high = np.stack([r.high for r in rows], 1)
    return Interval(low, high)


def add_ball(
    family: Family,
    leaves: Leaves,
    boxes: Boxes,
    frames: Frames,
    matrix: list[Interval],
    slopes: list[list[Interval]],
    rest: Interval,
) -> Interval:
    """Add ``nu (|p - q|^2 - R^2) I``, which is not negative outside a keep-out ball."""
    ball = leaves.ball[boxes.leaf]
    nu = np.where(ball >= 0, leaves.ball_multiplier[boxes.leaf], 0.0)
    if not np.any(nu > 0.0):
        return rest
    n = Interval(boxes.centre) - family.keep_out_points_m[np.maximum(ball, 0)]
    value = (dot(n, n) - Interval(family.keep_out_m).squared()) * nu
    for m in range(6):
        matrix[m] = matrix[m] + frames.gram[m] * value
    for e in range(3):
        for m in range(6):
            slopes[e][m] = slopes[e][m] + frames.gram[m] * (n[:, e] * (2.0 * nu))
    return rest + boxes.half2 * nu


def at_corners(boxes: Boxes, matrix: list[Interval], slopes: list[list[Interval]]) -> np.ndarray:
    """Return which linear matrices are negative definite at all eight corners, and so in the whole box."""
    holds = np.ones(len(boxes), dtype=bool)
    for corner in range(8):
        sign = [1.0 if corner >> i & 1 else -1.0 for i in range(3)]
        here = list(matrix)
        for i in range(3):
            here = [h + s * (sign[i] * boxes.half[:, i]) for h, s in zip(here, slopes[i], strict=True)]
        holds &= negative_definite(here)
    return holds


def negative_definite(a: list[Interval]) -> np.ndarray:
    """Return which forms are negative definite for certain, by the leading minors of their negatives."""
    minor = a[0] * a[1] - a[3].squared()
    det = -(a[2] * minor) + a[0] * a[5].squared() + a[1] * a[4].squared() - a[3] * a[4] * a[5] * 2.0
    return np.asarray((a[0].high < 0.0) & (minor.low > 0.0) & (det.low > 0.0))
