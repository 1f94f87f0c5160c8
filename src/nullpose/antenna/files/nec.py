"""Output of NEC: nec2c, 4nec2, EZNEC; and of MININEC."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, Lines, from_db, numbers, require

_FREQUENCY = re.compile(r"FREQUENCY\s*(?:\(MHZ\)\s*[:=]|[:=](?=.*MHZ))\s*([^\sM]+)", re.IGNORECASE)
_ROW = "theta, phi, three gains in dB, axial ratio, tilt, then magnitude and phase of both fields"
_STRONG = 1e-3  # of the strongest; weaker ones have few digits
_HEADINGS = 8  # lines, and more than there are between the title and the first row
_SENSE = re.compile(r"\b(?:LINEAR|RIGHT|LEFT)\b")  # blank at an exact null


def read_nec(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a file. Gains have two digits and fields five: the gains tell the fields' scale.

    Args:
        lines: of the file.

    Raises:
        ScenarioError: a table is faulty.
    """
    without = (
        "this is output of NEC without a pattern; add an RP card to the input, such as "
        "RP 0 37 73 1000 0 0 5 5 for the whole sphere, and run NEC again"
    )
    for line, heading, rows, frequency_hz in _tables(lines, "RADIATION PATTERNS", without):
        values = numbers(rows, 11, _ROW)
        gain = from_db(values[:, 4])
        size = values[:, [7, 9]] * (gain > 0.0)[:, None]  # at a floor the field has rounding errors left
        strength = np.sum(size**2, axis=1)
        strong = (strength > _STRONG * np.max(strength)) & (gain > 0.0)
        require(np.any(strong), "the table has no field but zero, so there is no pattern", line)
        scale = np.median(gain[strong] / strength[strong])
        yield Block(
            theta_deg=values[:, 0],
            phi_deg=values[:, 1],
            gain=gain,
            field=size * np.exp(1j * np.radians(values[:, [8, 10]])) * np.sqrt(scale),
            lines=np.array([number for number, _ in rows]),
            frequency_hz=frequency_hz,
            quantity="directivity" if "DIRECTIVE" in heading else "gain",
        )


def read_mininec(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a file of MININEC, which are gains in dBi without phases.

    Args:
        lines: of the file.

    Raises:
        ScenarioError: a table is faulty, or there is none.
    """
    without = "this is output of MININEC without a pattern; let it compute the far field, in dBi all round"
    for _, _, rows, frequency_hz in _tables(lines, "PATTERN DATA", without):
        values = numbers(rows, 5, "zenith and azimuth angle, and three gains in dBi: not fields in V/m")
        yield Block(
            theta_deg=values[:, 0],
            phi_deg=values[:, 1],
            gain=from_db(values[:, 4]),
            lines=np.array([number for number, _ in rows]),
            frequency_hz=frequency_hz,
        )


def _tables(lines: Lines, title: str, without: str) -> Iterator[tuple[int, str, Lines, float | None]]:
    """Yield the line, the heading, the rows and the frequency of each table below a title, one or more."""
    require(any(title in text for _, text in lines), without)
    frequency_hz = None
    for at, (line, text) in enumerate(lines):
        if found := _FREQUENCY.search(text):
            frequency_hz = 1e6 * float(numbers([(line, found[1])], 1, "a frequency in MHz")[0, 0])
        below = range(at + 1, min(at + _HEADINGS, len(lines))) if title in text else range(0)
        if (start := next((i for i in below if _is_row(lines[i][1])), None)) is None:
            continue  # no title, or averages alone
        end = next((i for i in range(start, len(lines)) if not _is_row(lines[i][1])), len(lines))
        rows = [(number, _SENSE.sub(" ", row)) for number, row in lines[start:end]]
        yield line, "".join(row for _, row in lines[at:start]), rows, frequency_hz


def _is_row(text: str) -> bool:
    return re.match(r"\s*-?\.?\d\S*\s+-?\.?\d", text) is not None
