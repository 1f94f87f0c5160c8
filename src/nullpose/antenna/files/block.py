"""What the formats have in common: rows of numbers with their lines, and the grid that rows make."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NoReturn, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna.harmonics import FloatArray
from nullpose.antenna.table import PatternTable
from nullpose.errors import Fault, ScenarioError

_FLOOR_DB = -190.0  # gains from here down stand for none: NEC writes -999.99, CST -200
_HIGHEST_DB = 1000.0
_FREQUENCIES_HZ = 1e3, 1e13
_LARGEST = 1e100  # number; the square of one beyond overflows
_FEWEST = 4  # angles
_UNEVEN_DEG = 0.01  # angles are written with two digits
DBD = 2.15
"""Decibels of a half-wave dipole over an isotropic antenna."""
SAME_FIELD = 0.015
"""How far a gain and the square of its field may be apart, of the gain: .065 dB."""
_TWICE, _WEAK = 1.012, 1e-3  # two rows of a direction differ by .05 dB at most, or by so much of the peak

Lines: TypeAlias = Sequence[tuple[int, str]]
"""Lines of a file that are not blank, with their numbers."""


class Block(PatternTable):
    """The pattern of one frequency as a file has it: a number for each of n rows, in any order.

    Polar angles may begin at -180, azimuths go from -360 to 360; the quantity is "field" where the file does
    not say its power.
    """


def power_of(field: NDArray[np.complex128]) -> FloatArray:
    """Return the gain of a field, the squares of whose parts it sums; infinite beyond all measure."""
    with np.errstate(over="ignore"):
        return np.asarray(np.sum(np.abs(field) ** 2, axis=-1))


def refuse(message: str, line: int = 0) -> NoReturn:
    """Raise the error of one fault.

    Args:
        message: what was given, what is allowed and what to try.
        line: where; 0 for the file as a whole.

    Raises:
        ScenarioError: always.
    """
    raise ScenarioError([Fault(f"line {line}" if line else "", message)])


def require(holds: object, message: str, line: int = 0) -> None:
    """Raise the error of one fault unless a condition holds, as :func:`refuse` does."""
    if not holds:
        refuse(message, line)


def numbers(lines: Lines, count: int, what: str, separator: str | None = None) -> FloatArray:
    """Return the numbers of some lines, (n, count), all finite.

    Args:
        lines: numbers, in quotes or not.
        count: how many each must have.
        what: they are, in words.
        separator: between them; None for blanks.

    Raises:
        ScenarioError: a line has others, or there is none.
    """
    require(lines, f"there is no row of {what}; is the file cut short?")
    rows = []
    for line, text in lines:
        try:
            row = [float(word) for word in text.replace('"', "").split(separator)]
        except ValueError:
            row = []
        if len(row) != count or "_" in text or not all(abs(number) < _LARGEST for number in row):
            amount = "one finite number" if count == 1 else f"{count} finite numbers"
            comma = separator != "," and re.search(r"\d,\d", text)
            advice = "; write decimal points in place of decimal commas" if comma else ""
            refuse(f"got {text.strip()[:60]!r}, must be {amount}: {what}{advice}", line)
        rows.append(row)
    return np.array(rows)


def rows_of(lines: Lines, start: int, count: float, width: int, what: str) -> FloatArray:
    """Return the numbers of so many lines from one on, (count, width).

    Args:
        lines: of the file.
        start: index of the first.
        count: how many there must be.
        width: numbers in each.
        what: they are, in words.

    Raises:
        ScenarioError: there are fewer, or one has other numbers.
    """
    got = len(lines) - start
    require(
        0 < count <= got and count % 1.0 == 0.0,
        f"{count:g} rows are announced and {got} lines follow; is the file cut short?",
        lines[-1][0],
    )
    return numbers(lines[start : start + int(count)], width, what)


def from_db(gain_db: ArrayLike) -> FloatArray:
    """Return linear power; 0 for the floors that stand for none, -190 dB and below.

    Args:
        gain_db: any shape.
    """
    power = 10.0 ** (np.clip(gain_db, _FLOOR_DB, _HIGHEST_DB) / 10.0)
    return np.where(np.asarray(gain_db) > _FLOOR_DB, power, 0.0)


def gridded(block: Block, source: str) -> PatternTable:
    """Return a block as a table over the sphere.

    Args:
        block: of any grid with equal steps that has every direction.
        source: the file and its format.

    Raises:
        ScenarioError: rows are missing, contradict each other or are beyond the sphere.
    """
    hz = block.frequency_hz or _FREQUENCIES_HZ[0]
    require(
        _FREQUENCIES_HZ[0] <= hz <= _FREQUENCIES_HZ[1],
        f"its frequency is {hz:g} Hz, must be 1 kHz to 10 THz; is the unit right?",
    )
    theta, phi = np.round(block.theta_deg, 3), np.round(block.phi_deg, 3)
    beyond = (np.abs(theta) > 180.0) | (np.abs(phi) > 360.0)
    _refuse_row(block, beyond, "is beyond the sphere; polar angles go from 0 to 180, azimuths from 0 to 360")
    require(
        np.ptp(phi), f"it has one cut, at phi = {phi[0]:g} degrees; export the whole sphere, all azimuths"
    )
    back = theta < 0.0  # the same direction seen the other way round, where both unit vectors turn over
    require(
        (np.min(theta), np.max(theta)) != (-90.0, 90.0),
        "theta goes from -90 to 90 degrees, as elevations do; must go from 0 to 180, 0 being straight up: if "
        "they are elevations, write 90 less each",
    )
    thetas, rows = np.unique(np.abs(theta), return_inverse=True)
    phis, columns = np.unique(np.round(phi + 180.0 * back, 3) % 360.0, return_inverse=True)
    _require_even("polar angles", thetas, 180.0)
    _require_even("azimuths", np.append(phis, 360.0), 360.0)
    first = np.full((len(thetas), len(phis)), -1)
    first[rows[::-1], columns[::-1]] = np.arange(len(rows))[::-1]
    turn = _fill_poles(first, phis)
    holes = np.argwhere(first < 0)
    for row, column in holes[:1]:
        refuse(
            f"there is no row for theta = {thetas[row]:g}, phi = {phis[column]:g} degrees"
            f"{f', nor for {len(holes) - 1} other directions' if len(holes) > 1 else ''}; the grid must have "
            "every direction. Is the file cut short?"
        )
    field, gain = block.field, block.gain
    if field is not None:
        _refuse_row(block, np.any(np.abs(field) > _LARGEST, axis=1), "has a field beyond all measure")
        field, gain = field * np.where(back, -1.0, 1.0)[:, None], power_of(field)
        apart = np.abs(gain - block.gain) > SAME_FIELD * block.gain + 0.1 * _WEAK * np.max(block.gain)
        _refuse_row(block, apart, "has a gain and fields that contradict each other")
    _refuse_row(block, gain < 0.0, "has a gain below 0; is a column in decibels read as linear?")
    other = gain[first[rows, np.where((rows == 0) | (rows == len(thetas) - 1), 0, columns)]]
    apart = np.maximum(gain, other) > _TWICE * np.minimum(gain, other)
    apart &= np.abs(gain - other) > _WEAK * np.max(gain)
    _refuse_row(
        block, apart, "is given twice, with other numbers; keep one (at a pole azimuths are one direction)"
    )
    return PatternTable(
        theta_deg=np.linspace(0.0, 180.0, len(thetas)),
        phi_deg=np.linspace(0.0, 360.0, len(phis), endpoint=False),
        gain=gain[first],
        field=None if field is None else _turned(field[first], turn),
        frequency_hz=block.frequency_hz or None,  # some write 0
        quantity=block.quantity,
        source=source,
        notes=(*block.notes, *([f"Estimate: {block.caveat}."] if block.caveat else [])),
        caveat=block.caveat,
        lines=None if block.lines is None else block.lines[first],
    )


def _fill_poles(first: NDArray[np.intp], phi_deg: FloatArray) -> FloatArray:
    """Let a row at a pole stand for azimuths without one; return by how much they turn, (t, p), radians."""
    turn_rad = np.zeros(first.shape)
    for pole, sense in ((0, 1.0), (-1, -1.0)):  # the south pole's azimuths turn the other way
        gap = first[pole] < 0
        present = int(np.argmin(gap))
        turn_rad[pole, gap] = sense * np.radians(phi_deg[gap] - phi_deg[present])
        first[pole, gap] = first[pole, present]
    return turn_rad


def _turned(field: NDArray[np.complex128], turn_rad: FloatArray) -> NDArray[np.complex128]:
    """Return a field's parts along unit vectors that are turned from theta towards phi."""
    along, round_z, cosine, sine = field[..., 0], field[..., 1], np.cos(turn_rad), np.sin(turn_rad)
    return np.stack([cosine * along + sine * round_z, cosine * round_z - sine * along], axis=-1)


def _refuse_row(block: Block, bad: NDArray[np.bool_], why: str) -> None:
    """Refuse the first of the rows that are bad, if any is."""
    for at in np.flatnonzero(bad)[:1]:
        line = 0 if block.lines is None else int(block.lines[at])
        refuse(f"theta = {block.theta_deg[at]:g}, phi = {block.phi_deg[at]:g} degrees {why}", line)


def _require_even(name: str, angles_deg: FloatArray, end_deg: float) -> None:
    even = np.linspace(0.0, end_deg, len(angles_deg))
    first = ", ".join(f"{angle:g}" for angle in angles_deg[:3])
    require(
        len(angles_deg) >= _FEWEST and np.max(np.abs(angles_deg - even)) <= _UNEVEN_DEG,
        f"{name} are {first} ... {angles_deg[-1]:g} degrees, must go from 0 to {end_deg:g} in equal "
        f"steps, {_FEWEST} angles at least; export the whole sphere. Is the file cut short?",
    )
