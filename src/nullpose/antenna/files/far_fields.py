"""Far fields of CST, sources (.ffs) and tables in text, and of HFSS (.ffd)."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import (
    DBD,
    SAME_FIELD,
    Block,
    Lines,
    from_db,
    numbers,
    power_of,
    require,
    rows_of,
)
from nullpose.antenna.harmonics import FloatArray

_OHM = 376.730313 / (2.0 * np.pi)  # |E|^2 over this and the power is the gain of a peak field at 1 m
_HEADING = re.compile(r"([^\[\]]+)\[([^\]]*)\]")
_LONGEST = 1000  # characters of a heading that are looked at
_PARTS = ("abs(theta)", "abs(phi)")
_TOTAL = re.compile(r"abs\((dir|gain|real|rlzd|grlz|e\)).*")
_QUANTITIES = {
    "di": "directivity",
    "ga": "gain",
    **dict.fromkeys(("re", "rl", "gr"), "realised gain"),
    "e)": "field",
}
_DECIBELS = {"db": 0.0, "dbi": 0.0, "dbd": DBD}
_AXES = {"zaxis": (0.0, 0.0, 1.0), "xaxis": (1.0, 0.0, 0.0)}
_UNALIGNED = 1e-6
_TOLERANCE = 1.01  # of powers that must rise from radiated to stimulated


def read_ffs(lines: Lines) -> Iterator[Block]:
    """Yield the patterns of a far-field source: gains over the power that the antenna accepts.

    Args:
        lines: of the file, whose sections begin with lines of "//".

    Raises:
        ScenarioError: a table is faulty, there is no power, or the source is turned.
    """
    heads = [(i, text.lower()) for i, (_, text) in enumerate(lines) if text.lstrip().startswith("//")]
    words = ("#freq", "power", "#phi", "re(e_theta)", *_AXES)
    found = {word: [i + 1 for i, text in heads if word in text] for word in words}
    blocks = len(found["re(e_theta)"])
    require(
        found["power"] and len(found["#phi"]) == blocks,
        "the powers, or the counts of azimuths and polar angles, are missing; is the file cut short?",
    )
    for at in found["#freq"]:
        announced = rows_of(lines, at, 1, 1, "a count of frequencies")[0, 0]
        require(announced == blocks, f"{announced:g} frequencies are announced and {blocks} follow")
    for word, straight in _AXES.items():
        for at in found[word]:
            axis = rows_of(lines, at, 1, 3, f"the {word} of the source")[0]
            got, allowed = (" ".join(f"{x:g}" for x in each) for each in (axis, straight))
            require(
                np.max(np.abs(axis - straight)) <= _UNALIGNED,
                f"its {word} is {got}, must be {allowed}: the source is turned; export it unturned",
                lines[at][0],
            )
    what = "radiated, accepted and stimulated power in W, the frequency in Hz, of each pattern a line each"
    powers = rows_of(lines, found["power"][0], 4 * blocks, 1, what).reshape(-1, 4)
    for power, at, start in zip(powers, found["#phi"], found["re(e_theta)"], strict=True):
        count = float(np.prod(rows_of(lines, at, 1, 2, "the counts of azimuths and polar angles")))
        values = rows_of(lines, start, count, 6, "phi, theta, real and imaginary part of both fields")
        require(
            power[1] > 0.0 and np.all(power[:2] <= _TOLERANCE * power[1:3]),
            f"got {power[0]:g} W radiated, {power[1]:g} W accepted and {power[2]:g} W stimulated; must "
            "be more than 0, each at most the next",
            lines[found["power"][0]][0],
        )
        field = (values[:, 2::2] + 1j * values[:, 3::2]) / np.sqrt(_OHM * power[1])
        yield Block(
            theta_deg=values[:, 1],
            phi_deg=values[:, 0],
            gain=power_of(field),
            field=field,
            lines=np.array([line for line, _ in lines[start : start + len(values)]]),
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
        (re.sub(r"\s", "", name).lower(), re.sub(r"\s", "", unit).lower())
        for name, unit in _HEADING.findall(lines[0][1][:_LONGEST])
    ]
    units, columns = dict(heading), {name: i for i, (name, _) in enumerate(heading)}
    total = next(filter(_TOTAL.fullmatch, columns), "")
    require(
        total and all(units.get(name, "").startswith("deg") for name in ("theta", "phi")),
        "must have columns Theta [deg.], Phi [deg.] and Abs(Dir.), Abs(Gain), Abs(Realized Gain), "
        "Abs(Grlz) or Abs(E)",
        lines[0][0],
    )
    rows = [row for row in lines[1:] if set(row[1].strip()) != {"-"}]
    values = numbers(rows, len(heading), ", ".join(columns))
    quantity, phases = _QUANTITIES[total[4:6]], [part.replace("abs", "phase") for part in _PARTS]
    if quantity == "field" and units[total].startswith("db"):  # over whatever, such as 1 V/m
        of_field = [i for name, i in columns.items() if name in (total, *_PARTS)]
        values[:, of_field] -= np.max(values[:, columns[total]])
    power = {
        name: _power(values[:, columns[name]], units[name], quantity, lines[0][0])
        for name in (total, *_PARTS)
        if name in columns
    }
    field, notes = None, tuple[str, ...]()
    if columns.keys() >= {*_PARTS, *phases}:
        parts = np.stack([power[part] for part in _PARTS], axis=1)
        if np.mean(np.abs(np.sum(parts, axis=1) - power[total]) > SAME_FIELD * power[total]) > 0.5:
            notes = ("Its parts along theta and phi do not add up to its total; the total is read.",)
        else:
            field = np.sqrt(parts) * np.exp(1j * np.radians(values[:, [columns[phase] for phase in phases]]))
    yield Block(
        theta_deg=values[:, columns["theta"]],
        phi_deg=values[:, columns["phi"]],
        gain=power[total],
        field=field,
        lines=np.array([line for line, _ in rows]),
        quantity=quantity,
        notes=notes,
    )


def _power(values: FloatArray, unit: str, quantity: str, line: int) -> FloatArray:
    """Return a column in decibels, as an amplitude of a field, or linear, as linear power."""
    if quantity == "field":
        return from_db(values) if unit.startswith("db") else values**2
    if unit in _DECIBELS:
        return from_db(values + _DECIBELS[unit])
    allowed = f"one of [{'], ['.join(_DECIBELS)}] or linear, []"
    require(unit in ("", "lin.", "1"), f"got a {quantity} in [{unit}], must be in {allowed}", line)
    return values


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
