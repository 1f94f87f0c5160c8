"""Output of NEC-2 programs: nec2c, 4nec2."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, Lines, from_db, numbers, refuse

_FREQUENCY = re.compile(r"FREQUENCY\s*[:=]\s*([\d.E+-]+)\s*MHZ", re.IGNORECASE)
_ROW = "THETA, PHI, three gains in dB, axial ratio, tilt, SENSE, then magnitude and phase of both fields"
_HEADER_LINES = 10


def is_nec(lines: Lines) -> bool:
    """Return whether a file is NEC's output."""
    return any("RADIATION PATTERNS" in line for _, line in lines)


def read_nec(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a file.

    The field's magnitudes have more digits than the gains, which tell their scale.
    """
    frequency, at = None, 0
    while at < len(lines):
        line = lines[at][1]
        at += 1
        found = _FREQUENCY.search(line)
        if found:
            frequency = float(found[1]) * 1e6
        if "RADIATION PATTERNS" in line:
            start = next(
                (i for i in range(at, min(at + _HEADER_LINES, len(lines))) if _begins(lines[i][1])), None
            )
            if start is None:
                refuse("the table of radiation patterns has no rows; the file is cut short", lines[at - 1][0])
            end = start
            while end < len(lines) and lines[end][1].strip() and _begins(lines[end][1]):
                end += 1
            yield _block(lines[start:end], frequency)
            at = end


def _begins(line: str) -> bool:
    return re.match(r"\s*-?\d", line) is not None


def _block(rows: Lines, frequency: float | None) -> Block:
    values = np.array([_row(text, line) for line, text in rows])
    gain = from_db(values[:, 2])
    field = values[:, [3, 5]] * np.exp(1j * np.radians(values[:, [4, 6]]))
    strength = np.sum(values[:, [3, 5]] ** 2, axis=1)
    if not np.sum(strength) > 0.0:
        refuse("every field is zero, so there is no pattern", rows[0][0])
    return Block(
        theta_deg=values[:, 0],
        phi_deg=values[:, 1],
        field=field * np.sqrt(np.sum(gain) / np.sum(strength)),
        lines=[line for line, _ in rows],
        frequency_hz=frequency,
    )


def _row(text: str, line: int) -> list[float]:
    words = [word for word in text.split() if not word.isalpha()]  # SENSE is blank at a null
    values = numbers(" ".join(words), line, 11, _ROW)
    return [values[0], values[1], values[4], *values[7:]]
