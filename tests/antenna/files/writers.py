"""A pattern in each format, as the formats' descriptions say."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

THETA, PHI = np.arange(0.0, 181.0, 5.0), np.arange(0.0, 360.0, 5.0)

Field = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""From polar angles and azimuths, radians, to complex parts along both, (..., 2); squares sum to the gain."""


def lopsided(theta: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Return the field of a turnstile above a longer arm: nothing about it is symmetric."""
    along = np.cos(theta) * (0.6 * np.cos(phi) + 0.8j * np.sin(phi)) - 0.3 * np.sin(theta)
    across = -0.6 * np.sin(phi) + 0.8j * np.cos(phi)
    shape = 0.8 + 0.35 * np.sin(theta) * np.sin(phi) + 0.15 * np.cos(theta)
    return np.stack([along * shape, across * shape + 0.0 * theta], axis=-1) * 0.9


def samples(field: Field, theta: np.ndarray = THETA, phi: np.ndarray = PHI) -> tuple[np.ndarray, ...]:
    """Return angles of all rows and the field there, polar angle outermost."""
    grid = [axis.ravel() for axis in np.meshgrid(theta, phi, indexing="ij")]
    return *grid, field(*np.radians(grid))


def dbi(values: np.ndarray) -> np.ndarray:
    """Return gains in dB."""
    return 10.0 * np.log10(np.maximum(np.sum(np.abs(values) ** 2, axis=-1), 1e-99))


def write_csv(path: Path, field: Field) -> None:
    """Write gains."""
    theta, phi, values = samples(field)
    rows = [f"{t},{p},{g:.4f}" for t, p, g in zip(theta, phi, dbi(values), strict=True)]
    path.write_text("\n".join(["theta_deg,phi_deg,gain_dbi", *rows]))


def write_csv_fields(path: Path, field: Field) -> None:
    """Write complex fields."""
    rows = [
        f"{t},{p},{a.real:.8f},{a.imag:.8f},{b.real:.8f},{b.imag:.8f}"
        for t, p, (a, b) in zip(*samples(field), strict=True)
    ]
    path.write_text("\n".join(["theta_deg,phi_deg,re_theta,im_theta,re_phi,im_phi", *rows]))


def write_nec(path: Path, field: Field) -> None:
    """Write NEC's table: azimuth outermost, fields of any power, polar angles from -180."""
    lines = [
        "FREQUENCY : 4.3300E+02 MHz",
        "",
        "---------- RADIATION PATTERNS -----------",
        "",
        "THETA PHI",
        "",
    ]
    for phi in PHI[PHI < 180.0]:
        for theta in np.concatenate([-THETA[:0:-1], THETA]):
            back = theta < 0.0
            a, b = field(np.radians(abs(theta)), np.radians(phi + 180.0 * back)) * (-1.0 if back else 1.0)
            total = dbi(np.array([a, b]))
            parts = [10.0 * np.log10(max(abs(x) ** 2, 1e-99)) for x in (a, b)]
            numbers = [theta, phi, max(parts[0], -999.99), max(parts[1], -999.99), total, 0.0, 0.0]
            fields = [7e-3 * abs(a), np.degrees(np.angle(a)), 7e-3 * abs(b), np.degrees(np.angle(b))]
            sense = "" if total < -40.0 else " RIGHT"
            text = " ".join(f"{x:.2f}" for x in numbers)
            lines.append(f"{text}{sense} " + " ".join(f"{x:.6E}" for x in fields))
    path.write_text("\n".join([*lines, "", "RUN TIME = .1"]))


def write_ffd(path: Path, field: Field) -> None:
    """Write HFSS fields: polar angle outermost, azimuths from -180, no power."""
    phi = np.arange(-180.0, 181.0, 5.0)
    rows = [
        f"{a.real:.8e} {a.imag:.8e} {b.real:.8e} {b.imag:.8e}"
        for a, b in 12.0 * samples(field, THETA, phi)[2]
    ]
    path.write_text("\n".join(["0 180 37", "-180 180 73", "Frequencies 1", "Frequency 2400000000", *rows]))


def write_ffs(path: Path, field: Field) -> None:
    """Write a CST far-field source: polar angle innermost, peak fields, half a watt accepted."""
    phi, theta = (axis.ravel() for axis in np.meshgrid(np.arange(0.0, 361.0, 5.0), THETA, indexing="ij"))
    values = np.sqrt(60.0 * 0.5) * field(np.radians(theta), np.radians(phi))
    rows = [
        f"{p} {t} {a.real:.8e} {a.imag:.8e} {b.real:.8e} {b.imag:.8e}"
        for p, t, (a, b) in zip(phi, theta, values, strict=True)
    ]
    head = [
        "// CST Farfield Source File", "// Version:", "3.0", "// #Frequencies", "1",
        "// Radiated/Accepted/Stimulated Power , Frequency", "0.45", "0.5", "0.6", "2.4e9",
        "// >> Total #phi samples, total #theta samples", "73 37",
        "// >> Phi, Theta, Re(E_Theta), Im(E_Theta), Re(E_Phi), Im(E_Phi):",
    ]  # fmt: skip
    path.write_text("\n".join([*head, *rows]))


def write_cst(path: Path, field: Field) -> None:
    """Write a CST table of gains with phases."""
    head = "Theta [deg.]  Phi   [deg.]  Abs(Gain)[dBi   ]   Abs(Theta)[dBi   ]  Phase(Theta)[deg.]  "
    head += "Abs(Phi  )[dBi   ]  Phase(Phi  )[deg.]  Ax.Ratio[dB    ]"
    rows = []
    for t, p, v in zip(*samples(field), strict=True):
        parts = [(dbi(np.array([x])), np.degrees(np.angle(x))) for x in v]
        told = " ".join(f"{max(power, -190.5):.5f} {phase:.4f}" for power, phase in parts)
        rows.append(f"{t} {p} {dbi(v):.5f} {told} 40.0")
    path.write_text("\n".join([head, "-" * 80, *rows]))


def write_emane(path: Path, field: Field) -> None:
    """Write an EMANE profile, whose bearings grow clockwise; 10 dB of the gain are told as blockage."""
    lines = ["<antennaprofile>", "<antennapattern>"]
    for elevation in range(-90, 91):
        lines.append(f'<elevation min="{elevation}" max="{elevation}">')
        for bearing in range(360):
            gain = dbi(field(np.radians(90.0 - elevation), np.radians(-bearing))) + 10.0
            lines.append(f'<bearing min="{bearing}" max="{bearing}"><gain value="{gain:.4f}"/></bearing>')
        lines.append("</elevation>")
    blocked = '<blockagepattern><bearing min="0" max="359"><elevation min="-90" max="90"><gain value="-10"/>'
    lines += ["</antennapattern>", f"{blocked}</elevation></bearing></blockagepattern>", "</antennaprofile>"]
    path.write_text("\n".join(lines))


def write_msi(
    path: Path, loss_db: Callable[[float], float], across_db: Callable[[float], float], gain: str
) -> None:
    """Write two cuts: losses over the angle below the horizon, and over the azimuth."""
    down = [f"{a} {loss_db(a):.3f}" for a in range(360)]
    across = [f"{a} {across_db(a):.3f}" for a in range(360)]
    head = ["NAME omni", "FREQUENCY 2400", f"GAIN {gain}"]
    path.write_text("\n".join([*head, "HORIZONTAL 360", *across, "VERTICAL 360", *down]))


WRITERS = {
    "csv": write_csv,
    "csv-fields": write_csv_fields,
    "nec": write_nec,
    "ffd": write_ffd,
    "ffs": write_ffs,
    "cst": write_cst,
    "emane": write_emane,
}
