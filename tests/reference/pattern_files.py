"""Known patterns, one of them without any symmetry, and a writer for each format of pattern files."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

DATA = Path(__file__).parents[1] / "antenna" / "data"
FREQUENCY_HZ = 2.4e9

Field = Callable[[NDArray[np.float64], NDArray[np.float64]], NDArray[np.complex128]]
"""From polar angles and azimuths (degrees, any shape) to the parts along theta and phi, (..., 2)."""

Grid = tuple[NDArray[np.float64], NDArray[np.float64]]

_RNG = np.random.default_rng(7)
_FLAT, _SLOPE = _RNG.normal(size=(2, 3)) + 1j * _RNG.normal(size=(2, 3))
_TOWARDS = _RNG.normal(size=3)


def _raw_field(theta_deg: NDArray[np.float64], phi_deg: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Returns the part across the direction d of the vector ``flat + (towards . d) slope``."""
    theta, phi = np.radians(np.broadcast_arrays(theta_deg, phi_deg))
    out = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    along = np.stack([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), -np.sin(theta)], axis=-1)
    round_z = np.stack([-np.sin(phi), np.cos(phi), np.zeros(phi.shape)], axis=-1)
    vector = _FLAT + (out @ _TOWARDS)[..., None] * _SLOPE
    return np.stack([np.sum(along * vector, axis=-1), np.sum(round_z * vector, axis=-1)], axis=-1)


_Z, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_MEAN = np.sum(
    _WEIGHTS[:, None, None]
    * np.abs(_raw_field(np.degrees(np.arccos(_Z))[:, None], np.arange(0.0, 360.0, 15.0))) ** 2
) / (2.0 * 24.0)


