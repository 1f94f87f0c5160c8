"""What a radiation pattern amounts to: peak, null, ripple, polarisation, and what its grid can tell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.antenna.harmonics import supported_degree
from nullpose.antenna.pattern import deepest_null, table_harmonics
from nullpose.antenna.table import PatternTable, mean_gain
from nullpose.files import PlainTable

_NONE = 1e-12  # of the peak; rounding errors of an exact null
_LINEAR_DB = 20.0  # axial ratio from which a field counts as linear
_ALONG_DEG = 5.0  # tilt up to which it lies along theta or phi
_SPEED = 299792458.0  # m/s


@dataclass(frozen=True, slots=True, kw_only=True)
class PatternSummary:
    """The summary of a pattern.

    Args:
        table: the pattern.
        peak_dbi: largest gain.
        peak_deg: polar angle and azimuth of it.
        mean_db: average gain over the sphere: 0 for an antenna without losses.
        null_db: how far the smallest gain is below the peak; infinite for an exact null.
        null_deg: polar angle and azimuth of it.
        ripple_db: largest over smallest gain round the z axis, at the polar angle nearest to 90 degrees.
        polarisation: at the peak, in words.
        axial_ratio_db: there; None where no field is known, above 100 where it is linear.
        used_null_db: how far the smallest gain that solvers use is below the largest; infinite for none.
        used_null_deg: polar angle and azimuth of it.
        error_10_db: largest error of the gains that solvers use, within 10 dB of the peak.
        error_20_db: within 20 dB of it.
        error_deg: polar angle and azimuth of the latter.
        null_error_db: error there of the smallest gain; not finite where that is none.
        degree: of the spherical harmonics that solvers use.
        supported_degree: that the grid tells.
        step_deg: the widest of the grid.
        largest_m: radius about the origin of the largest structure whose pattern such steps hold at the
            frequency; None where that is not known.
    """

    table: PatternTable
    peak_dbi: float
    peak_deg: tuple[float, float]
    mean_db: float
    null_db: float
    null_deg: tuple[float, float]
    ripple_db: float
    polarisation: str
    axial_ratio_db: float | None
    used_null_db: float
    used_null_deg: tuple[float, float]
    error_10_db: float
    error_20_db: float
    error_deg: tuple[float, float]
    null_error_db: float
    degree: int
    supported_degree: int
    step_deg: float
    largest_m: float | None

    def to_dict(self) -> PlainTable:
        """Return the summary as plain data, angles in radians, without the table's numbers."""
        data = {name: getattr(self.table, name) for name in ("source", "quantity", "frequency_hz", "notes")}
        found = {name: getattr(self, name) for name in PatternSummary.__dataclass_fields__ if name != "table"}
        return data | {
            name.replace("_deg", "_rad"): np.radians(value).tolist() if name.endswith("_deg") else value
            for name, value in found.items()
        }


def summary_of(table: PatternTable) -> PatternSummary:
    """Return the summary of a pattern.

    Args:
        table: any.
    """
    used = table_harmonics(table)
    used_gain = used.on_grid(np.radians(table.theta_deg), np.radians(table.phi_deg))
    with np.errstate(divide="ignore", invalid="ignore"):
        gain_dbi, used_dbi = (10.0 * np.log10(np.maximum(gain, 0.0)) for gain in (table.gain, used_gain))
        apart_db = np.abs(used_dbi - gain_dbi)
    peak, null = (_place(table, find(table.gain)) for find in (np.argmax, np.argmin))
    equator_dbi = gain_dbi[np.argmin(np.abs(table.theta_deg - 90.0))]
    polarisation, axial_ratio_db = _polarisation(None if table.field is None else table.field[peak])
    error_10_db, error_db = (
        np.where(gain_dbi > gain_dbi[peak] - below, apart_db, 0.0) for below in (10.0, 20.0)
    )
    farthest = _place(table, np.argmax(error_db))
    least, *used_null = deepest_null(used)
    exact = least <= _NONE * np.max(used_gain)
    step_deg = max(180.0 / (len(table.theta_deg) - 1), 360.0 / len(table.phi_deg))
    # a structure of radius r has a field of degree 2 pi r / wavelength, and a power of twice that
    waves = 180.0 / step_deg / (2.0 if table.field is None else 1.0) / (2.0 * np.pi)
    return PatternSummary(
        table=table,
        peak_dbi=float(gain_dbi[peak]),
        peak_deg=(float(table.theta_deg[peak[0]]), float(table.phi_deg[peak[1]])),
        mean_db=float(10.0 * np.log10(mean_gain(table))),
        null_db=float(gain_dbi[peak] - gain_dbi[null]),
        null_deg=(float(table.theta_deg[null[0]]), float(table.phi_deg[null[1]])),
        ripple_db=float(np.ptp(equator_dbi)) if np.min(equator_dbi) > -np.inf else float("inf"),
        polarisation=polarisation,
        axial_ratio_db=axial_ratio_db,
        used_null_db=float("inf") if exact else float(np.max(used_dbi) - 10.0 * np.log10(least)),
        used_null_deg=(float(np.degrees(used_null[0])), float(np.degrees(used_null[1])) % 360.0),
        error_10_db=float(np.max(error_10_db)),
        error_20_db=float(error_db[farthest]),
        error_deg=(float(table.theta_deg[farthest[0]]), float(table.phi_deg[farthest[1]])),
        null_error_db=float(apart_db[null]),
        degree=used.degree,
        supported_degree=supported_degree(table),
        step_deg=float(step_deg),
        largest_m=None if table.frequency_hz is None else float(waves * _SPEED / table.frequency_hz),
    )


def _place(table: PatternTable, at: np.intp) -> tuple[int, int]:
    """Return row and column of a flat index; at a pole, where all azimuths are one, those of azimuth 0."""
    row, column = divmod(int(at), len(table.phi_deg))
    return row, column if 0 < row < len(table.theta_deg) - 1 else 0


def _polarisation(field: NDArray[np.complex128] | None) -> tuple[str, float | None]:
    """Return a field's polarisation in words, and its axial ratio in dB."""
    if field is None:
        return "not known", None
    along, round_z = field
    total, crossed = abs(along) ** 2 + abs(round_z) ** 2, 2.0 * along * np.conj(round_z)
    linear = float(np.hypot(abs(along) ** 2 - abs(round_z) ** 2, crossed.real))
    ratio_db = float(10.0 * np.log10((total + linear) / max(total - linear, 1e-12 * total)))
    tilt_deg = float(np.degrees(0.5 * np.arctan2(crossed.real, abs(along) ** 2 - abs(round_z) ** 2)))
    if ratio_db < _LINEAR_DB:
        return f"elliptical, axial ratio {ratio_db:.1f} dB", ratio_db
    if min(abs(tilt_deg), 90.0 - abs(tilt_deg)) > _ALONG_DEG:
        return f"linear, {abs(tilt_deg):.0f} degrees from theta towards {'-' * (tilt_deg < 0.0)}phi", ratio_db
    return f"linear along {'theta' if abs(tilt_deg) < 45.0 else 'phi'}", ratio_db
