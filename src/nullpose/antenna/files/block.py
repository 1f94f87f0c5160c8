"""What the formats have in common: numbered rows of a table, and from rows to a grid over the sphere."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from nullpose.antenna.table import PatternTable
from nullpose.errors import Fault, ScenarioError

_SAME_DEG = 1e-6
_SAME_DB = (
    0.05  # two rows of one direction may differ by so much, or by so much of the peak where both are weak
)
_WEAK = 1e-3

Lines = list[tuple[int, str]]
"""A file's lines with their numbers."""


def refuse(message: str, line: int = 0) -> NoReturn:
    """Raise the error of one fault.

    Args:
        message: what was given, what is allowed and what to try.
        line: where; 0 for the file as a whole.
    """
    raise ScenarioError([Fault(f"line {line}" if line else "", message)])


@dataclass(kw_only=True)
class Block:
    """A table of one frequency as a file has it, rows in any order.

    Args:
        theta_deg: polar angle of each row, from -180.
        phi_deg: azimuth of each row.
        gain: power gain of each row, linear; None where the fields tell it.
        field: (rows, 2) complex parts along theta and phi; None for a power table.
        lines: line of each row in the file.
        frequency_hz: None where the file does not say.
        quantity: "gain", "realised gain" or "directivity".
        notes: sentences for the user.
    """

    theta_deg: NDArray[np.float64]
    phi_deg: NDArray[np.float64]
    gain: NDArray[np.float64] | None = None
    field: NDArray[np.complex128] | None = None
    lines: Sequence[int] = ()
    frequency_hz: float | None = None
    quantity: str = "gain"
    notes: list[str] = dataclasses.field(default_factory=list)


def numbers(text: str, line: int, count: int, what: str) -> list[float]:
    """Return the finite numbers of a row.

    Args:
        text: the row.
        line: its number.
        count: how many there must be.
        what: the row in words.
    """
    words = text.replace(",", " ").split()
    try:
        values = [float(word) for word in words]
    except ValueError:
        bad = next(word for word in words if not _is_number(word))
        refuse(f"got {bad[:40]!r}, must be a number: {what}", line)
    if len(values) != count:
        refuse(f"got {len(values)} numbers, must be {count}: {what}", line)
    if not np.all(np.isfinite(values)):
        refuse(f"got {text.strip()[:60]!r}, every number must be finite: {what}", line)
    return values


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def from_db(gain_db: Any) -> NDArray[np.float64]:
    """Return linear gains; 0 for the floors that stand for no gain, -190 dB and below.

    Args:
        gain_db: any shape.
    """
    values = np.asarray(gain_db, dtype=float)
    return np.where(values <= -190.0, 0.0, 10.0 ** (np.maximum(values, -190.0) / 10.0))


def picked(blocks: Iterable[Block], frequency_hz: float | None) -> Block:
    """Return the block of a frequency, or the only one.

    Args:
        blocks: of a file.
        frequency_hz: which one; None where there is only one.
    """
    every = list(blocks)
    if not every:
        refuse("there is no pattern in it; the file must hold a table of gains or fields over directions")
    known = [b.frequency_hz for b in every if b.frequency_hz is not None]
    told = ", ".join(f"{f:g}" for f in known[:20])
    if frequency_hz is None:
        if len(every) > 1:
            refuse(f"it holds {len(every)} frequencies: {told} Hz; state one as frequency_hz")
        return every[0]
    near = [b for b in every if b.frequency_hz and abs(b.frequency_hz / frequency_hz - 1.0) < 1e-3]
    if not near and known:
        refuse(f"got frequency_hz = {frequency_hz:g}, must be one of the file's: {told} Hz")
    return near[0] if near else every[0]


