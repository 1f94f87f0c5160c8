"""Comma-separated tables: gains, or complex fields, over directions; and profiles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from nullpose.antenna.files.block import Block, FloatArray, Lines, from_db, numbers, refuse

_GAIN = ("theta_deg", "phi_deg", "gain_dbi")
_FIELD = ("theta_deg", "phi_deg", "re_theta", "im_theta", "re_phi", "im_phi")
_PROFILE = ("angle_deg", "gain_dbi")


def read_csv(lines: Lines) -> Iterator[Block]:
    """Yield the one pattern of a table.

    Args:
        lines: of the file.

    Raises:
        ScenarioError: the table is faulty.
    """
    values = _columns(lines, (_FIELD, _GAIN))
    has_field = values.shape[1] == len(_FIELD)
    yield Block(
        theta_deg=values[:, 0],
        phi_deg=values[:, 1],
        gain=None if has_field else from_db(values[:, 2]),
        field=values[:, 2::2] + 1j * values[:, 3::2] if has_field else None,
        lines=[line for line, _ in lines[1:]],
    )


def profile_of(lines: Lines) -> tuple[FloatArray, FloatArray]:
    """Return angles from the axis, (n,), degrees, rising from 0 to 180, and linear gains there, (n,).

    Args:
        lines: of the file.

    Raises:
        ScenarioError: the table is faulty, or does not span the angles.
    """
    values = _columns(lines, (_PROFILE,))
    values = values[np.argsort(values[:, 0])]
    angle = values[:, 0]
    if len(angle) < 2 or angle[0] != 0.0 or angle[-1] != 180.0 or not np.all(np.diff(angle) > 0.0):
        told = ", ".join(f"{x:g}" for x in (*angle[:2], angle[-1]))
        refuse(f"angles are {told} degrees (first two, last), must go from 0 to 180, each given once")
    return angle, from_db(values[:, 1])


def _columns(lines: Lines, kinds: Sequence[tuple[str, ...]]) -> FloatArray:
    """Return the columns of the first kind that the header has, (n, columns)."""
    header = [word.strip().strip('"').lower() for word in lines[0][1].split(",")]
    wanted = next((kind for kind in kinds if set(kind) <= set(header)), None)
    if wanted is None:
        allowed = " or ".join(",".join(kind) for kind in kinds)
        refuse(f"got the header {lines[0][1].strip()[:60]!r}, must have {allowed}", lines[0][0])
    values = numbers(lines[1:], len(header), ",".join(header))
    return values[:, [header.index(name) for name in wanted]]
