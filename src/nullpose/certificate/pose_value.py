"""The value at a pose in exact arithmetic: rational numbers, and the Taylor series of sine and cosine."""

from __future__ import annotations

from fractions import Fraction
from math import factorial, isqrt
from typing import TypeAlias

from nullpose.family import AxisField, Family

__all__ = ["antenna_axis", "band_excess", "body_axes", "field_offset", "sine_cosine", "smallest_ratio"]

Vector: TypeAlias = list[Fraction]

_TERMS = 24  # of the series: for |x| <= 4 the rest is below 4^48/48! < 1e-32
_BITS = 160


def antenna_axis(attitude_rad: tuple[float, float, float], mount_rad: float = 0.0) -> Vector:
    """Return the antenna's axis ``R (sin m, 0, cos m)``, right to thirty digits; m = 0 is paper eq. 1.1.

    Args:
        attitude_rad: roll, pitch and yaw, radians, each within four.
        mount_rad: ``m``, the angle between the dipole and the body's vertical, likewise.
    """
    sine, cosine = sine_cosine(Fraction(mount_rad))
    forward, up = body_axes(attitude_rad)
    return [x * sine + z * cosine for x, z in zip(forward, up, strict=True)]


def body_axes(attitude_rad: tuple[float, float, float]) -> tuple[Vector, Vector]:
    """Return the body's x and z axes in the world: columns of ``Rz(yaw) Ry(pitch) Rx(roll)``.

    Args:
        attitude_rad: roll, pitch and yaw, radians, each within four.
    """
    (sr, cr), (sp, cp), (sy, cy) = (sine_cosine(Fraction(angle)) for angle in attitude_rad)
    return [cy * cp, sy * cp, -sp], [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr]


def band_excess(band: tuple[float, float], axis: Vector) -> Fraction:
    """Return the sine of the angle by which an axis misses a band, at most zero within it.

    Right to thirty digits.

    Args:
        band: least and greatest ``u_z^2`` of a unit axis.
        axis: of any length but zero.
    """
    upright2 = Fraction(axis[2] ** 2) / sum(x * x for x in axis)
    cosine, sine = square_root(upright2), square_root(1 - upright2)
    most, least = ((square_root(Fraction(end)), square_root(1 - Fraction(end))) for end in (band[1], band[0]))
    # angles from the vertical: nearer than the upper end allows, or farther than the lower one
    return max(cosine * most[1] - sine * most[0], sine * least[0] - cosine * least[1])


def square_root(x: Fraction) -> Fraction:
    """Return the square root of a number from zero to one, to more than thirty digits."""
    return Fraction(isqrt(x.numerator * 4**_BITS // x.denominator), 2**_BITS)


def sine_cosine(x: Fraction) -> tuple[Fraction, Fraction]:
    """Return sine and cosine of an angle within four, to thirty digits."""
    sine = sum((x ** (2 * n + 1) * (-1) ** n / factorial(2 * n + 1) for n in range(_TERMS)), Fraction(0))
    cosine = sum((x ** (2 * n) * (-1) ** n / factorial(2 * n) for n in range(_TERMS)), Fraction(0))
    return rounded(sine), rounded(cosine)


def rounded(x: Fraction) -> Fraction:
    """Return a number to so many bits after the point: keeps the fractions short."""
    return Fraction(round(x * 2**_BITS), 2**_BITS)


def link(point: Vector, position: Vector, axis: Vector) -> Fraction:
    """Return ``sin^2(gamma) / |r|^2`` of a link (paper eqs. 1.2 to 1.4), exactly."""
    r = [q - p for q, p in zip(point, position, strict=True)]
    cross = [r[(i + 1) % 3] * axis[(i + 2) % 3] - r[(i + 2) % 3] * axis[(i + 1) % 3] for i in range(3)]
    r2, u2 = sum(x * x for x in r), sum(x * x for x in axis)
    return Fraction(sum(x * x for x in cross)) / (u2 * r2 * r2)


def smallest_ratio(family: Family, position: Vector, axis: Vector) -> Fraction:
    """Return the smallest ratio at a pose (of paper eq. 2.1, say), exactly for the numbers given.

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


def field_offset(axis_field: AxisField, position: Vector, axis: Vector) -> Fraction:
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
