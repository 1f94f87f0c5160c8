"""Far fields of CST: sources (.ffs), and tables in text."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, FloatArray, Lines, from_db, numbers, refuse, rows_of

_OHM = 376.730313 / (2.0 * np.pi)  # |E|^2 over this and the power is the gain of a peak field at 1 m
_HEADING = re.compile(r"([^\[\]]+)\[([^\]]*)\]")
_LONGEST = 1000  # characters of a heading that are looked at
_PARTS = ("abs(theta)", "abs(phi)")


def read_ffs(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a far-field source: gains over the power that the antenna accepts.

    Args:
        lines: of the file, whose sections begin with lines of "//".

    Raises:
        ScenarioError: a table is faulty, or there is no power.
    """
    heads = [
        (i, line, text.lower()) for i, (line, text) in enumerate(lines) if text.lstrip().startswith("//")
    ]
    found = {
        word: [i + 1 for i, _, text in heads if word in text] for word in ("power", "#phi", "re(e_theta)")
    }
    blocks = len(found["re(e_theta)"])
    if not found["power"] or len(found["#phi"]) != blocks:
        refuse("the powers, or the counts of azimuths and polar angles, are missing; is the file cut short?")
    what = "radiated, accepted and stimulated power in W, the frequency in Hz, of each pattern a line each"
    powers = rows_of(lines, found["power"][0], 4 * blocks, 1, what).reshape(-1, 4)
    for power, at, start in zip(powers, found["#phi"], found["re(e_theta)"], strict=True):
        count = float(np.prod(rows_of(lines, at, 1, 2, "the counts of azimuths and polar angles")))
        values = rows_of(lines, start, count, 6, "phi, theta, real and imaginary part of both fields")
        if not power[1] > 0.0:
            refuse(
                f"got an accepted power of {power[1]:g} W, must be more than 0", lines[found["power"][0]][0]
            )
        yield Block(
            theta_deg=values[:, 1],
            phi_deg=values[:, 0],
            field=(values[:, 2::2] + 1j * values[:, 3::2]) / np.sqrt(_OHM * power[1]),
            lines=[line for line, _ in lines[start : start + len(values)]],
            frequency_hz=float(power[3]),
        )


def read_cst(lines: Lines) -> Iterator[Block]:
    """Yield the one pattern of a table in text, whose heading names columns and units.

    Args:
        lines: of the file.

    Raises:
        ScenarioError: the table is faulty, or has no column of a gain, a directivity or a field.
    """
    heading = [
        (re.sub(r"\s", "", name).lower(), unit.strip().lower())
        for name, unit in _HEADING.findall(lines[0][1][:_LONGEST])
    ]
    columns = {name: i for i, (name, _) in enumerate(heading)}
    total = next((name for name in columns if re.fullmatch(r"abs\((dir|gain|real|rlzd|e).*\)", name)), "")
    if not total or "theta" not in columns or "phi" not in columns:
        refuse(
            "must have columns Theta, Phi and Abs(Dir.), Abs(Gain), Abs(Realized Gain) or Abs(E)", lines[0][0]
        )
    rows = [row for row in lines[1:] if set(row[1].strip()) != {"-"}]
    values = numbers(rows, len(heading), ", ".join(name for name, _ in heading))
    phases = [part.replace("abs", "phase") for part in _PARTS]
    field = None
    if columns.keys() >= {*_PARTS, *phases}:
        powers = np.stack([_power(values, heading, columns[part]) for part in _PARTS], axis=1)
        field = np.sqrt(powers) * np.exp(1j * np.radians(values[:, [columns[phase] for phase in phases]]))
    yield Block(
        theta_deg=values[:, columns["theta"]],
        phi_deg=values[:, columns["phi"]],
        gain=_power(values, heading, columns[total]),
        field=field,
        lines=[line for line, _ in rows],
        quantity={"d": "directivity", "e": "directivity", "r": "realised gain"}.get(total[4], "gain"),
    )


def _power(values: FloatArray, heading: list[tuple[str, str]], column: int) -> FloatArray:
    """Return a column in decibels, in V/m or linear as linear power."""
    unit = heading[column][1]
    if unit.startswith("db"):
        return from_db(values[:, column])
    return np.abs(values[:, column]) ** (2 if "v" in unit else 1)
