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
from nullpose.antenna.files.checks import require_antenna, require_fit
from nullpose.antenna.files.cst import read_cst, read_ffs
from nullpose.antenna.files.csv_table import profile_of, read_csv
from nullpose.antenna.files.hfss import read_ffd
from nullpose.antenna.files.msi import read_msi
from nullpose.antenna.files.nec import read_mininec, read_nec
from nullpose.antenna.harmonics import FloatArray
from nullpose.antenna.table import PatternTable, mean_gain
from nullpose.errors import ScenarioError
from nullpose.files import read_bytes

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