def field_of(theta_deg: NDArray[np.float64], phi_deg: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Returns the field of an antenna without symmetry and without losses: its gain averages to 1."""
    return _raw_field(theta_deg, phi_deg) / np.sqrt(_MEAN)


def db(power: Any) -> Any:
    """Returns decibels."""
    return 10.0 * np.log10(np.maximum(power, 1e-99))


def dipole_field(theta_deg: NDArray[np.float64], phi_deg: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Returns the field of a short dipole along x, which has two exact nulls."""
    theta, phi = np.radians(np.broadcast_arrays(theta_deg, phi_deg))
    return np.sqrt(1.5) * np.stack([np.cos(theta) * np.cos(phi), -np.sin(phi)], axis=-1).astype(complex)


def _raw_omni_field(theta_deg: NDArray[np.float64], phi_deg: NDArray[np.float64]) -> NDArray[np.complex128]:
    theta, phi = np.radians(np.broadcast_arrays(theta_deg, phi_deg))
    along = 0.1 * np.cos(theta) - np.sin(theta) ** 2 * (1.0 - 0.3 * np.cos(theta))
    return np.exp(1j * phi)[..., None] * np.stack([along, np.full(theta.shape, 0.1j)], axis=-1)


_OMNI_MEAN = 0.5 * np.sum(
    _WEIGHTS[:, None] * np.abs(_raw_omni_field(np.degrees(np.arccos(_Z)), np.zeros(12))) ** 2
)


def omni_field(theta_deg: NDArray[np.float64], phi_deg: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Returns the field of an antenna that is the same all round, stronger below, with nulls of 17 dB."""
    return _raw_omni_field(theta_deg, phi_deg) / np.sqrt(_OMNI_MEAN)


FIELDS: dict[str, Field] = {"any": field_of, "dipole": dipole_field, "omni": omni_field}


def _rows(grid: Grid, field: Field, *, theta_inner: bool) -> list[tuple]:
    """Returns theta, phi, both parts of the field and the power of every direction, in a file's order."""
    theta, phi = np.meshgrid(*grid, indexing="ij")
    if theta_inner:
        theta, phi = theta.T, phi.T
    parts = field(theta, phi).reshape(-1, 2)
    power = np.sum(np.abs(parts) ** 2, axis=1)
    return list(zip(theta.ravel(), phi.ravel(), parts[:, 0], parts[:, 1], power, strict=True))


def _sphere(step_deg: float, first_deg: float = 0.0, last_deg: float = 360.0) -> Grid:
    """Returns polar angles from 0 to 180 and azimuths, the last included."""
    return np.arange(0.0, 181.0, step_deg), np.arange(first_deg, last_deg + 1.0, step_deg)


def _nec_rows(grid: Grid, field: Field) -> str:
    lines = []
    for theta, phi, a, b, power in _rows(grid, field, theta_inner=True):
        gains = " ".join(f"{db(each):8.2f}" for each in (abs(a) ** 2, abs(b) ** 2, power))
        parts = " ".join(f"{0.37 * abs(part):.4E} {np.degrees(np.angle(part)):9.2f}" for part in (a, b))
        lines.append(f"{theta:8.2f} {phi:8.2f} {gains} 0.5000 12.00 RIGHT {parts}")
    return "\n".join(lines)


def write_nec(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns what nec2c writes."""
    table = _nec_rows(_sphere(step_deg), field)
    return (
        " --------- FREQUENCY --------\n FREQUENCY : 2.4000E+03 MHz\n\n"
        " ---------- RADIATION PATTERNS -----------\n\n"
        " ---- ANGLES -----  ----- POWER GAINS -----  -- POLARIZATION --  -- E(THETA) --  -- E(PHI) --\n"
        "  THETA  PHI  VERTC  HORIZ  TOTAL  AXIAL  TILT  SENSE  MAGNITUDE  PHASE  MAGNITUDE  PHASE\n"
        " DEGREES DEGREES  DB  DB  DB  RATIO  DEGREES  VOLTS/M  DEGREES  VOLTS/M  DEGREES\n"
        f"{table}\n\n\n TOTAL RUN TIME: 0 msec\n"
    )


def write_4nec2(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns what 4nec2 writes: polar angles from -180, half of the azimuths."""
    table = _nec_rows((np.arange(-180.0, 181.0, step_deg), np.arange(0.0, 181.0, step_deg)), field)
    return (
        " - - - - FREQUENCY - - - -\n\n FREQUENCY= 2.4000E+03 MHZ\n\n\n - - - RADIATION PATTERNS - - -\n\n"
        "  - - ANGLES - -   - POWER GAINS -   - - - POLARIZATION - - -   - E(THETA) -   - E(PHI) -\n"
        "  THETA  PHI  VERT.  HOR.  TOTAL  AXIAL  TILT  SENSE  MAGNITUDE  PHASE  MAGNITUDE  PHASE\n"
        " DEGREES DEGREES  DB  DB  DB  RATIO  DEG.  VOLTS/M  DEGREES  VOLTS/M  DEGREES\n"
        f"{table}\n\n\n   AVERAGE POWER GAIN= 1.00940E+00\n"
    )


def write_ffd(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns what HFSS writes: polar angles in the outer loop, azimuths from -180, volts."""
    grid = _sphere(step_deg, -180.0, 180.0)
    rows = _rows(grid, field, theta_inner=False)
    table = "\n".join(
        f"{9 * a.real:.8e} {9 * a.imag:.8e} {9 * b.real:.8e} {9 * b.imag:.8e}" for _, _, a, b, _ in rows
    )
    counts = [len(angles) for angles in grid]
    return f"0 180 {counts[0]}\n-180 180 {counts[1]}\nFrequencies 1\nFrequency 2.4e9\n{table}\n"


def write_old_ffd(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns what older versions write: no frequencies."""
    lines = write_ffd(field, step_deg).split("\n")
    return "\n".join([*lines[:2], *lines[4:]])


def write_ffs(
    field: Field = field_of, step_deg: float = 5.0, powers: tuple[float, ...] = (0.4, 0.4, 0.5)
) -> str:
    """Returns what CST writes as a far-field source: azimuth first, polar angle in the inner loop."""
    grid = _sphere(step_deg)
    rows = _rows(grid, field, theta_inner=True)
    volts = np.sqrt(376.730313 / (2.0 * np.pi) * powers[1])
    table = "\n".join(
        f"{phi:9.3f} {theta:9.3f} " + " ".join(f"{volts * x:.8e}" for x in (a.real, a.imag, b.real, b.imag))
        for theta, phi, a, b, _ in rows
    )
    told = "\n".join(f"{power:e}" for power in powers)
    return (
        "// CST Farfield Source File\n\n// Version:\n3.0\n\n// Data Type\nFarfield\n\n// #Frequencies\n1\n\n"
        "// Position\n0 0 0\n\n// zAxis\n0 0 1\n\n// xAxis\n1 0 0\n\n"
        f"// Radiated/Accepted/Stimulated Power , Frequency\n{told}\n{FREQUENCY_HZ:e}\n\n"
        f"// >> Total #phi samples, total #theta samples\n{len(grid[1])} {len(grid[0])}\n\n"
        f"// >> Phi, Theta, Re(E_Theta), Im(E_Theta), Re(E_Phi), Im(E_Phi):\n{table}\n"
    )


def write_cst(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns what CST writes as a table in text."""
    lines = [
        "Theta [deg.]  Phi   [deg.]  Abs(Dir.)[dBi   ]   Abs(Theta)[dBi   ]  Phase(Theta)[deg.]  "
        "Abs(Phi  )[dBi   ]  Phase(Phi  )[deg.]  Ax.Ratio[dB    ]",
        "-" * 120,
    ]
    for theta, phi, a, b, power in _rows(_sphere(step_deg, 0.0, 355.0), field, theta_inner=True):
        total, along, round_z = db([power, abs(a) ** 2, abs(b) ** 2])
        angles = [np.degrees(np.angle(part)) % 360.0 for part in (a, b)]
        parts = f"{along:.4e} {angles[0]:8.3f} {round_z:.4e} {angles[1]:8.3f}"
        lines.append(f"{theta:8.3f} {phi:8.3f} {total:.4e} {parts} 4.000e+01")
    return "\n".join(lines) + "\n"


def write_csv(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns a table of gains, its rows in no order."""
    rows = _rows(_sphere(step_deg, 0.0, 355.0), field, theta_inner=True)
    lines = [f"{theta:g},{phi:g},{db(power):.4f}" for theta, phi, _, _, power in rows]
    np.random.default_rng(1).shuffle(lines)
    return "\n".join(["theta_deg,phi_deg,gain_dbi", *lines]) + "\n"


def write_complex_csv(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns a table of fields."""
    rows = _rows(_sphere(step_deg, 0.0, 355.0), field, theta_inner=False)
    lines = [f"{t:g},{p:g},{a.real:.7f},{a.imag:.7f},{b.real:.7f},{b.imag:.7f}" for t, p, a, b, _ in rows]
    return "\n".join(["theta_deg,phi_deg,re_theta,im_theta,re_phi,im_phi", *lines]) + "\n"


def write_hfss_csv(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns what a report of HFSS writes: headings and units in quotes, azimuths from -180."""
    lines = ['"Freq [GHz]","Phi [deg]","Theta [deg]","dB(GainTotal) []"']
    rows = _rows(_sphere(step_deg, -180.0, 180.0), field, theta_inner=True)
    lines += [f"2.4,{phi:g},{theta:g},{db(power):.9f}" for theta, phi, _, _, power in rows]
    return "\n".join(lines) + "\n"


def write_hfss_linear(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns a report of linear realised gains, its columns in another order, polar angles from -180."""
    lines = ["RealizedGainTotal,Theta[deg],Phi[deg],Freq[MHz]"]
    grid = np.arange(-180.0, 181.0, step_deg), np.arange(0.0, 180.0, step_deg)
    rows = _rows(grid, field, theta_inner=False)
    lines += [f"{power:.9f},{theta:g},{phi:g},2400" for theta, phi, _, _, power in rows]
    return "\n".join(lines) + "\n"


def write_cst_gains(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns a table of CST without phases, of realised gains."""
    lines = ["Theta [deg.]  Phi   [deg.]  Abs(Grlz)[dBi   ]   Ax.Ratio[dB    ]  ", "-" * 60]
    rows = _rows(_sphere(step_deg, 0.0, 355.0), field, theta_inner=True)
    lines += [f"{theta:8.3f} {phi:8.3f} {db(power):.3e} 4.000e+01" for theta, phi, _, _, power in rows]
    return "\n".join(lines) + "\n"


def write_mininec(field: Field = field_of, step_deg: float = 5.0) -> str:
    """Returns what MININEC writes: zenith angles in the inner loop, gains in dBi without phases."""
    lines = []
    for theta, phi, a, b, power in _rows(_sphere(step_deg), field, theta_inner=True):
        gains = "".join(f"{max(db(each), -999.0):<15.5f}" for each in (abs(a) ** 2, abs(b) ** 2, power))
        lines.append(f" {theta:<14g}{phi:<14g}{gains}")
    table = "\n".join(lines)
    return (
        f"{'*' * 40}\n MINI-NUMERICAL ELECTROMAGNETICS CODE\n MININEC\n\nFREQUENCY (MHZ): 2400\n\n"
        f"{'*' * 20}    PATTERN DATA    {'*' * 20}\n"
        "ZENITH        AZIMUTH       VERTICAL      HORIZONTAL    TOTAL\n"
        " ANGLE         ANGLE        PATTERN (DB)  PATTERN (DB)  PATTERN (DB)\n"
        f"{table}\n"
    )


def write_omni_msi(field: Field = omni_field, step_deg: float = 1.0) -> str:
    """Returns two cuts of an antenna that is the same all round."""
    at_deg = np.arange(360.0)
    theta = np.where(at_deg <= 90.0, 90.0 + at_deg, np.where(at_deg < 270.0, 270.0 - at_deg, at_deg - 270.0))
    gain_dbi = db(np.sum(np.abs(field(theta, 0.0)) ** 2, axis=-1))
    peak_dbi = np.max(gain_dbi)
    return write_msi(np.full(360, peak_dbi - gain_dbi[0]), peak_dbi - gain_dbi, f"{peak_dbi:.6f} dBi")


def write_msi(
    across_db: NDArray[np.float64], down_db: NDArray[np.float64], gain: str = "5.0 dBd", mhz: str = "2400"
) -> str:
    """Returns two cuts, losses at every degree: clockwise from ahead, and downwards from ahead."""
    cuts = [
        f"{name} 360\n" + "\n".join(f"{at} {loss:.4f}" for at, loss in enumerate(losses))
        for name, losses in (("HORIZONTAL", across_db), ("VERTICAL", down_db))
    ]
    head = f"NAME test\nMAKE nullpose\nFREQUENCY {mhz}\nGAIN {gain}\nTILT 0\nPOLARIZATION V\n"
    return head + "\n".join(cuts) + "\n"


WRITERS: dict[str, tuple[str, Callable[..., str]]] = {
    "nec": ("nec", write_nec),
    "4nec2": ("nec", write_4nec2),
    "ffd": ("ffd", write_ffd),
    "ffs": ("ffs", write_ffs),
    "cst": ("cst", write_cst),
    "csv": ("csv", write_csv),
    "complex-csv": ("csv", write_complex_csv),
    "old-ffd": ("ffd", write_old_ffd),
    "hfss-csv": ("csv", write_hfss_csv),
    "hfss-linear": ("csv", write_hfss_linear),
    "mininec": ("mininec", write_mininec),
    "cst-gains": ("cst", write_cst_gains),
}


@cache
def written(name: str, step_deg: float = 5.0) -> str:
    """Returns the pattern without symmetry in the format of a writer."""
    return WRITERS[name][1](field_of, step_deg)
