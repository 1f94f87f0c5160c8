"""Antennas whose gain is any function of the direction, as a sum of spherical harmonics."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike

from nullpose.antenna.caps import PatternArrays, pattern_arrays
from nullpose.antenna.harmonics import (
    HIGHEST_DEGREE,
    FloatArray,
    Harmonics,
    directions,
    fit,
    supported_degree,
)
from nullpose.antenna.table import PatternTable

_TINY = 1e-7  # of the largest gain
_LOW = 0.005  # of all directions, weighted by the grid's density
_LEFT_OUT = 3e-4  # root mean square of the terms that are left out, of the largest gain
_GRID = np.radians(np.arange(181.0)), np.radians(np.arange(360.0))  # where the largest gain is looked for
_STEP_DEG = 0.25  # of the grid where the least gain is looked for, then about its lowest minima
_MINIMA = 64


@dataclass(frozen=True)
class PatternAntenna:
    """An antenna whose gain over the sphere is a sum of spherical harmonics, and 0 where that is negative.

    Args:
        name: as in a scenario file.
        label: in sentences and tables.
        harmonics: of its power gain in its own axes, x forward, y left, z up.
    """

    name: str
    label: str
    harmonics: Harmonics

    is_quadratic: ClassVar[Literal[False]] = False
    has_polarisation: ClassVar[bool] = False
    leak: ClassVar[float] = 0.0

    @property
    def is_axisymmetric(self) -> bool:
        """Whether the gain is the same all round the z axis."""
        return self.harmonics.is_axisymmetric

    @property
    def is_even(self) -> bool:
        """Whether opposite directions have the same gain, so that the axis has no sign."""
        return self.harmonics.is_even

    @property
    def mean(self) -> float:
        """Mean gain over the sphere."""
        return float(self.harmonics.cosine[0, 0])

    def gain(self, directions: ArrayLike) -> FloatArray:
        """Return the power gain in each direction, (...).

        Args:
            directions: (..., 3) unit vectors in the antenna's axes.
        """
        return np.asarray(np.maximum(0.0, self.harmonics.gain(directions)))

    @cached_property
    def peak(self) -> float:
        """A gain that no direction exceeds.

        At the peak the slope is zero, and by Bernstein no second derivative is above ``degree^2`` times it.
        """
        bend = 0.5 * (self.harmonics.degree * math.radians(math.hypot(0.5, 0.5))) ** 2
        return float(np.max(np.abs(self.harmonics.on_grid(*_GRID)))) / (1.0 - bend)

    @cached_property
    def lowest(self) -> FloatArray:
        """Directions of the lowest gain, (n, 3): the lowest half per cent of a grid's."""
        gains = self.harmonics.on_grid(*_GRID)
        return directions(*map(np.degrees, _GRID))[gains <= np.quantile(gains, _LOW)]

    @property
    def arrays(self) -> PatternArrays:
        """The pattern as the solver takes it, made once for the same harmonics."""
        return pattern_arrays(self.harmonics)


def harmonics_of_rows(rows: Sequence[Sequence[float]]) -> Harmonics:
    """Return the harmonics that :meth:`Harmonics.rows` writes.

    Args:
        rows: for each degree n, 2 n + 1 numbers.

    """
    cosine, sine = np.zeros((2, len(rows), len(rows)))
    for n, row in enumerate(rows):
        cosine[n, : n + 1], sine[n, 1 : n + 1] = row[: n + 1], row[n + 1 :]
    return Harmonics(cosine, sine)


def profile_harmonics(angle_deg: FloatArray, gain: FloatArray) -> Harmonics:
    """Return the harmonics of an antenna that is the same all round, from its gain over the angle.

    Args:
        angle_deg: (n,) angles from the axis, rising from 0 to 180.
        gain: (n,) power gain there, linear; it changes linearly between.
    """
    whole = axial_harmonics(lambda c: np.interp(np.degrees(np.arccos(c)), angle_deg, gain), HIGHEST_DEGREE)
    return _shortened(whole, float(np.min(gain)), float(np.max(gain)))


def table_harmonics(table: PatternTable) -> Harmonics:
    """Return the harmonics of a table, of the lowest degree that leaves out next to nothing.

    Args:
        table: over the whole sphere.
    """
    return _shortened(
        fit(table, supported_degree(table)), float(np.min(table.gain)), float(np.max(table.gain))
    )


def deepest_null(harmonics: Harmonics) -> tuple[float, float, float]:
    """Return the least gain of a pattern, with its polar angle and azimuth, radians.

    Args:
        harmonics: of any pattern.
    """
    from scipy.ndimage import minimum_filter

    grid = np.arange(0.0, 180.0 + _STEP_DEG, _STEP_DEG), np.arange(0.0, 360.0, _STEP_DEG)
    gains = harmonics.on_grid(*map(np.radians, grid))
    rows, columns = np.nonzero(gains == minimum_filter(gains, 3, mode=("nearest", "wrap")))
    lowest = np.argsort(gains[rows, columns])[:_MINIMA]
    near = np.radians(np.linspace(-_STEP_DEG, _STEP_DEG, 21))
    theta = np.radians(grid[0][rows[lowest]])[:, None, None] + near[:, None]
    phi = np.radians(grid[1][columns[lowest]])[:, None, None] + near
    theta, phi = np.broadcast_arrays(theta, phi)
    there = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    found = harmonics.gain(there)
    least = np.unravel_index(np.argmin(found), found.shape)
    return float(found[least]), float(theta[least]), float(phi[least])


def normalised(harmonics: Harmonics) -> Harmonics:
    """Return a pattern whose largest gain is 1.

    Args:
        harmonics: of any pattern.
    """
    peak = float(np.max(harmonics.on_grid(*_GRID)))
    return Harmonics(harmonics.cosine / peak, harmonics.sine / peak)


def axial_harmonics(gain: Callable[[FloatArray], FloatArray], degree: int) -> Harmonics:
    """Expand a gain that is the same all round.

    Args:
        gain: of the cosine of the angle to z.
        degree: the highest n.
    """
    nodes, weights = legendre.leggauss(4 * degree + 40)
    values = weights * gain(nodes)
    cosine = np.zeros((degree + 1, degree + 1))
    means = values @ legendre.legvander(nodes, degree) / 2.0
    cosine[:, 0] = means * np.sqrt(2.0 * np.arange(degree + 1) + 1.0)
    return Harmonics(cosine, np.zeros_like(cosine))


def _shortened(harmonics: Harmonics, least: float, peak: float) -> Harmonics:
    """Return the harmonics without the high degrees and tiny terms, lifted to the least gain that is known.

    A null that the fit makes deeper than any known gain would let jamming vanish that is received.
    """
    for terms in (harmonics.cosine, harmonics.sine):
        terms[np.abs(terms) < _TINY * peak] = 0.0  # a symmetry of the antenna is then one of the terms
    left_out = np.sqrt(np.cumsum(harmonics.spectrum[::-1])[::-1])
    degree = int(np.argmax(np.append(left_out[1:], 0.0) <= _LEFT_OUT * peak))
    kept = Harmonics(*(terms[: degree + 1, : degree + 1] for terms in (harmonics.cosine, harmonics.sine)))
    kept.cosine[0, 0] += max(0.0, least - deepest_null(kept)[0])
    return kept
