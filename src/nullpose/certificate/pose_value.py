"""The value at a pose in exact arithmetic: rational numbers, and the Taylor series of sine and cosine."""

from __future__ import annotations

from fractions import Fraction
from math import factorial

from nullpose.certificate.certificate import Certificate
from nullpose.family import AxisField, Family

__all__ = ["antenna_axis", "field_offset", "smallest_ratio"]

_TERMS = 24  # of the series: for |x| <= 4 the rest is below 4^48/48! < 1e-32
_BITS = 160


def antenna_axis(certificate: Certificate) -> list[Fraction]:
    """Return the antenna's axis from roll, pitch and yaw (paper eq. 1.1), right to thirty digits.

    Args:
        certificate: its attitude, radians, each within four.
    """
    (sr, cr), (sp, cp), (sy, cy) = (
        sine_cosine(Fraction(angle))
        for angle in (certificate.roll_rad, certificate.pitch_rad, certificate.yaw_rad)
    )
    # the third column of Rz(yaw) Ry(pitch) Rx(roll)
    return [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr]


def sine_cosine(x: Fraction) -> tuple[Fraction, Fraction]:
    """Return sine and cosine of an angle within four, to thirty digits."""
    sine = sum((x ** (2 * n + 1) * (-1) ** n / factorial(2 * n + 1) for n in range(_TERMS)), Fraction(0))
    cosine = sum((x ** (2 * n) * (-1) ** n / factorial(2 * n) for n in range(_TERMS)), Fraction(0))
    return rounded(sine), rounded(cosine)


def rounded(x: Fraction) -> Fraction:
    """Return a number to so many bits after the point: keeps the fractions short."""
    return Fraction(round(x * 2**_BITS), 2**_BITS)


def link(point: list[Fraction], position: list[Fraction], axis: list[Fraction]) -> Fraction:
    """Return ``sin^2(gamma) / |r|^2`` of a link (paper eqs. 1.2 to 1.4), exactly."""
    r = [q - p for q, p in zip(point, position, strict=True)]
    cross = [r[(i + 1) % 3] * axis[(i + 2) % 3] - r[(i + 2) % 3] * axis[(i + 1) % 3] for i in range(3)]
    r2, u2 = sum(x * x for x in r), sum(x * x for x in axis)
    return Fraction(sum(x * x for x in cross)) / (u2 * r2 * r2)


def smallest_ratio(family: Family, position: list[Fraction], axis: list[Fraction]) -> Fraction:
    """Return the smallest ratio at a pose (paper eq. 2.1), exactly for the numbers given.

    Args:
        family: the ratios.
        position: where, metres.
        axis: the antenna's axis, of any length.
    """
    links = [link([Fraction(float(x)) for x in point], position, axis) for point in family.points_m]
    denominators = []
    for g, isotropic in enumerate(family.denominator_isotropic):
        entries = range(family.denominator_start[g], family.denominator_start[g + 1])
        sums = (
            Fraction(float(family.denominator_weight[e])) * links[family.denominator_point[e]]
            for e in entries
        )
        denominators.append(Fraction(float(isotropic)) + sum(sums, Fraction(0)))
    ratios: list[Fraction] = [
        (
            Fraction(float(family.numerator_isotropic[k]))
            + Fraction(float(family.numerator_weight[k])) * links[a]
        )
        / denominators[family.denominator_of[k]]
        for k, a in enumerate(family.numerator_point)
    ]
    return min(ratios)


def field_offset(axis_field: AxisField, position: list[Fraction], axis: list[Fraction]) -> Fraction:
    """Return the squared sine of the angle between an axis and the one that a field has at a position.

    Where the field vanishes, in line with both nodes, every axis across that line is a limit of its own.

    Args:
        axis_field: an affine field.
        position: where, metres.
        axis: the axis, of any length but zero.
    """
    matrix = [[Fraction(float(x)) for x in row] for row in axis_field.matrix]
    wanted = [
        Fraction(float(axis_field.offset[m])) + sum(x * p for x, p in zip(matrix[m], position, strict=True))
        for m in range(3)
    ]
    length2, size2 = sum(x * x for x in axis), sum(x * x for x in wanted)
    if size2:
        cross = [
            wanted[(i + 1) % 3] * axis[(i + 2) % 3] - wanted[(i + 2) % 3] * axis[(i + 1) % 3]
            for i in range(3)
        ]
        return Fraction(sum(x * x for x in cross)) / (size2 * length2)
    turned = [sum(x * u for x, u in zip(row, axis, strict=True)) for row in matrix]
    # u -> w x u: |w x u|^2 = |w|^2 |u|^2 for u across w, and half the squares of the matrix sum to |w|^2
    whole = Fraction(sum(x * x for row in matrix for x in row)) / 2
    return abs(1 - Fraction(sum(x * x for x in turned)) / (whole * length2))
