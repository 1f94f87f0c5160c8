"""The value at a pose in exact arithmetic: rational numbers, and the Taylor series of sine and cosine."""

from __future__ import annotations

from fractions import Fraction
from math import isqrt
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.certificate.elementary import exp, log
from nullpose.certificate.interval import Interval
from nullpose.objectives.ratios import Ratios
from nullpose.problem.axis_field import AxisField

if TYPE_CHECKING:
    from nullpose.certificate.profile import Profile

# An array of fractions.
Exact: TypeAlias = NDArray[np.object_]

_TERMS = 24  # of the series: for |x| <= 4 the rest is below 4^48/48! < 1e-32
_BITS = 160


def exact(numbers: ArrayLike) -> Exact:
    """Return floating-point numbers as fractions, in an array of the same shape.

    Args:
        numbers: of any shape.
    """
    plain = np.asarray(numbers, dtype=float)
    return np.array([Fraction(x) for x in plain.ravel().tolist()], dtype=object).reshape(plain.shape)


def antenna_axis(attitude_rad: tuple[float, float, float], mount_rad: float = 0.0) -> Exact:
    """Return the antenna's axis ``R (sin m, 0, cos m)``, right to thirty digits; m = 0 is paper eq. 1.1.

    Args:
        attitude_rad: roll, pitch and yaw, radians, each within four.
        mount_rad: ``m``, the angle between the dipole and the body's vertical, likewise.
    """
    sine, cosine = sine_cosine(Fraction(mount_rad))
    forward, up = body_axes(attitude_rad)
    return np.asarray(forward * sine + up * cosine)


def body_axes(attitude_rad: tuple[float, float, float]) -> tuple[Exact, Exact]:
    """Return the body's x and z axes in the world: columns of ``Rz(yaw) Ry(pitch) Rx(roll)``.

    Args:
        attitude_rad: roll, pitch and yaw, radians, each within four.
    """
    (sr, cr), (sp, cp), (sy, cy) = (sine_cosine(Fraction(angle)) for angle in attitude_rad)
    forward, up = [cy * cp, sy * cp, -sp], [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr]
    return np.array(forward), np.array(up)


def band_excess(band: tuple[float, float], axis: Exact) -> Fraction:
    """Return the sine of the angle by which an axis misses a band, at most zero within it.

    Right to thirty digits.

    Args:
        band: least and greatest ``u_z^2`` of a unit axis.
        axis: of any length but zero.
    """
    (cosine, sine), least, most = (
        (square_root(x), square_root(1 - x))
        for x in (axis[2] ** 2 / (axis @ axis), Fraction(band[0]), Fraction(band[1]))
    )
    # angles from the vertical: nearer than the upper end allows, or farther than the lower one
    return max(cosine * most[1] - sine * most[0], sine * least[0] - cosine * least[1])


