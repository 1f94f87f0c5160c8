"""From a file to a table over the sphere: which format it has, and what is refused."""

from __future__ import annotations

import os
import re
import zlib
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from nullpose.antenna.files.block import Block, FloatArray, Lines, gridded, refuse
from nullpose.antenna.files.cst import read_cst, read_ffs
from nullpose.antenna.files.csv_table import profile_of, read_csv
from nullpose.antenna.files.hfss import read_ffd
from nullpose.antenna.files.msi import read_msi
from nullpose.antenna.files.nec import read_nec
from nullpose.antenna.harmonics import fit, supported_degree
from nullpose.antenna.table import PatternTable
from nullpose.errors import ScenarioError
from nullpose.files import read_bytes

_MOST_BYTES = 60_000_000  # fields of several frequencies, 65,341 rows for 1 degree; compressed or not
_SAME_FREQUENCY = 1e-3
_OVER_FED = 10.0**0.05
_FLOOR, _MOST_FLOOR = 1e-8, 0.01  # of the peak, and of the sphere
_MISSED = 0.01  # root mean square that the degree which solvers take may miss, of the peak

FORMATS: dict[str, tuple[str, Callable[[Lines], Iterable[Block]]]] = {
    "nec": (r"RADIATION PATTERNS", read_nec),
    "ffs": (r"^//.*Re\(E_Theta\)", read_ffs),
    "cst": (r"\A\s*Theta\s*\[", read_cst),
    "ffd": (r"\A\s*(?:[-+\d.eE]+\s+){6}Freq", read_ffd),
    "csv": (r"\A[^\n]*theta_deg", read_csv),
    "msi": (r"^\s*(?:HORIZONTAL|VERTICAL)\s+\d+\s*$", read_msi),
}
"""By name: what a file of the format has in it, and what reads it."""


def read_pattern(
    path: str | os.PathLike[str],
    file_format: str | None = None,
    frequency_hz: float | None = None,
    *,
    estimate: bool = False,
) -> PatternTable:
    """Return the pattern that a file holds, as a table of gains over the whole sphere.

    Args:
        path: the file, which may be compressed by gzip.
        file_format: a key of ``FORMATS``; None to let the file tell it.
        frequency_hz: which of several frequencies, to a thousandth.
        estimate: whether two cuts are read as a guess, for looking at, where they do not tell the pattern;
            the notes then say why nothing should be solved with it.

    Raises:
        ScenarioError: the file cannot be read, or would mislead.
    """
    source = os.fspath(path)
    try:
        lines = _lines(Path(source))
        name = _format_of("\n".join(text for _, text in lines), file_format)
        block = _picked(list(FORMATS[name][1](lines)), frequency_hz)
        table = _scaled(gridded(block, f"{Path(source).name} ({name})"))
        doubts = [*filter(None, [block.doubt]), *_misleading(table)]
        if doubts and not (estimate and block.doubt):
            refuse(doubts[0])
        return replace(table, notes=(*table.notes, *(f"Not fit for solving: {doubt}" for doubt in doubts)))
    except ScenarioError as error:
        raise ScenarioError(error.faults, source) from None


def read_profile(path: str | os.PathLike[str]) -> tuple[FloatArray, FloatArray]:
    """Return angles from the axis, (n,), degrees, rising from 0 to 180, and linear gains there, (n,).

    Args:
        path: a CSV file of angle_deg and gain_dbi, which may be compressed by gzip.

    Raises:
        ScenarioError: the file cannot be read, or does not span the angles.
    """
    source = os.fspath(path)
    try:
        return profile_of(_lines(Path(source)))
    except ScenarioError as error:
        raise ScenarioError(error.faults, source) from None


