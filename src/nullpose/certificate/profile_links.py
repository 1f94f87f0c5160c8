"""Links of an antenna that is the same all round, over cells of positions and axes, with two derivatives."""

from __future__ import annotations

from math import factorial
from typing import TypeAlias

import numpy as np

from nullpose.certificate.interval import Interval, where
from nullpose.certificate.jets import PAIRS, Jet, flat
from nullpose.physics.types import FloatArray

PI = Interval(np.pi, np.nextafter(np.pi, 4.0))
_TERMS, _REST = 9, 3e-18  # of the series: (pi / 4)^18 / 18! is less
_SQUARES = [n for n, (i, j) in enumerate(PAIRS) if i == j]

Link: TypeAlias = tuple[Jet, Jet]
"""The cosine between the antenna's axis and the direction to a point, and one over the squared distance."""


def links_of(
    apart: Interval, anchor: int, offset: Interval, turns: list[tuple[Interval, Interval]]
) -> list[Link]:
    """Evaluate, for each point, the cosine to the antenna's axis, and one over the squared distance.

    Args:
        apart: (m, 3) from the anchor to each point, in the chart's order.
        anchor: which point that is.
        offset: (3, b) from the positions to the anchor.
        turns: sine and cosine of the angle, then of the spin.
    """
    (su, cu), (ss, cs) = turns
    angle = flat(su, {3: cu}, {_SQUARES[3]: -su})
    along = flat(cu, {3: -su}, {_SQUARES[3]: -cu})
    spin = flat(ss, {4: cs}, {_SQUARES[4]: -ss})
    across = angle * flat(cs, {4: -ss}, {_SQUARES[4]: -cs})
    upwards = angle * spin
    level2 = _square(offset, (0, 2))
    level, length = level2.inverse_root(), _square(offset, (0, 1, 2)).inverse_root()
    both = level * length
    found = []
    for j, d in enumerate(apart[j] for j in range(len(apart.low))):
        near = _square(offset + d[:, None], (0, 1, 2)).inverse_root()
        if j == anchor:
            found.append((along, near * near))
            continue
        level_offset = flat(offset[0] * d[0] + offset[2] * d[2], {0: -d[0], 2: -d[2]}, {})
        whole = flat(offset[1] * d[1], {1: -d[1]}, {}) + level_offset + _square(offset, (0, 1, 2))
        level_part = flat(offset[2] * d[0] - offset[0] * d[2], {2: -d[0], 0: d[2]}, {}) * level
        height = flat(offset[1], {1: Interval(-1.0)}, {})
        steep_part = (level2.times(d[1]) - height * level_offset) * both
        cosine = (along * (whole * length) + upwards * steep_part - across * level_part) * near
        found.append((cosine, near * near))
    return found


def _square(offset: Interval, sides: tuple[int, ...]) -> Jet:
    """Sum the squares of some coordinates of an offset, (3, b), which positions shorten."""
    return flat(
        Interval(*(end[list(sides)] for end in offset.ends)).squared().total(),
        {i: offset[i] * -2.0 for i in sides},
        {_SQUARES[i]: Interval(2.0) for i in sides},
    )


def sine_cosine(x: FloatArray) -> tuple[Interval, Interval]:
    """Enclose sine and cosine of multiples of pi, (b,), by their Taylor series within an eighth of a turn.

    Args:
        x: (b,) exact, from -1 to 1.
    """
    quarter = np.rint(2.0 * x)
    angle = PI * (x - 0.5 * quarter)
    square = angle.squared()
    sine, cosine = Interval(np.zeros(len(x))), Interval(np.zeros(len(x)))
    for n in reversed(range(_TERMS)):
        sine = Interval((-1.0) ** n) / factorial(2 * n + 1) + sine * square
        cosine = Interval((-1.0) ** n) / factorial(2 * n) + cosine * square
    rest = Interval(-_REST, _REST)
    sine, cosine = sine * angle + rest, cosine + rest
    turn = quarter.astype(np.int64) % 4
    swap, first, second = turn % 2 == 1, np.where(turn >= 2, -1.0, 1.0), np.where(turn % 3 > 0, -1.0, 1.0)
    return where(swap, cosine, sine) * first, where(swap, sine, cosine) * second


def about(turn: tuple[Interval, Interval], half: FloatArray) -> tuple[Interval, Interval]:
    """Enclose sine and cosine within so many radians of an angle, (b,)."""
    sine, cosine = turn
    shrunk = Interval(np.maximum((1.0 - Interval(half).squared() * 0.5).low, -1.0), np.ones(len(half)))
    step = Interval(-half, half)
    both = sine * shrunk + cosine * step, cosine * shrunk + sine * step
    wide = [Interval(np.maximum(x.low, -1.0), np.minimum(x.high, 1.0)) for x in both]
    return wide[0], wide[1]
