"""Antenna profiles of EMANE: XML of gains by elevation and bearing, and what the body blocks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from xml.parsers import expat

import numpy as np

from nullpose.antenna.files.block import Block, Lines, from_db, refuse

_FLOOR_DB = -327.0  # outside of every range
_ANGLES = {"elevation": (-90, 90), "bearing": (0, 359)}


def is_emane(lines: Lines) -> bool:
    """Return whether a file is an antenna profile."""
    return any("<antennaprofile" in line for _, line in lines[:50])


def read_emane(lines: Lines) -> Iterator[Block]:
    """Yield the pattern of a profile, blockage taken off; bearings grow clockwise."""
    gain, blocked = np.full((181, 360), _FLOOR_DB), np.zeros((181, 360))
    told = {"antennapattern": False}
    ranges: dict[str, slice] = {}
    target: list[np.ndarray] = []
    parser = expat.ParserCreate()

    def start(name: str, values: dict[str, str]) -> None:
        if name in ("antennapattern", "blockagepattern"):
            told[name] = True
            target[:] = [gain if name == "antennapattern" else blocked]
        elif name in _ANGLES:
            ranges[name] = _range(name, values, parser.CurrentLineNumber)
        elif name == "gain" and target:
            whole = slice(None)
            target[0][ranges.get("elevation", whole), ranges.get("bearing", whole)] = _number(
                values.get("value"), parser.CurrentLineNumber
            )

    def end(name: str) -> None:
        ranges.pop(name, None)

    def entity(*_: Any) -> None:
        refuse("it declares entities, which are not read; remove them", parser.CurrentLineNumber)

    parser.StartElementHandler, parser.EndElementHandler, parser.EntityDeclHandler = start, end, entity
    try:
        parser.Parse("\n".join(text for _, text in lines).encode(), True)
    except expat.ExpatError as error:
        refuse(f"this is not XML: {expat.ErrorString(error.code)}", error.lineno)
    if not told["antennapattern"]:
        refuse("there is no antennapattern in it, must be")
    elevation, bearing = np.meshgrid(np.arange(-90.0, 91.0), np.arange(360.0), indexing="ij")
    yield Block(
        theta_deg=90.0 - elevation.ravel(),
        phi_deg=-bearing.ravel(),
        gain=from_db(np.maximum(gain + blocked, _FLOOR_DB)).ravel(),
        notes=["Bearings grow clockwise seen from above: they are turned round to azimuths."],
    )


def _range(name: str, values: dict[str, str], line: int) -> slice:
    least, most = _ANGLES[name]
    low, high = (_number(values.get(key), line) for key in ("min", "max"))
    if not (least <= low <= high <= most and low == int(low) and high == int(high)):
        refuse(f"got {name} from {low:g} to {high:g}, must be whole degrees from {least} to {most}", line)
    return slice(int(low) - least, int(high) - least + 1)


def _number(text: str | None, line: int) -> float:
    try:
        value = float(text or "")
    except ValueError:
        refuse(f"got {text!r}, must be a number", line)
    if not np.isfinite(value):
        refuse(f"got {text!r}, must be finite", line)
    return value
