"""What a pattern table says in a few numbers."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from nullpose.antenna.files.reading import mean_gain
from nullpose.antenna.harmonics import fit, highest_degree
from nullpose.antenna.pattern import table_harmonics
from nullpose.antenna.table import PatternTable

_LINEAR = 0.01  # axial ratio below which a polarisation counts as linear
_SAMPLES = 2.5  # steps of the grid for each turn of the pattern's highest degree, at least


@dataclass(frozen=True, slots=True, kw_only=True)
class PatternSummary:
    """A pattern in numbers; angles in degrees, in the antenna's axes.

    Args:
        source: file and format.
        quantity: "gain", "realised gain" or "directivity".
        frequency_hz: None where the file does not say.
        peak_dbi: largest gain over an isotropic antenna.
        peak_at_deg: its polar angle and azimuth.
        mean_gain_db: over the sphere: 0 for an antenna without losses.
        null_depth_db: how far the least gain is below the largest; infinite for a null.
        null_at_deg: where.
        ripple_db: least to largest gain round the equator of the z axis.
        polarisation: in words, where the peak is.
        degree: of the spherical harmonics that hold the pattern.
        step_deg: widest step of the grid.
        coarsest_deg: widest step that the degree allows; with phases, that of the field, which is half.
        notes: how it was read, a sentence each.
    """

    source: str
    quantity: str
    frequency_hz: float | None
    peak_dbi: float
    peak_at_deg: tuple[float, float]
    mean_gain_db: float
    null_depth_db: float
    null_at_deg: tuple[float, float]
    ripple_db: float
    polarisation: str
    degree: int
    step_deg: float
    coarsest_deg: float
    notes: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return the summary as plain data for JSON; an exact null has no depth."""
        values = asdict(self)
        return values | {
            "null_depth_db": values["null_depth_db"] if np.isfinite(self.null_depth_db) else None
        }


def summary_of(table: PatternTable) -> PatternSummary:
    """Return a table in numbers.

    Args:
        table: over the whole sphere.

    Raises:
        ScenarioError: its grid is too coarse for what it holds.
    """
    gain = table.gain
    most, least = (np.unravel_index(at, gain.shape) for at in (np.argmax(gain), np.argmin(gain)))
    degree = table_harmonics(table).degree
    equator = fit(table, min(degree + 8, highest_degree(table))).on_grid(
        np.array([np.pi / 2.0]), np.radians(np.arange(360.0))
    )
    with np.errstate(divide="ignore"):
        depth_db = float(-10.0 * np.log10(gain[least] / gain[most]))
    return PatternSummary(
        source=table.source,
        quantity=table.quantity,
        frequency_hz=table.frequency_hz,
        peak_dbi=_db(gain[most]),
        peak_at_deg=(float(table.theta_deg[most[0]]), float(table.phi_deg[most[1]])),
        mean_gain_db=_db(mean_gain(table)),
        null_depth_db=depth_db,
        null_at_deg=(float(table.theta_deg[least[0]]), float(table.phi_deg[least[1]])),
        ripple_db=_db(np.max(equator)) - _db(max(1e-30, float(np.min(equator)))),
        polarisation=_polarisation(table, most),
        degree=degree,
        step_deg=float(max(np.max(np.diff(table.theta_deg)), np.max(np.diff(table.phi_deg, append=360.0)))),
        coarsest_deg=360.0 / (_SAMPLES * max(1, degree) * (1.0 if table.field is None else 0.5)),
        notes=table.notes,
    )


def _db(ratio: Any) -> float:
    return float(10.0 * np.log10(ratio))


def _polarisation(table: PatternTable, at: Any) -> str:
    if table.field is None:
        return "not known: the file has powers alone"
    theta, phi = table.field[at]
    right, left = (abs(theta + sign * 1j * phi) for sign in (1.0, -1.0))
    axial = abs(right - left) / (right + left)
    if axial < _LINEAR:
        angle = np.degrees(np.arctan2(abs(phi), abs(theta)))
        return f"linear, {angle:.0f} degrees from the polar direction"
    if axial > 1.0 - 10.0 * _LINEAR:
        return f"circular, {'right' if right > left else 'left'}-handed"
    return f"elliptical, {'right' if right > left else 'left'}-handed, axial ratio {axial:.2f}"
