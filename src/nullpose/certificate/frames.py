"""Forms of points seen from a box, in a frame that stands still or turns towards a point.

The same lemmas as the solver's (see "The certificate explained"), written down again: in world coordinates,
turned into a convenient basis by a congruence, which changes no sign, and in interval arithmetic.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, FloatArray, Leaves
from nullpose.certificate.interval import Interval, dot, stack
from nullpose.family import Family

__all__ = [
    "PAIRS",
    "SWING",
    "Frames",
    "congruent",
    "expansion",
    "finite",
    "frames_of",
    "projector",
    "turning_rate",
]

PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""Rows and columns of a symmetric matrix's six numbers."""

SWING = (1.0 + np.sqrt(2.0)) * (1.0 + 1e-12)
"""Second derivative of a constant form in a turning frame, times rho^2 over its spread, rounded up."""

_AREA = 4.0 / np.sqrt(3.0) * (1.0 + 1e-12)  # twice the largest |b''| of the turning, 2 / sqrt(3), rounded up


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """Where each box's forms are looked at from.

    Args:
        turning: (b,) whether the frame turns towards a point.
        anchor: (b,) that point.
        direction: (b, 3) the unit vector to it, zero where the frame stands still.
        rho: (b,) its distance from the centre, and from the box at least.
        rho_least: (b,) the latter.
        basis: (b, 3, 3) columns: the coordinates that definiteness is asked in. In a turning frame the third
            is the direction itself, and not a rounded one: the anchor's form then has no third row, however
            strong the anchor is.
        gram: basis^T basis, as six numbers.
    """

    turning: np.ndarray
    anchor: np.ndarray
    direction: Interval
    rho: Interval
    rho_least: Interval
    basis: Interval
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
    axes = Interval(basis.copy(), basis.copy())
    axes.low[turning, :, 2], axes.high[turning, :, 2] = direction.low[turning], direction.high[turning]
    one = Interval(np.ones(len(boxes)))
    gram = [dot(axes[:, :, i], axes[:, :, j]) if (i, j) != (2, 2) else one for i, j in PAIRS]
    least = Interval(boxes.nearest2(family.points_m[anchor])).sqrt()
    return Frames(turning, anchor, direction, rho, Interval(least.low), axes, gram)


def turned(frames: Frames, vector: Interval) -> list[Interval]:
    """Return basis^T v as three numbers."""
    return [dot(frames.basis[:, :, i], vector) for i in range(3)]


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
    form = [(g * s - here[i] * here[j]) / s.squared() for g, (i, j) in zip(frames.gram, PAIRS, strict=True)]
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
        for g, (i, j) in zip(frames.gram, PAIRS, strict=True):
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
    """Return I - d d^T in the basis, as six numbers: in a turning frame the third row is zero."""
    d = turned(frames, frames.direction)
    plain = [g - d[i] * d[j] for g, (i, j) in zip(frames.gram, PAIRS, strict=True)]
    zero = Interval(np.zeros(len(frames.turning)))
    return [choose(frames.turning & (j == 2), zero, p) for p, (_, j) in zip(plain, PAIRS, strict=True)]


def choose(mask: np.ndarray, a: Interval, b: Interval) -> Interval:
    """Return a where the mask holds, else b."""
    return Interval(np.where(mask, a.low, b.low), np.where(mask, a.high, b.high))


def congruent(frames: Frames, q: Interval) -> list[Interval]:
    """Return basis^T Q basis as six numbers."""
    columns = [stack([dot(q[:, i, :], frames.basis[:, :, c]) for i in range(3)]) for c in range(3)]
    return [dot(frames.basis[:, :, i], columns[j]) for i, j in PAIRS]


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
