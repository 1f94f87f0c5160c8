"""Far fields of HFSS: .ffd."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, Lines, numbers, refuse

_NOTE = "The file has no power: fields are scaled to a mean gain of 1, which is directivity."


def is_ffd(lines: Lines) -> bool:
    """Return whether a file begins as a .ffd does: two ranges of angles, then frequencies."""
    heads = [line.split() for _, line in lines[:3]]
    return (
        len(heads) == 3
        and len(heads[0]) == len(heads[1]) == 3
        and bool(heads[2])
        and heads[2][0].lower().startswith("freq")
    )


def read_ffd(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a file, polar angles in the outer loop."""
    if len(lines) < 4 or not is_ffd(lines):
        refuse(
            "it does not begin as a .ffd file does: two ranges 'start stop count', then 'Frequencies n'", 1
        )
    ranges = [numbers(text, line, 3, "an angle's start, stop and count") for line, text in lines[:2]]
    theta, phi = (np.linspace(low, high, max(1, int(count))) for low, high, count in ranges)
    grid = [axis.ravel() for axis in np.meshgrid(theta, phi, indexing="ij")]
    at, frequency = 3, None
    while at < len(lines):
        line, text = lines[at]
        if text.lower().startswith("freq"):
            frequency = numbers(text.split(maxsplit=1)[-1], line, 1, "a frequency in Hz")[0]
            at += 1
            continue
        rows = lines[at : at + len(grid[0])]
        if len(rows) < len(grid[0]):
            refuse(
                f"there are {len(rows)} rows of fields, must be {len(grid[0])}: the file is cut short", line
            )
        values = np.array(
            [numbers(text, line, 4, "real and imaginary part of both fields") for line, text in rows]
        )
        yield Block(
            theta_deg=grid[0],
            phi_deg=grid[1],
            field=values[:, ::2] + 1j * values[:, 1::2],
            lines=[line for line, _ in rows],
            frequency_hz=frequency,
            quantity="directivity",
            notes=[_NOTE],
        )
        at += len(rows)