def gridded(block: Block, source: str) -> PatternTable:
    """Return a block as a table over the sphere, polar angles from 0 to 180 and azimuths from 0.

    Args:
        block: its rows may have polar angles from -180 and azimuths of any turn; a seam at 360 may be there.
        source: the file and its format.
    """
    theta, phi, sign = block.theta_deg.copy(), block.phi_deg.copy(), np.ones(len(block.theta_deg))
    outside = np.flatnonzero((np.abs(theta) > 180.0 + _SAME_DEG) | (np.abs(phi) > 720.0))
    if len(outside):
        at = outside[0]
        refuse(
            f"got theta = {theta[at]:g}, phi = {phi[at]:g} degrees, which is beyond the sphere; polar angles "
            "go from 0 to 180, azimuths once round",
            _line(block, int(at)),
        )
    back = theta < 0.0  # the same direction the other way round: both unit vectors turn over
    theta[back], phi[back], sign[back] = -theta[back], phi[back] + 180.0, -1.0
    phi = np.asarray(np.round(np.mod(phi, 360.0), 6), dtype=float)
    phi[phi >= 360.0] = 0.0
    theta = np.asarray(np.round(theta, 6), dtype=float)
    thetas, rows = np.unique(theta, return_inverse=True)
    phis, columns = np.unique(phi, return_inverse=True)
    if len(thetas) < 2 or thetas[0] != 0.0 or thetas[-1] != 180.0:
        refuse(f"polar angles go from {thetas[0]:g} to {thetas[-1]:g} degrees, must go from 0 to 180")
    index = np.full((len(thetas), len(phis)), -1)
    index[rows, columns] = np.arange(len(theta))
    _fill_poles(index)
    hole = np.argwhere(index < 0)
    if len(hole):
        refuse(
            f"there is no row for theta = {thetas[hole[0][0]]:g}, phi = {phis[hole[0][1]]:g} degrees and "
            f"{len(hole) - 1} more directions of the grid; the file is cut short or has holes"
        )
    values = block.field * sign[:, None] if block.field is not None else None
    gain = np.sum(np.abs(values) ** 2, axis=1) if block.gain is None and values is not None else block.gain
    assert gain is not None, "a block has gains or fields"
    _agreeing(block, gain, index[rows, columns])
    if len(phis) > 1 and np.max(np.diff(phis, append=phis[0] + 360.0)) > 1.5 * np.min(np.diff(phis)):
        refuse(
            f"azimuths go from {phis[0]:g} to {phis[-1]:g} degrees with gaps, must go once round "
            "in equal steps"
        )
    fields = None
    if values is not None:
        fields = values[index]
        _turn_at_poles(fields, phis, phi[index])
    return PatternTable(
        theta_deg=thetas,
        phi_deg=phis,
        gain=gain[index],
        field=fields,
        frequency_hz=block.frequency_hz,
        quantity=block.quantity,
        source=source,
        notes=tuple(block.notes),
    )


def _fill_poles(index: NDArray[np.intp]) -> None:
    """Let a pole that is told at some azimuths stand for every azimuth."""
    for row in (index[0], index[-1]):
        told = row[row >= 0]
        if len(told):
            row[row < 0] = told[0]


def _turn_at_poles(
    field: NDArray[np.complex128], phi_deg: NDArray[np.float64], told_deg: NDArray[np.float64]
) -> None:
    """Turn a pole's field, told at one azimuth, to the others: there both unit vectors turn with the azimuth.

    Args:
        field: (t, p, 2), changed in place.
        phi_deg: (p,) azimuths of the columns.
        told_deg: (t, p) azimuths at which the values were told.
    """
    for end, sense in ((0, 1.0), (-1, -1.0)):
        by = np.radians(phi_deg - told_deg[end])
        theta, phi = field[end, :, 0].copy(), field[end, :, 1].copy()
        field[end, :, 0] = theta * np.cos(by) + sense * phi * np.sin(by)
        field[end, :, 1] = phi * np.cos(by) - sense * theta * np.sin(by)


def _agreeing(block: Block, gain: NDArray[np.float64], kept: NDArray[np.intp]) -> None:
    other = gain[kept]
    apart = np.abs(gain - other) > _WEAK * np.max(gain, initial=0.0)
    apart &= np.abs(10.0 * np.log10(np.maximum(gain, 1e-30) / np.maximum(other, 1e-30))) > _SAME_DB
    for at in np.flatnonzero(apart)[:1]:
        refuse(
            f"theta = {block.theta_deg[at]:g}, phi = {block.phi_deg[at]:g} degrees is told twice, with other "
            "numbers; keep one",
            _line(block, int(at)),
        )


def _line(block: Block, row: int) -> int:
    return int(block.lines[row]) if len(block.lines) else 0
