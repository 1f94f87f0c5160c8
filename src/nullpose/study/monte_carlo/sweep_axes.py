"""The parameters that a study sweeps: paths into a scene, or keys of what draws it, with their values."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Annotated

from pydantic_core import PydanticCustomError

from nullpose.errors import UsageError
from nullpose.scenario.faults import Place, collected, path_of, rejection, require_value
from nullpose.scenario.rules import Choice, Count, Limits, Rule
from nullpose.scenario.wording import described, plain, unknown
from nullpose.study.sweep import spaced

MOST_POINTS = 1_000_000  # combinations of swept values

_DEEPEST = 16  # parts of a path: no value of a scene is deeper
_VALUE = Limits("a number", -1e30, 1e30, "in the unit that the path ends in")
_SPACING = Choice("a spacing", ("linear", "log"))
_KEYS: dict[str, Rule] = {
    "from": _VALUE,
    "to": _VALUE,
    "points": Count("a number of values", 2, 100_000, "both ends included"),
    "spacing": _SPACING,
}

Axis = tuple[str, tuple[float, ...]]


class _SweptValues(Rule):
    """Swept values by path."""

    def read(self, value: object) -> tuple[Axis, ...]:
        value = dict(value) if isinstance(value, tuple) else value
        if not isinstance(value, Mapping):
            raise rejection(f"got {described(value)}, must be a table headed [sweep]")
        axes: list[Axis] = []
        faults: list[tuple[Place, str]] = []
        for path, raw in _paths(value):
            try:
                axes.append((path, _values(plain(raw))))
            except (PydanticCustomError, UsageError) as error:
                faults.append(((path,), str(error).replace("\n  ", "; ")))
        if faults:
            raise collected("sweep", faults)
        size = math.prod(len(values) for _, values in axes)
        require_value(
            size <= MOST_POINTS,
            f"the grid has {size} combinations of values, at most {MOST_POINTS} are allowed",
        )
        return tuple(axes)


SweepAxes = Annotated[tuple[Axis, ...], _SweptValues()]  # paths, each with the values that it is set to


def _paths(table: Mapping[object, object], at: Place = ()) -> Iterator[tuple[str, object]]:
    """Yield each path with its values; one without quotes has come as tables within tables."""
    for key, raw in table.items():
        if isinstance(raw, Mapping) and raw and not set(raw) & set(_KEYS) and len(at) < _DEEPEST:
            yield from _paths(raw, (*at, str(key)))
        else:
            yield (path_of((*at, str(key))) if at else str(key)), raw


def _values(raw: object) -> tuple[float, ...]:
    """Return the values that a list or a table of from, to, points and spacing states."""
    if isinstance(raw, list | tuple) and len(raw) > 0:
        values = tuple(_VALUE.read(value) for value in raw)
        require_value(len(set(values)) == len(values), "a value is given twice; keep one")
        return values
    if not isinstance(raw, Mapping):
        raise rejection(
            f"got {described(raw)}, must be a list of numbers or a table such as "
            '{ from = 0.1, to = 100, points = 4, spacing = "log" }'
        )
    for key in [each for each in raw if each not in _KEYS]:
        raise rejection(f"{key}: {unknown('key', str(key), _KEYS)}")
    missing = [key for key in ("from", "to", "points") if key not in raw]
    require_value(
        not missing, f"{', '.join(missing)} missing; a table here has from, to, points and perhaps spacing"
    )
    start, stop, points, spacing = (rule.read(raw.get(key, "linear")) for key, rule in _KEYS.items())
    return spaced(start, stop, points, log=spacing == "log")
