"""Links of an antenna that is the same all round, over cells of positions and axes, as Taylor numbers."""

from __future__ import annotations

from math import factorial
from typing import TypeAlias

import numpy as np

from nullpose.certificate.interval import Interval, common, stack, where
from nullpose.certificate.taylor import Taylor, coordinates, inverse, joined, root
from nullpose.physics.types import FloatArray

PI = Interval(np.pi, np.nextafter(np.pi, 4.0))
_TERMS, _REST = 9, 3e-18  # of the series: (pi / 4)^18 / 18! is less

Link: TypeAlias = tuple[Taylor, Taylor]
"""The cosine between the antenna's axis and the direction to a point, and one over the squared distance."""


def links_of(
    apart: Interval,
    anchor: int,
    offset: Interval,
    turns: list[tuple[Interval, Interval]],
    half: FloatArray,
) -> tuple[list[Link], list[Taylor]]:
    """Evaluate, for each point, the cosine to the antenna's axis, and one over the squared distance.

    And the axis, a unit vector in the chart's order.

    Args:
        apart: (m, 3) from the anchor to each point, or from the first one, in the chart's order.
        anchor: which point that is, or -1 for the zenith, whose chart is 0: u is then from the vertical.
        offset: (3, b) from the positions to the anchor or the first point, at the centres.
        turns: sine and cosine of the angle, then of the spin, at the centres.
        half: (5, b) the cells' half sides.
    """
    centre = stack([*(-offset[i] for i in range(3)), *(Interval(np.zeros(half.shape[1])),) * 2])
    cell = coordinates(centre, centre + Interval(-half, half))
    (su, cu), (ss, cs) = (_sine_cosine_over(cell[i], turns[i - 3], half[i]) for i in (3, 4))
    r, across, upwards = -cell[:3], su * cs, su * ss
    x, y, z = r[0], r[1], r[2]
    f = x.squared() + z.squared()
    level, length = (square.of(root).of(inverse) for square in (f, r.squared().total()))

    def along(w: Taylor | FloatArray, d: Interval | FloatArray) -> Taylor:
        """Multiply the axis by a vector w; d is w, or w less r, which the terms across r do not see."""
        if anchor < 0:
            return cu * w[2] + upwards * w[1] - across * w[0]
        ahead = cu * ((r * w).total() * length)
        ahead = ahead + upwards * ((f * d[1] - y * (x * d[0] + z * d[2])) * (level * length))
        return ahead - across * ((z * d[0] - x * d[2]) * level)

    found = []
    for j, d in enumerate(apart[j] for j in range(len(apart.low))):
        w = r + d[:, None]
        inverse1 = w.squared().total().of(root).of(inverse)
        found.append((cu if j == anchor else along(w, d) * inverse1, inverse1.squared()))
    return found, [along(e[:, None], e[:, None]) for e in np.eye(3)]


def _sine_cosine_over(
    angle: Taylor, turn: tuple[Interval, Interval], half: FloatArray
) -> tuple[Taylor, Taylor]:
    """Return sine and cosine of an angle over cells, from those at the centres; no slope is above 1."""
    s, c = (joined(at, common(at + Interval(-half, half), Interval(-1.0, 1.0))) for at in turn)
    return angle.composed(s, c, -s), angle.composed(c, -s, -c)


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
