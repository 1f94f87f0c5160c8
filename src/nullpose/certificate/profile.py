"""The gain of an antenna that is the same all round: a polynomial of the cosine to its axis, with bounds."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from nullpose.antenna import PatternAntenna
from nullpose.certificate.interval import Interval
from nullpose.certificate.pose_value import exact, sine_cosine
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.scenario import Scenario

_CELLS = 4096  # of the cosine: a power of two, so that ends and middles are exact
_ORDER = 7  # of the Taylor series in each, whose remainder is bounded by the next derivative
_BITS = 256  # of whole numbers in place of real ones
_PAD = 1e-50  # more than what so many bits leave out


class Profile:
    """A polynomial of the cosine c to the antenna's axis, |c| <= 1.

    Args:
        weights: (d + 1,) of the Legendre polynomials. They are taken as exact.
    """

    def __init__(self, weights: FloatArray) -> None:
        self.powers = _powers(weights)
        unit = 1 << _BITS
        at = np.array([(2 * i + 1 - _CELLS) * unit // _CELLS for i in range(_CELLS)], dtype=object)
        self.middles: FloatArray = (2.0 * np.arange(_CELLS) + 1.0) / _CELLS - 1.0
        self.terms = [_values(self.powers, order, at) for order in range(_ORDER + 1)]  # over the factorials
        rest = _most(weights, _ORDER + 1) / math.factorial(_ORDER + 1)
        self.rest = float(np.nextafter(float(rest), np.inf))
        whole = Interval(np.full(_CELLS, -1.0 / _CELLS), np.full(_CELLS, 1.0 / _CELLS))
        self.spans = [self._series(order, np.arange(_CELLS), whole) for order in range(3)]
        self.peak = float(self.within(0, Interval([-1.0], [1.0])).high[0])

    def exact(self, cosine: Fraction) -> Fraction:
        """Return the gain at a cosine, which is zero where the polynomial is negative."""
        return max(Fraction(0), sum((a * cosine**n for n, a in enumerate(self.powers)), Fraction(0)))

    def near(self, order: int, cosine: Interval) -> Interval:
        """Return a derivative's values at cosines that are all but known, (b,).

        Args:
            order: of the derivative, 0 to 2.
            cosine: (b,), of which what is beyond -1 and 1 does not count.
        """
        cosine = Interval(np.clip(cosine.low, -1.0, 1.0), np.clip(cosine.high, -1.0, 1.0))
        middle = np.nan_to_num(cosine.middle())
        cell = np.clip(((middle + 1.0) * (0.5 * _CELLS)).astype(np.int64), 0, _CELLS - 1)
        return self._series(order, cell, cosine - self.middles[cell])

    def within(self, order: int, cosine: Interval) -> Interval:
        """Return bounds of a derivative over ranges of cosines, (b,).

        Args:
            order: of the derivative, 0 to 2.
            cosine: (b,), of which what is beyond -1 and 1 does not count.
        """
        low, high = (
            np.clip(np.where(np.isnan(end), side, end), -1.0, 1.0)
            for end, side in zip((cosine.low, cosine.high), (-1.0, 1.0), strict=True)
        )
        first, last = (
            np.clip(np.floor((end + 1.0) * (0.5 * _CELLS) + slack).astype(np.int64), 0, _CELLS - 1)
            for end, slack in ((low, -1e-9), (high, 1e-9))
        )
        # from the first cell to the one behind the last: every other of the ranges that these numbers begin
        begins = np.stack([first, np.maximum(first, last) + 1], axis=-1).ravel()
        least, most = (np.append(end, 0.0) for end in self.spans[order].ends)
        return Interval(np.minimum.reduceat(least, begins)[::2], np.maximum.reduceat(most, begins)[::2])

    def _series(self, order: int, cell: IntArray, step: Interval) -> Interval:
        """Return a derivative a step away from the middles of cells, by Taylor's formula."""
        beyond = Interval(step.magnitude())
        rest = Interval(self.rest) * float(math.perm(_ORDER + 1, order))
        for _ in range(_ORDER + 1 - order):
            rest = rest * beyond
        total = Interval(-rest.high, rest.high)
        power = Interval(np.ones(len(cell)))
        for n in range(order, _ORDER + 1):
            total = total + self.terms[n][cell] * power * float(math.perm(n, order))
            power = power * step
        return total


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ProfileField(AxisField):
    """Every axis of an antenna that is the same all round, as far as the airframe reaches.

    Args:
        profile: its gain.
        ends: sine and cosine of the least and of the largest angle between vertical and axis.
        spans: least and largest angle of an axis and of the spin, in multiples of pi, a hair wide: from a
            point, and from the zenith; (2, 2, 2).
        even: whether opposite directions have the same gain.
    """

    profile: Profile
    ends: Sequence[Sequence[float]]
    spans: FloatArray
    even: bool

    @classmethod
    def of(cls, antenna: PatternAntenna, scenario: Scenario) -> ProfileField:
        """Build the field of an antenna on a scenario's airframe.

        Raises:
            ValueError: the gain changes round the axis.
        """
        if not antenna.is_axisymmetric:
            raise ValueError(f"{antenna.label}: its gain changes round its axis")
        airframe, even = scenario.airframe, antenna.harmonics.is_even
        mount, tilt = (0.0, math.pi) if airframe is None else (airframe.mount_rad, airframe.tilt_max_rad)
        reach = max(mount - tilt, 0.0), min(mount + tilt, math.pi)
        ends = [tuple(map(float, sine_cosine(Fraction(angle)))) for angle in reach]
        wide = [reach[0] / math.pi * (1.0 - 1e-15), min(reach[1] / math.pi * (1.0 + 1e-15), 1.0)]
        return cls(
            is_free=True,
            offset=np.zeros(3),
            matrix=np.zeros((3, 3)),
            profile=_profile(antenna.harmonics.cosine[:, 0].tobytes()),
            ends=ends,
            spans=np.array([[[0.0, 0.5 if even else 1.0], [-1.0, 1.0]], [wide, [-1.0, 1.0]]]),
            even=even,
        )


