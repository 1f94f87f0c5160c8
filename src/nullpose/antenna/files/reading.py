"""From a file to a table over the sphere: which format it has, and what is refused."""

from __future__ import annotations

import os
import re
import zlib
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np

from nullpose.antenna.files.block import Block, Lines, gridded, refuse, require
from nullpose.antenna.files.csv_table import profile_of, read_csv
from nullpose.antenna.files.far_fields import read_cst, read_ffd, read_ffs
from nullpose.antenna.files.msi import read_msi
from nullpose.antenna.files.nec import read_mininec, read_nec
from nullpose.antenna.harmonics import (
    HIGHEST_DEGREE,
    MOST_MISSED,
    FloatArray,
    Harmonics,
    fit,
    missed_share,
    supported_degree,
)
from nullpose.antenna.table import PatternTable, mean_gain, solid_angles
from nullpose.errors import ScenarioError
from nullpose.files import read_bytes

_OVER_FED = 10.0**0.05
_OVER_FED_ESTIMATE = 10.0**0.2  # sums of losses are no measurement
_FLOOR, _MOST_FLOOR = 1e-8, 0.01  # of the peak, and of the sphere
_STRONG = 1e-2  # of the peak: 20 dB below
_APART_DB, _MEDIANS, _ALONE = 0.08, 20.0, 1.5  # how far off a lone row is: at least, of others, of neighbours
_HIGH = 2.0  # of both neighbours: a beam that the steps follow is no higher


def require_antenna(table: PatternTable) -> None:
    """Refuse gains that no antenna has.

    Args:
        table: any.

    Raises:
        ScenarioError: it radiates more than it is fed, or many directions have no gain.
    """
    mean = mean_gain(table)
    floor = float(np.sum(solid_angles(table)[table.gain <= _FLOOR * np.max(table.gain)]))
    require(
        floor <= _MOST_FLOOR,
        f"{100.0 * floor:.0f} % of all directions have no gain (a floor, such as -999.99 dB), and would "
        "be taken for nulls; state what the antenna does there",
    )
    require(
        mean <= (_OVER_FED_ESTIMATE if table.caveat else _OVER_FED),
        f"the average gain over the sphere is {10.0 * np.log10(mean):.1f} dB: it radiates more than "
        "it is fed; must be 0 dB at most. Is the unit right: dBi, dBd, linear?",
    )


def require_fit(table: PatternTable) -> None:
    """Refuse a table that its harmonics do not follow, or of which a row does not fit those around it.

    Args:
        table: any.

    Raises:
        ScenarioError: its steps are too coarse, or its beam is too narrow; or with the row that fits least.
    """
    found = fit(table, supported_degree(table))
    part, step_deg = missed_share(table, found), 180.0 / (len(table.theta_deg) - 1)
    require(
        part <= MOST_MISSED,
        f"steps of {step_deg:g} degrees do not follow the pattern: smoothed to the degree that they allow, "
        f"{found.degree}, it is off by {100.0 * part:.0f} % of the peak, must be 1 % at most; export finer "
        f"steps, or fields with their phases; no degree above {HIGHEST_DEGREE} is taken",
    )
    if not table.caveat:  # which an estimate has
        _require_rows(table, found)


def _require_rows(table: PatternTable, found: Harmonics) -> None:
    """Refuse the row within 20 dB of the peak that fits those around it least, if it does not fit."""
    smooth = found.on_grid(np.radians(table.theta_deg), np.radians(table.phi_deg))
    gain, smooth = (np.maximum(values, _STRONG * np.max(table.gain)) for values in (table.gain, smooth))
    apart_db = np.abs(10.0 * np.log10(gain / smooth))
    typical_db = np.median(apart_db[gain == table.gain])
    alone = apart_db > np.maximum(max(_APART_DB, _MEDIANS * typical_db), _ALONE * _beside(apart_db))
    high = gain > _HIGH * _beside(gain)
    high[[0, -1]] = False  # a beam along the axis is one direction wide
    if np.any(bad := alone | high):
        where = np.arange(bad.size).reshape(bad.shape) if table.lines is None else table.lines
        step_deg, several = 180.0 / (len(gain) - 1), len(np.unique(where[bad])) > 1
        why = "is it written right?"
        if several:
            why = f"nor do others: steps of {step_deg:g} degrees are too coarse, or these are written wrong"
        row, column = np.unravel_index(np.argmax(np.where(bad, apart_db, 0.0)), bad.shape)
        refuse(
            f"theta = {table.theta_deg[row]:g}, phi = {table.phi_deg[column]:g} degrees has a gain of "
            f"{10.0 * np.log10(table.gain[row, column] + 1e-30):.2f} dBi, which does not fit those around "
            f"it; {why}",
            0 if table.lines is None else int(table.lines[row, column]),
        )