def square_root(x: Fraction) -> Fraction:
    """Return the square root of a number from zero to one, to more than thirty digits."""
    return Fraction(isqrt(x.numerator * 4**_BITS // x.denominator), 2**_BITS)


def sine_cosine(x: Fraction) -> tuple[Fraction, Fraction]:
    """Return sine and cosine of an angle within four, to thirty digits."""
    unit = 2**_BITS
    angle, power, sums = round(x * unit), unit, [0, 0]
    for n in range(2 * _TERMS):  # in units of 2^-bits, each term off by a few of them
        sums[n % 2] += power * (-1) ** (n // 2)
        power = power * angle // (unit * (n + 1))
    return Fraction(sums[1], unit), Fraction(sums[0], unit)


def sine2(x: Exact, y: Exact) -> Fraction:
    """Return the squared sine of the angle between two vectors, exactly."""
    cross = np.cross(x, y)
    return Fraction(cross @ cross, (x @ x) * (y @ y))


def profile_link(point: Exact, position: Exact, axis: Exact, profile: Profile) -> Fraction:
    """Return a link's gain over ``|r|^2`` for an antenna that is the same all round, to thirty digits.

    Args:
        point: on the ground, metres.
        position: where the antenna is.
        axis: its axis, of any length.
        profile: its gain.
    """
    r = point - position
    along, square, length2 = (Fraction(a @ b) for a, b in ((axis, r), (r, r), (axis, axis)))
    cosine = square_root(along**2 / (square * length2))
    return profile.exact(cosine if along >= 0 else -cosine) / square


def link(
    point: Exact,
    position: Exact,
    axis: Exact,
    leak: Fraction,
    dipole: Exact | None = None,
    through: Fraction = Fraction(0),
) -> Fraction:
    """Return a link's gain over ``|r|^2``, exactly; without a leak and a dipole, paper eqs. 1.2 to 1.4.

    With a dipole along v, ``(1 - l) B^2 / (|u|^2 |r|^6) + l |r x v|^2 / |r|^4``, ``B = (u x r).(v x r)``; if
    it leaks itself, ``1 - through`` times that and ``through`` times the first.
    """
    r = point - position
    isotropic = (leak + (1 - leak) * sine2(r, axis)) / Fraction(r @ r)
    if dipole is not None and np.any(dipole != 0):
        across, square = np.cross(dipole, r), r @ r
        kept = (1 - leak) * (np.cross(axis, r) @ across) ** 2 / (axis @ axis)
        of_dipole = Fraction((kept / square + leak * (across @ across)) / square**2)
        return (1 - through) * of_dipole + through * isotropic
    return isotropic


def ratios_at(
    ratios: Ratios,
    position: Exact,
    axis: Exact,
    profile: Profile | None = None,
    *,
    gains: Interval | None = None,
) -> Exact:
    """Return the ratios at a pose (paper eq. 2.1, say), exactly for the numbers given, (ratios,).

    With channels lower bounds of them, as near as their excess gains are enclosed.

    Args:
        ratios: over the points.
        position: where, metres.
        axis: the antenna's axis, of any length.
        profile: its gain, if it is no dipole.
        gains: (m,) excess gains of all points there; None in free space.
    """
    assert (gains is None) == (len(ratios.channels) == 0)
    leak = Fraction(ratios.leak)
    none = np.zeros_like(ratios.points_m), np.ones(len(ratios.points_m))
    dipoles = (ratios.ground_axes, ratios.ground_leaks) if len(ratios.ground_axes) else none
    rows = zip(*map(exact, (ratios.points_m, *dipoles)), strict=True)
    links = np.array(
        [
            link(point, position, axis, leak, dipole, through)
            if profile is None
            else profile_link(point, position, axis, profile)
            for point, dipole, through in rows
        ]
    )
    low, high = (1, 1) if gains is None else (exact(gains.low), exact(gains.high))
    entries = exact(ratios.denominator_weight) * (links * high)[ratios.denominator_point]
    starts, isotropic = ratios.denominator_start, exact(ratios.denominator_isotropic)
    denominators = np.array(
        [sum(entries[a:b], below) for a, b, below in zip(starts, starts[1:], isotropic, strict=False)]
    )
    above = exact(ratios.numerator_weight) * (links * low)[ratios.numerator_point]
    return np.asarray((exact(ratios.numerator_isotropic) + above) / denominators[ratios.denominator_of])


def value_of(ratios: Ratios, values: Exact) -> Fraction:
    """Evaluate the objective from the ratios at a pose: the smallest, of pairs too, or less than the mean.

    The bound is as near as logarithms are.
    """
    if len(ratios.pairs):
        return Fraction(min(values[node] / values[eavesdropper] for node, eavesdropper in ratios.pairs))
    if not len(ratios.shares):
        return Fraction(min(values))
    rounded = Interval(1.0 - 1e-15, 1.0 + 1e-15)  # a double is off by less than its last two places
    logs = (log(rounded * float(value + Fraction(ratios.offset))) for value in values)
    power = sum((each * share for each, share in zip(logs, ratios.shares, strict=True)), Interval(0.0))
    return Fraction(float(exp(power).low))


def field_offset(axis_field: AxisField, position: Exact, axis: Exact) -> Fraction:
    """Return the squared sine of the angle between an axis and the one that a field has at a position.

    Where the field vanishes, in line with both nodes, every axis across that line is a limit of its own.

    Args:
        axis_field: an affine field.
        position: where, metres.
        axis: the axis, of any length but zero.
    """
    matrix = exact(axis_field.matrix)
    if np.any((wanted := exact(axis_field.offset) + matrix @ position) != 0):
        return sine2(wanted, axis)
    rotated = matrix @ axis
    # u -> w x u: |w x u|^2 = |w|^2 |u|^2 for u across w, and half the squares of the matrix sum to |w|^2
    whole = np.sum(matrix * matrix) / 2
    return abs(1 - Fraction(rotated @ rotated, whole * (axis @ axis)))