def profiles_of(fields: Mapping[str, AxisField]) -> list[Profile]:
    """Return the gain of an antenna that is no dipole, alone in a list, or none.

    Args:
        fields: the axis fields of a scheme.
    """
    return [field.profile for field in fields.values() if isinstance(field, ProfileField)]


def loudest(family: Family, field: AxisField) -> Family:
    """Return a family in which no gain is above 1, as those of dipoles are.

    Args:
        family: the ratios.
        field: the axes; with a profile numerators get its largest gain.
    """
    if not isinstance(field, ProfileField):
        return family
    return family.changed(
        numerator_weight=np.nextafter(family.ratios.numerator_weight * field.profile.peak, np.inf)
    )


@lru_cache(maxsize=8)
def _profile(terms: bytes) -> Profile:
    cosine = np.frombuffer(terms)
    return Profile(cosine * np.sqrt(2.0 * np.arange(len(cosine)) + 1.0))


def _powers(weights: FloatArray) -> list[Fraction]:
    """Sum Legendre polynomials with weights: the coefficients of the powers of c, exactly."""
    return list(legendre.leg2poly(exact(weights)))


def _values(powers: list[Fraction], order: int, at: np.ndarray) -> Interval:
    """Return a derivative over the factorial of its order, (cells,), at whole numbers of 2^-bits."""
    total = at * 0
    for n in range(len(powers) - 1, order - 1, -1):
        term = powers[n] * math.comb(n, order)
        total = (total * at >> _BITS) + (term.numerator << _BITS) // term.denominator
    return Interval((total / (1 << _BITS)).astype(float)) + Interval(-_PAD, _PAD)


def _most(weights: FloatArray, order: int) -> Fraction:
    """Bound a derivative's magnitude: those of Legendre polynomials are largest at 1."""
    return sum((a * math.perm(n, order) for n, a in enumerate(_powers(np.abs(weights)))), Fraction(0))