def _beside(values: FloatArray) -> FloatArray:
    """Return the larger of both neighbours along theta, (t, p), at the poles the one that there is."""
    inside = np.pad(values, ((1, 1), (0, 0)), mode="reflect")
    return np.asarray(np.maximum(inside[:-2], inside[2:]))


_MOST_BYTES = 60_000_000  # fields of several frequencies, 65,341 rows for 1 degree; compressed or not
_SAME_FREQUENCY = 1e-3
_MOST_NAMED = 8  # frequencies in a message
_OFF_DB = 0.5  # of a directivity's average
_NO_POWER = "The file has no power: its fields are scaled to an average of 1, which is directivity."
_OTHERS = "Other tables at this frequency do not cover the sphere; they are not read."
_TWO_CUTS = 'write two_cuts = "sum-of-losses" in [antenna] to solve with the estimate'

_FLAGS = re.MULTILINE | re.IGNORECASE
_THREE = r"[ \t]*(?:[-+\d.eE]+[ \t]+){2}[-+\d.eE]+[ \t]*"  # numbers, on a line

FORMATS: dict[str, tuple[str, Callable[[Lines], Iterable[Block]]]] = {
    "nec": (
        r"RADIATION PATTERNS|(?<!MINI-)NUMERICAL ELECTROMAGNETICS CODE|STRUCTURE SPECIFICATION",
        read_nec,
    ),
    "ffs": (r"^//.*Re\(E_Theta\)", read_ffs),
    "cst": (r"\A\s*Theta\s*\[.*Abs\(", read_cst),
    "ffd": (rf"\A{_THREE}\n{_THREE}$", read_ffd),
    "csv": (r"\A[^\n]*theta[^\n]*[,;\t]|\A[^\n]*[,;\t][^\n]*theta", read_csv),
    "mininec": (r"MININEC|^\*+ +PATTERN DATA +\*+", read_mininec),
    "msi": (r"^\s*(?:HORIZONTAL|VERTICAL)\s+\d+\s*$", read_msi),
}
"""By name: what a file of the format has in it, and what reads it."""
_OTHER_FORMATS = {
    r"^##\s*File Type:\s*Far Field": "a far field of FEKO (.ffe); write its table as csv",
    r"^\s*(V|H|R|L)?\s*dB\s+.*Tot\s*dB|^EZNEC": "a table of EZNEC; its file of NEC's output is read",
    r"\A\s*REVNUM|NSMA|WG16\.99": "two cuts as of NSMA; ask the maker for .msi",
    r"\A\s*Field data in cuts": "cuts of GRASP (.cut)",
    r"\A\s*(Az\.?|Alpha|Phi|El)[^\n]*\[": "a table of CST over other angles; export Theta and Phi",
    r"\A[^\n]*(elevation|azimuth|_el\b|\bel\b|\baz\b)[^\n]*[,;\t]": "a table over elevations: theta is 90 "
    "less the elevation, and phi grows from x towards y, counter-clockwise",
}


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
        estimate: whether two cuts are read as an estimate where they do not tell the pattern; a note says so.

    Raises:
        ScenarioError: the file cannot be read, or would mislead.
    """
    with _lines_of(path) as lines:
        name = _format_of("\n".join(text for _, text in lines), file_format)
        table = _picked(list(FORMATS[name][1](lines)), frequency_hz, f"{Path(path).name} ({name})")
        require(
            estimate or not table.caveat,
            f"{table.caveat}. Ask the maker for the whole pattern, or {_TWO_CUTS}",
        )
        require_antenna(table := _scaled(table))
        require_fit(table)
    return table


def read_profile(path: str | os.PathLike[str]) -> tuple[FloatArray, FloatArray, tuple[str, ...]]:
    """Return angles from the axis, (n,), degrees, rising from 0 to 180, linear gains there, (n,), and notes.

    Args:
        path: a CSV file of gain_dbi over angle_deg from the axis or over elevation_deg, or the cuts of .msi;
            it may be compressed by gzip.

    Raises:
        ScenarioError: the file cannot be read, or does not span the angles.
    """
    with _lines_of(path) as lines:
        if re.search(FORMATS["msi"][0], "\n".join(text for _, text in lines), _FLAGS):
            (cuts,) = read_msi(lines)
            require(not cuts.caveat, f"{cuts.caveat}; a profile is of an antenna that is the same all round")
            angle_deg, first = np.unique(cuts.theta_deg, return_index=True)
            gain, notes = cuts.gain[first], cuts.notes
        else:
            angle_deg, gain, notes = *profile_of(lines), ()
        theta_deg, phi_deg = np.linspace(0.0, 180.0, 721), np.arange(0.0, 360.0, 90.0)
        fine = np.repeat(np.interp(theta_deg, angle_deg, gain)[:, None], len(phi_deg), axis=1)
        require_antenna(PatternTable(theta_deg=theta_deg, phi_deg=phi_deg, gain=fine))
    return angle_deg, gain, tuple(filter(None, notes))


@contextmanager
def _lines_of(path: str | os.PathLike[str]) -> Iterator[Lines]:
    """Give the lines of a file that are not blank; faults that are found in them name the file."""
    try:
        content = _content(Path(path))
        encoding = "utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
        text = content.decode(encoding, errors="replace")
        lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
        require(lines, "the file is empty; must hold a radiation pattern")
        yield lines
    except ScenarioError as error:
        raise ScenarioError(error.faults, os.fspath(path)) from None


def _content(path: Path) -> bytes:
    unpacker = zlib.decompressobj(wbits=31)
    try:
        if not (content := read_bytes(path, _MOST_BYTES)).startswith(b"\x1f\x8b"):
            return content
        content = unpacker.decompress(content, _MOST_BYTES)
    except (OSError, ValueError, zlib.error) as error:
        refuse(f"it cannot be read: {getattr(error, 'strerror', None) or error}")
    most = f"{_MOST_BYTES / 1e6:g} MB, the most that is read"
    require(unpacker.eof, f"its content is cut short, or exceeds {most}")
    return content


def _format_of(text: str, asserted: str | None) -> str:
    formats = ", ".join(FORMATS)
    looks = [name for name, (sign, _) in FORMATS.items() if re.search(sign, text, _FLAGS)]
    other = next(
        (f": it looks like {name}" for sign, name in _OTHER_FORMATS.items() if re.search(sign, text, _FLAGS)),
        "",
    )
    require(
        asserted is not None or looks,
        f"it has the marks of no known format{other}; export the pattern in one of {formats}",
    )
    require(
        asserted in (None, *looks),
        f"got the format {asserted!r}, must be one of {formats}; it looks like {[*looks, 'none of them'][0]}",
    )
    return asserted or looks[0]


def _picked(blocks: list[Block], frequency_hz: float | None, source: str) -> PatternTable:
    """Return the table of a frequency, or of the only one."""
    require(blocks, "there is no table of gains or fields in it; is the file cut short?")
    each_hz = [block.frequency_hz or frequency_hz or 0.0 for block in blocks]
    frequencies = [f"{hz:.10g}" for hz in dict.fromkeys(each_hz) if hz]
    more = f" and {len(frequencies) - _MOST_NAMED} more" if len(frequencies) > _MOST_NAMED else ""
    listed = f"{', '.join(frequencies[:_MOST_NAMED]) or 'unknown frequencies, in'} Hz{more}"
    require(
        frequency_hz is not None or len(set(each_hz)) == 1,
        f"it has {len(blocks)} tables, at {listed}; state one frequency, by --frequency or frequency_hz",
    )
    wanted_hz = each_hz[0] if frequency_hz is None else frequency_hz
    nearest_hz = min(each_hz, key=lambda hz: abs(hz - wanted_hz))
    require(
        frequency_hz is None or abs(nearest_hz - wanted_hz) < _SAME_FREQUENCY * wanted_hz,
        f"got the frequency {wanted_hz:.10g} Hz, must be one of the file's: {listed}",
    )
    whole, faults = [], []
    for block in (block for block, hz in zip(blocks, each_hz, strict=True) if hz == nearest_hz):
        try:
            whole.append(gridded(replace(block, frequency_hz=nearest_hz), source))
        except ScenarioError as error:
            faults.append(error)
    if not whole:
        raise faults[0]
    starts = ", ".join(str(np.min(table.lines)) for table in whole if table.lines is not None)
    require(
        len(whole) == 1,
        f"it has {len(whole)} tables at one frequency, from the lines {starts} on; keep one of them",
    )
    return replace(whole[0], notes=(*whole[0].notes, *([_OTHERS] if faults else [])))


def _scaled(table: PatternTable) -> PatternTable:
    """Return the table, a directivity or a field without a power with an average of 1."""
    mean = mean_gain(table)
    require(mean > 0.0, "no direction has any gain; is a column missing?")
    if table.quantity not in ("directivity", "field"):
        return table
    mean_db, note = 10.0 * np.log10(mean), _NO_POWER
    if table.quantity == "directivity":
        note = f"Its directivity averages to {mean_db:.2f} dB over the sphere; it is scaled to 0 dB."
        require(
            abs(mean_db) <= _OFF_DB,
            f"its directivity averages to {mean_db:.1f} dB over the sphere, must be 0 dB. Is the unit right?",
        )
    return replace(
        table,
        gain=table.gain / mean,
        field=None if table.field is None else table.field / np.sqrt(mean),
        quantity="directivity",
        notes=(*table.notes, *([note] if table.quantity == "field" or abs(mean_db) >= 0.01 else [])),
    )
