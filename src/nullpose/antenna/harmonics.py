"""A power pattern as a sum of real spherical harmonics, which is smooth and defined in every direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna.table import PatternTable, solid_angles

FloatArray = NDArray[np.float64]

HIGHEST_DEGREE = 48
"""The highest that solvers take: a frame of half a metre at 2.4 GHz needs about 40."""
MOST_MISSED = 0.01
"""Root mean square over the sphere that a fit may miss, of the peak."""
_MET = 1e-4  # likewise, of a field whose gains are not fitted too; sound ones miss 1e-5


@dataclass(frozen=True, slots=True, eq=False)
class Harmonics:
    """``g(b) = sum_nm P_nm(z) (c_nm Re (x + iy)^m + s_nm Im (x + iy)^m)`` for a direction b = (x, y, z).

    The ``P_nm(z)`` are associated Legendre functions over ``sin^m``, scaled so that the mean square of each
    term over the sphere is ``c_nm^2`` or ``s_nm^2``: ``c_00`` is the mean gain.

    Args:
        cosine: (degree + 1, degree + 1) c by n and m, zero where m exceeds n.
        sine: s, likewise; zero for m = 0.
    """

    cosine: FloatArray
    sine: FloatArray

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Harmonics) and self._terms == other._terms

    def __hash__(self) -> int:
        return hash(self._terms)

    @property
    def _terms(self) -> tuple[bytes, bytes]:
        return self.cosine.tobytes(), self.sine.tobytes()

    @property
    def degree(self) -> int:
        """The highest n."""
        return len(self.cosine) - 1

    @property
    def spectrum(self) -> FloatArray:
        """Mean square over the sphere of the terms of each degree, (degree + 1,)."""
        return np.asarray(np.sum(self.cosine**2 + self.sine**2, axis=1))

    @property
    def is_axisymmetric(self) -> bool:
        """Whether nothing changes round the z axis."""
        return not np.any(self.cosine[:, 1:]) and not np.any(self.sine)

    @property
    def is_even(self) -> bool:
        """Whether opposite directions have the same gain."""
        return not np.any(self.spectrum[1::2])

    def gain(self, directions: ArrayLike) -> FloatArray:
        """Return the gain in each direction, (...).

        Args:
            directions: (..., 3) unit vectors in body axes.
        """
        x, y, z = np.moveaxis(np.asarray(directions, dtype=float), -1, 0)
        total, power = np.zeros(x.shape), np.ones(x.shape, dtype=complex)
        last = int(np.max(np.nonzero(np.any(self.cosine, axis=0) | np.any(self.sine, axis=0)), initial=0))
        for m, columns in enumerate(_legendre(z, self.degree, last)):
            for n, column in enumerate(columns, start=m):
                total += column * (self.cosine[n, m] * power.real + self.sine[n, m] * power.imag)
            power = power * (x + 1j * y)
        return total

    def on_grid(self, theta_rad: FloatArray, phi_rad: FloatArray) -> FloatArray:
        """Return the gain on a grid, (t, p).

        Args:
            theta_rad: (t,) polar angles.
            phi_rad: (p,) azimuths.
        """
        orders, total = np.arange(self.degree + 1), np.zeros((2, self.degree + 1, len(theta_rad)))
        for m, columns in enumerate(_legendre(np.cos(theta_rad), self.degree)):
            waves = np.array([self.cosine[m:, m], self.sine[m:, m]]) @ np.array(columns)
            total[:, m] = waves * np.sin(theta_rad) ** m
        angles = np.outer(orders, phi_rad)
        return np.asarray(total[0].T @ np.cos(angles) + total[1].T @ np.sin(angles))

    def rows(self) -> list[list[float]]:
        """Return the terms as plain numbers: for each degree the cosine terms, then the sine terms."""
        return [[*self.cosine[n, : n + 1], *self.sine[n, 1 : n + 1]] for n in range(self.degree + 1)]


def recurrence(degree: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the numbers that make the Legendre functions from each other.

    ``P_mm = start_m`` and ``P_nm = a_nm z P_(n-1)m - b_nm P_(n-2)m``.

    Args:
        degree: the highest n.

    Returns:
        start, (degree + 1,), and a and b, (degree + 1, degree + 1) by n and m.
    """
    n, m = np.mgrid[: degree + 1, : degree + 1].astype(float)
    start = np.sqrt(
        np.cumprod(
            [1.0, *((2.0 * k + 1.0) / (2.0 * k) * (2.0 if k == 1 else 1.0) for k in range(1, degree + 1))]
        )
    )
    a, b = np.zeros((2, degree + 1, degree + 1))
    below = n > m
    a[below] = np.sqrt((4.0 * n**2 - 1.0)[below] / (n**2 - m**2)[below])
    below &= n > m + 1
    b[below] = np.sqrt(
        ((2.0 * n + 1.0) * ((n - 1.0) ** 2 - m**2))[below] / ((2.0 * n - 3.0) * (n**2 - m**2))[below]
    )
    return start, a, b


