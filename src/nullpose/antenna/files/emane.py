"""Antenna profiles of EMANE: XML of gains by elevation and bearing, and what the body blocks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from xml.parsers import expat

import numpy as np

from nullpose.antenna.files.block import Block, FloatArray, Lines, from_db, numbers, refuse

_OUTSIDE_DB = -327.0  # of every range
_LOWEST = {"elevation": -90, "bearing": 0}
_NOTE = "The file's bearings grow clockwise seen from above; they are turned the other way round."


class _Profile:
    """What expat finds in a profile: gains and blockage in dB by elevation and bearing."""

    def __init__(self, lines: Lines) -> None:
        self.grids = {
            "antennapattern": np.full((181, 360), _OUTSIDE_DB),
            "blockagepattern": np.zeros((181, 360)),
        }
        self.found: set[str] = set()
        self.grid: FloatArray | None = None
        self.ranges = {"elevation": slice(None), "bearing": slice(None)}
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self.start
        self.parser.EntityDeclHandler = self.entity  # expat itself opens no other file
        told = dict(lines)  # blank lines put back, so that expat's line numbers are the file's
        try:
            self.parser.Parse("\n".join(told.get(at, "") for at in range(1, lines[-1][0] + 1)), True)
        except expat.ExpatError as error:
            refuse(f"this is not XML: {expat.ErrorString(error.code)}; is the file cut short?", error.lineno)

    def start(self, name: str, values: dict[str, str]) -> None:
        if name in self.grids:
            self.grid = self.grids[name]
            self.found.add(name)
        elif name in _LOWEST:
            low, high = (self.number(values, key) - _LOWEST[name] for key in ("min", "max"))
            size = 181 if name == "elevation" else 360
            if not 0 <= low <= high < size or low % 1.0 or high % 1.0:
                least, most = _LOWEST[name], _LOWEST[name] + size - 1
                given = f"{name} min={values.get('min')!r} max={values.get('max')!r}"
                refuse(
                    f"got {given}, must be whole degrees from {least} to {most}",
                    self.parser.CurrentLineNumber,
                )
            self.ranges[name] = slice(int(low), int(high) + 1)
        elif name == "gain" and self.grid is not None:
            self.grid[self.ranges["elevation"], self.ranges["bearing"]] = self.number(values, "value")

    def entity(self, *_: Any) -> None:
        refuse(
            "it declares entities, which are not read; write out what they stand for",
            self.parser.CurrentLineNumber,
        )

    def number(self, values: dict[str, str], key: str) -> float:
        return float(numbers([(self.parser.CurrentLineNumber, values.get(key, ""))], 1, key)[0, 0])


def read_emane(lines: Lines) -> Iterator[Block]:
    """Yield the pattern of a profile, its blockage applied.

    Args:
        lines: of the file.

    Raises:
        ScenarioError: it is no XML, or no antenna pattern.
    """
    profile = _Profile(lines)
    if "antennapattern" not in profile.found:
        refuse("there is no <antennapattern> in it, must be; a blockage goes into the same file")
    elevation, bearing = np.meshgrid(np.arange(-90.0, 91.0), np.arange(360.0), indexing="ij")
    yield Block(
        theta_deg=90.0 - elevation.ravel(),
        phi_deg=-bearing.ravel(),
        gain=from_db(profile.grids["antennapattern"] + profile.grids["blockagepattern"]).ravel(),
        notes=(_NOTE,),
    )
