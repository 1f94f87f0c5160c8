"""What a pattern amounts to."""

import dataclasses

import numpy as np
import pytest

from nullpose.antenna.pattern import deepest_null, table_harmonics
from nullpose.antenna.summary import summary_of
from nullpose.antenna.table import PatternTable


def table_of(gain: object, field: object = None, step_deg: float = 10.0, **more: object) -> PatternTable:
    """Returns a table of a gain, or of a field, as functions of polar angle and azimuth in radians."""
    theta_deg, phi_deg = np.arange(0.0, 180.1, step_deg), np.arange(0.0, 360.0, step_deg)
    angles = np.meshgrid(np.radians(theta_deg), np.radians(phi_deg), indexing="ij")
    parts = None if field is None else np.stack(np.broadcast_arrays(*field(*angles)), axis=-1).astype(complex)
    values = gain(*angles) if parts is None else np.sum(np.abs(parts) ** 2, axis=-1)
    return PatternTable(theta_deg=theta_deg, phi_deg=phi_deg, gain=values, field=parts, **more)


def test_peak_null_and_ripple() -> None:
    """They are where the pattern has them."""
    bump = summary_of(table_of(lambda t, p: 1.0 + 0.5 * np.sin(t) * np.cos(p - np.radians(40.0))))
    assert (bump.peak_deg, bump.null_deg) == ((90.0, 40.0), (90.0, 220.0))
    assert bump.peak_dbi == pytest.approx(10.0 * np.log10(1.5))
    assert bump.null_db == bump.ripple_db == pytest.approx(10.0 * np.log10(3.0))
    assert bump.mean_db == pytest.approx(0.0, abs=1e-9)
    dipole = summary_of(table_of(lambda t, p: 1.5 * np.where(np.sin(t) < 1e-9, 0.0, np.sin(t)) ** 2))
    assert (dipole.null_db, dipole.null_deg, dipole.ripple_db) == (np.inf, (0.0, 0.0), pytest.approx(0.0))


@pytest.mark.parametrize(
    ("field", "polarisation"),
    [
        (lambda t, p: (np.sin(t), 0.0 * t), "linear along theta"),
        (lambda t, p: (0.0 * t, np.sin(t)), "linear along phi"),
        (lambda t, p: (np.sin(t), np.sin(t)), "linear, 45 degrees from theta towards phi"),
        (lambda t, p: (np.sin(t), -0.5 * np.sin(t)), "linear, 27 degrees from theta towards -phi"),
        (lambda t, p: (np.sin(t), 1j * np.sin(t)), "elliptical, axial ratio 0.0 dB"),
        (lambda t, p: (np.sin(t), -0.5j * np.sin(t)), "elliptical, axial ratio 6.0 dB"),
    ],
)
def test_polarisation(field: object, polarisation: str) -> None:
    """Its kind, tilt and axial ratio at the peak."""
    assert summary_of(table_of(None, field, step_deg=15.0)).polarisation == polarisation


def test_at_a_pole_the_azimuth_is_0() -> None:
    """There all azimuths are one direction, and theta points along x, whatever rounding makes the largest."""
    summary = summary_of(table_of(None, lambda t, p: (np.cos(t) * np.cos(p), -np.sin(p))))
    assert (summary.peak_deg, summary.polarisation) == ((0.0, 0.0), "linear along theta")


@pytest.mark.parametrize("degree", [0, 2, 5, 9])
def test_degree(degree: int) -> None:
    """The degree that solvers use is that of a polynomial of the cosine, and its errors are 0."""
    ripple = np.polynomial.legendre.Legendre.basis(degree)
    found = summary_of(table_of(lambda t, p: 1.5 + 0.5 * ripple(np.cos(t)), step_deg=15.0))
    assert (found.degree, found.supported_degree) == (degree, 11)
    assert max(found.error_10_db, found.error_20_db, found.null_error_db) < 1e-6


def test_the_null_that_is_used() -> None:
    """Where the fit does not follow, depth and place of its null are told, and its errors by direction."""
    sharp = summary_of(table_of(lambda t, p: np.where(t > 1.0, 2.0, 0.001) + 0.0 * p, step_deg=15.0))
    table, used = sharp.table, table_harmonics(sharp.table)
    gain = used.on_grid(np.radians(table.theta_deg), np.radians(table.phi_deg))
    apart_db = np.abs(10.0 * np.log10(gain / table.gain))
    assert sharp.null_db == pytest.approx(10.0 * np.log10(2000.0))
    assert sharp.used_null_db == pytest.approx(10.0 * np.log10(np.max(gain) / deepest_null(used)[0]))
    assert sharp.error_20_db == sharp.error_10_db == pytest.approx(np.max(apart_db[table.gain > 1.0]))
    assert np.max(apart_db[table.theta_deg == sharp.error_deg[0]]) == pytest.approx(sharp.error_20_db)
    assert sharp.null_error_db == pytest.approx(apart_db[table.gain < 1.0][0])


def test_the_step_and_the_frequency_tell_a_size() -> None:
    """A power needs twice the degree of its field, so gains alone need half the steps."""
    gains = table_of(lambda t, p: 1.0 + 0.0 * t, frequency_hz=2.4e9)
    wave_m = 299792458.0 / 2.4e9
    assert summary_of(gains).largest_m == pytest.approx(18.0 / 2.0 / (2.0 * np.pi) * wave_m)
    fields = table_of(None, lambda t, p: (np.sin(t), 0.0 * t), frequency_hz=2.4e9)
    assert summary_of(fields).largest_m == pytest.approx(18.0 / (2.0 * np.pi) * wave_m)
    assert summary_of(dataclasses.replace(gains, frequency_hz=None)).largest_m is None