def solid_angles(table: PatternTable) -> FloatArray:
    """Return each direction's share of the sphere, (t, p), for polynomials of the cosine exactly.

    Source: Clenshaw and Curtis, 1960: weights for equal steps of the polar angle.

    Args:
        table: any.
    """
    steps = len(table.theta_deg) - 1
    k = np.arange(1, steps // 2 + 1)
    parts = np.where(2 * k == steps, 1.0, 2.0) / (4.0 * k**2 - 1.0)
    bands = 1.0 - np.cos(2.0 * np.radians(np.outer(table.theta_deg, k))) @ parts
    bands[[0, -1]] *= 0.5
    return np.outer(bands / steps, np.full(len(table.phi_deg), 1.0 / len(table.phi_deg)))


def mean_gain(table: PatternTable) -> float:
    """Return a table's mean gain over the sphere: what is radiated of the power that is fed.

    Args:
        table: any.
    """
    return float(np.sum(solid_angles(table) * table.gain))


def _lines(path: Path) -> Lines:
    try:
        content = read_bytes(path, _MOST_BYTES)
        if content.startswith(b"\x1f\x8b"):
            unpacker = zlib.decompressobj(wbits=31)
            content = unpacker.decompress(content, _MOST_BYTES)
            if not unpacker.eof:
                refuse(
                    f"its content is cut short, or exceeds {_MOST_BYTES / 1e6:g} MB, the most that is read"
                )
    except ScenarioError:
        raise
    except (OSError, ValueError, zlib.error) as error:
        refuse(f"it cannot be read: {getattr(error, 'strerror', None) or error}")
    text = content.decode("utf-8-sig", errors="replace")
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    if not lines:
        refuse("the file is empty; must hold a radiation pattern")
    return lines


def _format_of(text: str, stated: str | None) -> str:
    known = ", ".join(FORMATS)
    if stated is not None and stated not in FORMATS:
        refuse(f"got the format {stated!r}, must be one of {known}")
    told = [name for name, (sign, _) in FORMATS.items() if re.search(sign, text, re.MULTILINE)]
    if stated is None and not told:
        refuse(
            f"it has the marks of no known format; must be one of {known}. Export the pattern in one of them"
        )
    if stated is not None and stated not in told:
        refuse(f"it is stated to be {stated}, and looks like {told[0] if told else f'none of {known}'}")
    return stated or told[0]


def _picked(blocks: list[Block], frequency_hz: float | None) -> Block:
    """Return the block of a frequency, or the only one."""
    if not blocks:
        refuse("there is no table of gains or fields in it; is the file cut short?")
    known = ", ".join(f"{b.frequency_hz:.10g}" for b in blocks[:20] if b.frequency_hz) or "not told"
    if frequency_hz is None and len(blocks) > 1:
        refuse(
            f"it has {len(blocks)} tables, at {known} Hz; state one frequency, by --frequency or frequency_hz"
        )
    if frequency_hz is None:
        return blocks[0]
    if not 0.0 < frequency_hz < np.inf:
        refuse(f"got the frequency {frequency_hz:g} Hz, must be more than 0 and finite")
    told = [replace(block, frequency_hz=block.frequency_hz or frequency_hz) for block in blocks]
    near = [b for b in told if abs((b.frequency_hz or 0.0) - frequency_hz) <= _SAME_FREQUENCY * frequency_hz]
    if not near:
        refuse(f"got the frequency {frequency_hz:.10g} Hz, must be one of the file's: {known} Hz")
    return near[0]


def _scaled(table: PatternTable) -> PatternTable:
    """Return the table, a directivity with an average of 1."""
    mean = mean_gain(table)
    if not mean > 0.0:
        refuse("no direction has any gain; is a column missing?")
    if table.quantity != "directivity":
        return table
    field = None if table.field is None else table.field / np.sqrt(mean)
    return replace(table, gain=table.gain / mean, field=field)


def _misleading(table: PatternTable) -> Iterable[str]:
    """Yield the faults of a table that is not a valid antenna pattern."""
    peak, mean = float(np.max(table.gain)), mean_gain(table)
    floor = float(np.sum(solid_angles(table)[table.gain <= _FLOOR * peak]))
    if floor > _MOST_FLOOR:
        yield (
            f"{100.0 * floor:.0f} % of all directions have no gain (a floor, such as -999.99 dB), and would "
            "be taken for nulls; state what the antenna does there"
        )
    if mean > _OVER_FED:
        yield (
            f"the average gain over the sphere is {10.0 * np.log10(mean):.1f} dB: it radiates more than "
            "it is fed; must be 0 dB at most. Is the unit right: dBi, dBd, linear?"
        )
    found = fit(table, supported_degree(table))
    missed = found.on_grid(np.radians(table.theta_deg), np.radians(table.phi_deg)) - table.gain
    part = float(np.sqrt(np.sum(solid_angles(table) * missed**2))) / peak
    if part > _MISSED:
        step = 180.0 / (len(table.theta_deg) - 1)
        yield (
            f"steps of {step:g} degrees do not follow the pattern: smoothed to the degree that they allow, "
            f"{found.degree}, it is off by {100.0 * part:.0f} % of the peak, must be 1 % at most; export "
            "finer steps, or fields with their phases"
        )
