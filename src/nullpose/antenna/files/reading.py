"""From a file to a table over the sphere: which format it is, and what is refused."""

from __future__ import annotations

import os
import zlib
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nullpose.antenna.files.block import Block, Lines, gridded, picked, refuse
from nullpose.antenna.files.cst import is_cst, is_ffs, read_cst, read_ffs
from nullpose.antenna.files.csv_table import is_csv, profile_of, read_csv
from nullpose.antenna.files.emane import is_emane, read_emane
from nullpose.antenna.files.hfss import is_ffd, read_ffd
from nullpose.antenna.files.msi import is_msi, read_msi
from nullpose.antenna.files.nec import is_nec, read_nec
from nullpose.antenna.table import PatternTable
from nullpose.errors import ScenarioError
from nullpose.files import read_bytes

_MOST_BYTES = 60_000_000  # a table of 1 degree in fields has 65,341 rows
_MOST_OVER_FED_DB = 0.5
_MOST_FLOOR = 0.01  # of the sphere

FORMATS: dict[str, tuple[Callable[[Lines], bool], Callable[[Lines], Iterator[Block]]]] = {
    "nec": (is_nec, read_nec),
    "ffs": (is_ffs, read_ffs),
    "cst": (is_cst, read_cst),
    "emane": (is_emane, read_emane),
    "ffd": (is_ffd, read_ffd),
    "csv": (is_csv, read_csv),
    "msi": (is_msi, read_msi),
}
"""By name: what tells a format, and what reads it."""


def read_pattern(
    path: str | os.PathLike[str],
    format: str | None = None,  # noqa: A002
    frequency_hz: float | None = None,
    *,
    estimate: bool = False,
) -> PatternTable:
    """Return the pattern that a file holds, as a table of gains over the whole sphere.

    Args:
        path: the file, which may be compressed by gzip.
        format: a key of ``FORMATS``; None to let the file tell it.
        frequency_hz: which of several frequencies.
        estimate: whether two cuts are made a pattern even where that is a guess, for looking at.

    Raises:
        ScenarioError: the file cannot be read, or would mislead.
    """
    source = os.fspath(path)
    try:
        lines = _lines(Path(source))
        name = _format_of(lines, format)
        reader = FORMATS[name][1]
        blocks = read_msi(lines, estimate) if name == "msi" else reader(lines)
        table = gridded(picked(blocks, frequency_hz), f"{Path(source).name} ({name})")
        return _honest(table, estimate)
    except ScenarioError as error:
        raise ScenarioError(error.faults, source) from None


def read_profile(path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return angles from the axis, (n,), degrees, from 0 to 180, and linear gains there, (n,).

    Args:
        path: a CSV file of angle_deg and gain_dbi.

    Raises:
        ScenarioError: the file cannot be read, or does not span the angles.
    """
    source = os.fspath(path)
    try:
        return profile_of(_lines(Path(source)))
    except ScenarioError as error:
        raise ScenarioError(error.faults, source) from None


def mean_gain(table: PatternTable) -> float:
    """Return a table's mean gain over the sphere: what is radiated of the power that is fed.

    Args:
        table: any.
    """
    weight = _solid_angles(table)
    return float(np.sum(weight * table.gain) / np.sum(weight))


def _solid_angles(table: PatternTable) -> NDArray[np.float64]:
    edges = np.concatenate([[0.0], 0.5 * (table.theta_deg[1:] + table.theta_deg[:-1]), [180.0]])
    bands = -np.diff(np.cos(np.radians(edges)))[:, None]
    return np.asarray(bands * np.ones(len(table.phi_deg)) / len(table.phi_deg) / 2.0)


def _lines(path: Path) -> Lines:
    try:
        content = read_bytes(path, _MOST_BYTES)
        if content[:2] == b"\x1f\x8b":
            unpacked = zlib.decompressobj(wbits=31)
            content = unpacked.decompress(content, _MOST_BYTES)
            if unpacked.unconsumed_tail:
                refuse(f"it is larger than {_MOST_BYTES / 1e6:g} MB once unpacked, the most that is read")
    except (OSError, ValueError, zlib.error) as error:
        refuse(f"it cannot be read: {getattr(error, 'strerror', None) or error}")
    text = content.decode("utf-8-sig", errors="replace")
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    if not lines:
        refuse("the file is empty; must hold a pattern")
    return lines


def _format_of(lines: Lines, stated: str | None) -> str:
    known = ", ".join(FORMATS)
    if stated is not None and stated not in FORMATS:
        refuse(f"got format {stated!r}, must be one of {known}")
    told = next((name for name, (is_format, _) in FORMATS.items() if is_format(lines)), None)
    if stated is None and told is None:
        refuse(f"the format cannot be told; must be one of {known}: state it as format")
    if stated is not None and told not in (None, stated):
        refuse(f"it is stated to be {stated}, but it is {told}; state {told}, or nothing")
    return stated or str(told)


def _honest(table: PatternTable, estimate: bool) -> PatternTable:
    """Return the table, or refuse what would mislead; scale a directivity to a mean of 1."""
    weight = _solid_angles(table)
    floor = float(np.sum(weight[table.gain <= 0.0]))
    if floor > _MOST_FLOOR:
        refuse(
            f"{100.0 * floor:.0f} % of all directions have no gain at all (a floor, such as -999.99 dB), "
            "which would be taken for nulls; fill in what the antenna does there"
        )
    mean = mean_gain(table)
    if not mean > 0.0:
        refuse("no direction has any gain")
    if table.quantity == "directivity":
        field = None if table.field is None else table.field / np.sqrt(mean)
        return replace(table, gain=table.gain / mean, field=field)
    over_db = 10.0 * np.log10(mean)
    if over_db > _MOST_OVER_FED_DB and not estimate:
        refuse(
            f"the mean gain over the sphere is {over_db:.1f} dB: the antenna would radiate more than it is "
            "fed; must be 0 dB at most. Is the unit right, dBd, dBi or linear?"
        )
    return table
