"""Far fields of CST: sources (.ffs) and tables in text."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, Lines, from_db, numbers, refuse

_COLUMN = re.compile(r"(\w[\w .]*?)(?:\(\s*([^)]*?)\s*\))?\s*\[\s*([^\]]*?)\s*\]")
_OHM = 60.0  # |E|^2 / (60 P) is the gain of a peak field at 1 m: the wave impedance over 2 pi


def is_ffs(lines: Lines) -> bool:
    """Return whether a file is a far-field source."""
    return any(line.lstrip().startswith("//") and "E_Theta" in line for _, line in lines[:2000])


def read_ffs(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a far-field source: gains over what the antenna accepts."""
    powers: list[float] = []
    blocks: list[tuple[int, int]] = []
    at = 0
    while at < len(lines):
        line, text = lines[at]
        at += 1
        label = text.lower()
        if "power" in label and "frequency" in label and text.lstrip().startswith("//"):
            while at < len(lines) and not lines[at][1].lstrip().startswith("//"):
                powers += numbers(
                    lines[at][1], lines[at][0], len(lines[at][1].split()), "powers and frequency"
                )
                at += 1
        elif "#phi" in label and text.lstrip().startswith("//"):
            if at >= len(lines):
                refuse("the counts of azimuths and polar angles are missing; the file is cut short", line)
            counts = numbers(lines[at][1], lines[at][0], 2, "counts of azimuths and polar angles")
            start = at + 1
            while start < len(lines) and lines[start][1].lstrip().startswith("//"):
                start += 1
            blocks.append((start, int(counts[0] * counts[1])))
            at = start + blocks[-1][1]
    if len(powers) < 4 * len(blocks):
        refuse("radiated, accepted and stimulated power and the frequency are not all told; all four must be")
    for k, (start, count) in enumerate(blocks):
        rows = lines[start : start + count]
        if len(rows) < count:
            refuse(
                f"there are {len(rows)} rows of fields, must be {count}: the file is cut short",
                rows[-1][0] if rows else 0,
            )
        values = np.array(
            [numbers(text, line, 6, "phi, theta and both complex fields") for line, text in rows]
        )
        accepted, frequency = powers[4 * k + 1], powers[4 * k + 3]
        if not accepted > 0.0:
            refuse(f"got an accepted power of {accepted:g} W, must be more than 0")
        yield Block(
            theta_deg=values[:, 1],
            phi_deg=values[:, 0],
            field=(values[:, 2::2] + 1j * values[:, 3::2]) / np.sqrt(_OHM * accepted),
            lines=[line for line, _ in rows],
            frequency_hz=frequency,
        )


def is_cst(lines: Lines) -> bool:
    """Return whether a file is a table in text."""
    return bool(lines) and re.match(r"\s*Theta\s*\[deg", lines[0][1], re.IGNORECASE) is not None


def read_cst(lines: Lines) -> Iterator[Block]:
    """Yield the one pattern of a table in text, whose header names its columns and units."""
    if not is_cst(lines):
        refuse("it does not begin as a CST table does, with 'Theta [deg.]  Phi [deg.]  Abs(...)[...]'", 1)
    columns = [
        (name.strip(), what.strip(), unit.strip()) for name, what, unit in _COLUMN.findall(lines[0][1])
    ]
    rows = [(line, text) for line, text in lines[1:] if not set(text.strip()) <= {"-"}]
    if not rows:
        refuse("there are no rows below the header; the file is cut short")
    values = np.array([numbers(text, line, len(columns), lines[0][1].strip()) for line, text in rows])
    whole = [i for i, (name, what, _) in enumerate(columns) if name == "Abs" and what not in ("Theta", "Phi")]
    if not whole:
        refuse("no column is named Abs(Dir.), Abs(Gain), Abs(Realized Gain) or Abs(E)", 1)
    parts = {what: i for i, (name, what, _) in enumerate(columns) if name == "Abs"}
    phases = {what: i for i, (name, what, _) in enumerate(columns) if name == "Phase"}
    what = columns[whole[0]][1].lower()
    block = Block(
        theta_deg=values[:, 0],
        phi_deg=values[:, 1],
        lines=[line for line, _ in rows],
        quantity="directivity"
        if what.startswith(("dir", "e"))
        else "realised gain"
        if "real" in what
        else "gain",
    )
    if {"Theta", "Phi"} <= parts.keys() & phases.keys():
        sides = ("Theta", "Phi")
        powers = np.stack([_linear(values[:, parts[s]], columns[parts[s]][2]) for s in sides], axis=1)
        turns = np.radians(np.stack([values[:, phases[s]] for s in sides], axis=1))
        block.field = np.sqrt(powers) * np.exp(1j * turns)
    else:
        block.gain = _linear(values[:, whole[0]], columns[whole[0]][2])
    yield block


def _linear(values: np.ndarray, unit: str) -> np.ndarray:
    if unit.lower().startswith("db"):
        return from_db(values)
    return values**2 if "v" in unit.lower() else values
