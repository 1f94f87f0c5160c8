"""Far fields of HFSS: .ffd."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, Lines, numbers, rows_of

_NOTE = "The file has no power: its fields are scaled to an average of 1, which is directivity."


def read_ffd(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a file, polar angles in the outer loop.

    Args:
        lines: of the file: first, last and count of polar angles, the same of azimuths, then frequencies.

    Raises:
        ScenarioError: a table is faulty.
    """
    ranges = numbers(lines[:2], 3, "an angle's first, last and count")
    count, frequency_hz, at = ranges[0, 2] * ranges[1, 2], None, 2
    while at < len(lines):
        number, text = lines[at]
        if text.lstrip().lower().startswith("freq"):  # "Frequencies n", "Freq n", "Frequency f"
            words = text.split()
            frequency_hz = float(numbers([(number, " ".join(words[1:]))], 1, "a frequency in Hz")[0, 0])
            at += 1
            continue
        values = rows_of(lines, at, count, 4, "real and imaginary part of the fields along theta and phi")
        angles = [np.linspace(first, last, int(steps)) for first, last, steps in ranges]
        theta, phi = np.meshgrid(*angles, indexing="ij")
        yield Block(
            theta_deg=theta.ravel(),
            phi_deg=phi.ravel(),
            field=values[:, ::2] + 1j * values[:, 1::2],
            lines=[line for line, _ in lines[at : at + len(values)]],
            frequency_hz=frequency_hz,
            quantity="directivity",
            notes=(_NOTE,),
        )
        at += len(values)
