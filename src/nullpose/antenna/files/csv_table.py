"""Comma-separated tables: gains, or complex fields, and profiles."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, Lines, from_db, numbers, refuse

_GAIN = ("theta_deg", "phi_deg", "gain_dbi")
_FIELD = ("theta_deg", "phi_deg", "re_theta", "im_theta", "re_phi", "im_phi")
_PROFILE = ("angle_deg", "gain_dbi")


def _header(lines: Lines) -> tuple[str, ...]:
    return tuple(word.strip().strip('"').lower() for word in lines[0][1].split(",")) if lines else ()


def is_csv(lines: Lines) -> bool:
    """Return whether a file has the header of a table of directions."""
    return {"theta_deg", "phi_deg"} <= set(_header(lines))


def read_csv(lines: Lines) -> Iterator[Block]:
    """Yield the one pattern of a table."""
    header = _header(lines)
    wanted = next((names for names in (_FIELD, _GAIN) if set(names) <= set(header)), None)
    if wanted is None:
        refuse(
            f"got the header {','.join(header)[:80]!r}, must hold {','.join(_GAIN)} or {','.join(_FIELD)}", 1
        )
    values = _columns(lines, header, wanted)
    block = Block(theta_deg=values[:, 0], phi_deg=values[:, 1], lines=[line for line, _ in lines[1:]])
    if wanted == _FIELD:
        block.field = values[:, 2::2] + 1j * values[:, 3::2]
    else:
        block.gain = from_db(values[:, 2])
    yield block


def profile_of(lines: Lines) -> tuple[np.ndarray, np.ndarray]:
    """Return angles from the axis [deg], rising, and linear gains.

    Args:
        lines: of a CSV file of angle_deg and gain_dbi.
    """
    header = _header(lines)
    if not set(_PROFILE) <= set(header):
        refuse(f"got the header {','.join(header)[:80]!r}, must hold {','.join(_PROFILE)}", 1)
    values = _columns(lines, header, _PROFILE)
    angle, order = np.unique(values[:, 0], return_index=True)
    if len(angle) < len(values):
        refuse("an angle is told twice; keep one")
    if angle[0] != 0.0 or angle[-1] != 180.0:
        refuse(f"angles go from {angle[0]:g} to {angle[-1]:g} degrees, must go from 0 to 180")
    return angle, from_db(values[order, 1])


def _columns(lines: Lines, header: tuple[str, ...], wanted: tuple[str, ...]) -> np.ndarray:
    if len(lines) < 2:
        refuse("there are no rows below the header; the file is cut short")
    places = [header.index(name) for name in wanted]
    rows = []
    for line, text in lines[1:]:
        cells = text.split(",")
        if len(cells) != len(header):
            refuse(f"got {len(cells)} columns, must be {len(header)} as in the header", line)
        rows.append(numbers(" ".join(cells[at] or "?" for at in places), line, len(wanted), ",".join(wanted)))
    return np.array(rows)
