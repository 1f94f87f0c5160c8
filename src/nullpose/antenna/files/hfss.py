"""Far fields of HFSS: .ffd."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, Lines, numbers, power_of, require, rows_of

_MOST_ANGLES = 3601  # steps of .1 degrees


def read_ffd(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a file, polar angles in the outer loop.

    Args:
        lines: of the file: first, last and count of polar angles, the same of azimuths, then the frequencies,
            which older files leave out where there is one.

    Raises:
        ScenarioError: a table is faulty, or there are fewer than announced.
    """
    ranges = numbers(lines[:2], 3, "an angle's first, last and count")
    for (line, _), steps in zip(lines, ranges[:, 2], strict=False):
        require(
            1.0 <= steps <= _MOST_ANGLES and steps % 1.0 == 0.0,
            f"got {steps:g} angles, must be a whole number from 1 to {_MOST_ANGLES}",
            line,
        )
    theta, phi = np.meshgrid(
        *[np.linspace(first, last, int(steps)) for first, last, steps in ranges], indexing="ij"
    )
    at, found, announced, frequency_hz = 2, 0, None, None
    while at < len(lines):
        if heading := _frequency(lines, at):
            word, number = heading
            at += 1
            if word == "frequencies" or _frequency(lines, at):
                announced = number
                continue
            frequency_hz = number
        values = rows_of(
            lines, at, theta.size, 4, "real and imaginary part of the fields along theta and phi"
        )
        field = values[:, ::2] + 1j * values[:, 1::2]
        yield Block(
            theta_deg=theta.ravel(),
            phi_deg=phi.ravel(),
            gain=power_of(field),
            field=field,
            lines=np.array([line for line, _ in lines[at : at + len(values)]]),
            frequency_hz=frequency_hz,
            quantity="field",
        )
        at, found = at + len(values), found + 1
    require(announced in (None, found), f"{announced} frequencies are announced and {found} follow")


def _frequency(lines: Lines, at: int) -> tuple[str, float] | None:
    """Return the word and the number of a line such as "Frequencies 3" or "Frequency 2.4e9", or None."""
    line, text = lines[at] if at < len(lines) else (0, "")
    word, _, rest = text.strip().partition(" ")
    if not re.match("freq", word, re.IGNORECASE):
        return None
    return word.lower(), float(numbers([(line, rest)], 1, "a count of frequencies, or one in Hz")[0, 0])
