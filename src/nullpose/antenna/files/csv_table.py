"""Comma-separated tables: gains, or complex fields, over directions, also reports of HFSS; and profiles."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain

import numpy as np

from nullpose.antenna.files.block import Block, Lines, from_db, numbers, power_of, require
from nullpose.antenna.harmonics import FloatArray

_ANGLES = {"angle_deg": (0.0, 1.0), "elevation_deg": (90.0, -1.0)}  # to that from the axis: offset and sign
_FIELDS = (("re_theta", "im_theta"), ("re_phi", "im_phi"))
_GAINS = {"gain_dbi": "gain"} | {
    name: quantity
    for total, quantity in (("gain", "gain"), ("realizedgain", "realised gain"), ("dir", "directivity"))
    for name in (f"db({total}total)", f"{total}total")
}
_ALLOWED = (
    "theta_deg,phi_deg and gain_dbi or re_theta,im_theta,re_phi,im_phi; or of a report of HFSS Theta [deg], "
    "Phi [deg] and dB(GainTotal), dB(RealizedGainTotal), dB(DirTotal), or these without dB"
)
_UNITS = {"hz": 1.0, "khz": 1e3, "mhz": 1e6, "ghz": 1e9}


def read_csv(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a table: one for each frequency.

    Args:
        lines: of the file.

    Raises:
        ScenarioError: the table is faulty.
    """
    header, values = _table(lines)
    names = [re.sub(r"\[deg\]$", "_deg", re.sub(r"\[(dbi?)?\]$", "", name)) for name in header]
    columns = dict(zip(names, values.T, strict=True))
    total = next((name for name in _GAINS if name in columns), "")
    needed = {"theta_deg", "phi_deg", *([total] if total else chain(*_FIELDS))}
    require(
        columns.keys() >= needed and len(columns) == len(names),
        f"got the header {lines[0][1].strip()[:60]!r}, must have {_ALLOWED}, each once",
        lines[0][0],
    )
    unread = [name for name in columns if name not in needed and not name.startswith("freq[")]
    each_hz = [_UNITS[unit] * columns[f"freq[{unit}]"] for unit in _UNITS if f"freq[{unit}]" in columns]
    of_hz = each_hz[0] if each_hz else np.zeros(len(values))
    for frequency_hz in np.unique(of_hz):
        rows = np.flatnonzero(of_hz == frequency_hz)
        part = {name: column[rows] for name, column in columns.items()}
        parts = [] if total else [part[real] + 1j * part[imaginary] for real, imaginary in _FIELDS]
        field = np.stack(parts, axis=1) if parts else None
        gain = part[total] if field is None else power_of(field)
        yield Block(
            theta_deg=part["theta_deg"],
            phi_deg=part["phi_deg"],
            gain=from_db(gain) if total.startswith(("db(", "gain_dbi")) else gain,
            field=field,
            lines=np.array([lines[1 + row][0] for row in rows.tolist()]),
            frequency_hz=float(frequency_hz),
            quantity=_GAINS.get(total, "gain"),
            notes=(f"Columns that are not read: {', '.join(unread)}.",) if unread else (),
        )


def profile_of(lines: Lines) -> tuple[FloatArray, FloatArray]:
    """Return angles from the axis, (n,), degrees, rising from 0 to 180, and linear gains there, (n,).

    Args:
        lines: of the file.

    Raises:
        ScenarioError: the table is faulty, or does not span the angles.
    """
    header, values = _table(lines)
    got = f"got the header {lines[0][1].strip()[:60]!r}"
    names = [name for name in _ANGLES if name in header]
    needed = "must have angle_deg,gain_dbi (from the axis) or elevation_deg,gain_dbi"
    require("gain_dbi" in header and len(names) == 1, f"{got}, {needed}", lines[0][0])
    offset, sign = _ANGLES[names[0]]
    rows = values[:, [header.index(names[0]), header.index("gain_dbi")]] * [sign, 1.0] + [offset, 0.0]
    angle, gain_dbi = rows[np.argsort(rows[:, 0])].T
    first = ", ".join(f"{x:g}" for x in (*angle[:2], angle[-1]))
    require(
        angle[0] == 0.0 and angle[-1] == 180.0 and np.all(np.diff(angle) > 0.0),
        f"angles are {first} degrees (first two, last), must go from 0 to 180, each given once, from the "
        "axis; elevations must go from -90 to 90",
    )
    return angle, from_db(gain_dbi)


def _table(lines: Lines) -> tuple[list[str], FloatArray]:
    """Return a table's header, without quotes and blanks, in lower case, and its numbers, (n, columns)."""
    text = lines[0][1]
    separator = next((mark for mark in ",;\t" if mark in text), ",")
    header = [re.sub(r"[\s\"]", "", name).lower() for name in text.split(separator)]
    return header, numbers(lines[1:], len(header), ",".join(header), separator)