def _legendre(z: FloatArray, degree: int, last: int | None = None) -> list[list[FloatArray]]:
    """Return P_nm(z) by m, up to the last order that is asked for, then by n from m on."""
    start, a, b = recurrence(degree)
    found = []
    for m in range(1 + (degree if last is None else last)):
        columns = [np.full(z.shape, start[m])]
        before = np.zeros(z.shape)
        for n in range(m + 1, degree + 1):
            columns.append(a[n, m] * z * columns[-1] - b[n, m] * before)
            before = columns[-2]
        found.append(columns)
    return found


def highest_degree(table: PatternTable) -> int:
    """Return the highest degree that a table's grid can tell from lower ones.

    Args:
        table: with equal or unequal steps.
    """
    widest_deg = max(np.max(np.diff(table.theta_deg)), np.max(np.diff(table.phi_deg, append=360.0)))
    return max(0, int(180.0 / widest_deg - 1e-9))


def supported_degree(table: PatternTable) -> int:
    """Return the highest degree of a table's power gain that its grid tells, and that solvers take.

    The power of a field has twice its degree.

    Args:
        table: any.
    """
    return min(HIGHEST_DEGREE, highest_degree(table) * (1 if table.field is None else 2))


def fit(table: PatternTable, degree: int) -> Harmonics:
    """Return the harmonics of a table's power gain up to a degree, least squares over the sphere.

    A table with phases is interpolated as a field first, whose degree is half of its power's. Where that
    misses, since the phases of an antenna far from the origin turn too fast or are wrong, the gains alone are
    fitted too, and the fit that misses less is returned.

    Args:
        table: on any grid that supports the degree.
        degree: the highest n.
    """
    half = min(degree, highest_degree(table))
    if table.field is None:
        return _fit(table.theta_deg, table.phi_deg, table.gain, half)
    found = _fit_of_field(table, degree, half)
    if (missed := missed_share(table, found)) > _MET:
        of_gain = _fit(table.theta_deg, table.phi_deg, table.gain, half)
        found = of_gain if missed_share(table, of_gain) < missed else found
    return found


def missed_share(table: PatternTable, harmonics: Harmonics) -> float:
    """Return the root mean square over the sphere of what harmonics miss of a table, of its peak.

    Args:
        table: any.
        harmonics: of its gain.
    """
    missed = harmonics.on_grid(np.radians(table.theta_deg), np.radians(table.phi_deg)) - table.gain
    return float(np.sqrt(np.sum(solid_angles(table) * missed**2)) / np.max(table.gain))


def _fit_of_field(table: PatternTable, degree: int, half: int) -> Harmonics:
    """Return the harmonics of the power of a table's field, whose parts are fitted up to half the degree."""
    assert table.field is not None
    along = directions(table.theta_deg + 90.0, table.phi_deg)
    round_z = directions([90.0], table.phi_deg + 90.0)
    field = along * table.field[..., :1] + round_z * table.field[..., 1:]
    fine = np.linspace(0.0, 180.0, 4 * degree + 5), np.arange(0.0, 360.0, 360.0 / (4 * degree + 5))
    there = np.deg2rad(fine[0]), np.deg2rad(fine[1])
    parts = [part for axis in np.moveaxis(field, -1, 0) for part in (axis.real, axis.imag)]
    each = [_fit(table.theta_deg, table.phi_deg, part, half).on_grid(*there) for part in parts]
    return _fit(*fine, np.sum(np.square(each), axis=0), degree)


def directions(theta_deg: ArrayLike, phi_deg: ArrayLike) -> FloatArray:
    """Return unit vectors of a grid, (t, p, 3).

    Args:
        theta_deg: (t,) polar angles.
        phi_deg: (p,) azimuths.
    """
    theta, phi = np.meshgrid(np.deg2rad(theta_deg), np.deg2rad(phi_deg), indexing="ij")
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


def _fit(theta_deg: FloatArray, phi_deg: FloatArray, values: FloatArray, degree: int) -> Harmonics:
    """Return the harmonics of values on a grid: a Fourier series in azimuth, then each order in theta."""
    phi, z, s = np.deg2rad(phi_deg), np.cos(np.deg2rad(theta_deg)), np.sin(np.deg2rad(theta_deg))
    orders = min(degree, (len(phi) - 1) // 2)
    m = np.arange(orders + 1)
    waves = np.hstack([np.cos(np.outer(phi, m)), np.sin(np.outer(phi, m[1:]))])
    series = np.linalg.lstsq(waves, values.T, rcond=None)[0]  # (2 orders + 1, t)
    weight = np.sqrt(np.maximum(s, 1e-3))
    cosine, sine = np.zeros((2, degree + 1, degree + 1))
    for order, columns in enumerate(_legendre(z, degree)[: orders + 1]):
        matrix = np.stack(columns, axis=1) * (weight * s**order)[:, None]
        right = np.stack([series[order], series[orders + order] if order else 0.0 * z], axis=1)
        found = np.linalg.lstsq(matrix, right * weight[:, None], rcond=None)[0]
        cosine[order:, order], sine[order:, order] = found[:, 0], found[:, 1]
    return Harmonics(cosine, sine)
