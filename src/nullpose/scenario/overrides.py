"""Changing single values of a scenario by their path, as in ``jammers.M.power_w=10``."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.faults import Place, path_of
from nullpose.scenario.names import named
from nullpose.scenario.origin import unlocated
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.section import Section, inner_section
from nullpose.scenario.wording import listed, nearest, plain

__all__ = ["Override", "apply_overrides", "parse_override"]

_ASSIGNMENT = re.compile(r"""((?:"[^"]*"|'[^']*'|[^="'])+)=(.*)""", re.DOTALL)
_STEP = re.compile(r"""(?:^|\.)(?:"([^"]*)"|'([^']*)'|([^."'\[\]]+))|\[(\d+)\]""")


@dataclass(frozen=True, slots=True)
class Override:
    """A new value for one place of a scenario.

    Args:
        path: the place, such as ``jammers.M.power_w``, ``jammers[0].power_w``, ``nodes.S1.position_m[2]``,
            ``airframe.tilt_max_deg`` or ``airspace.no_fly.tower.radius_m``; names that hold a dot, a bracket
            or an equals sign stand in quotes.
        value: a number, text, list or table, as a TOML file would hold.
    """

    path: str
    value: object

    def __str__(self) -> str:
        return f"{self.path}={plain(self.value)}"


def parse_override(text: str) -> Override:
    """Returns the override that a text such as ``receiver.noise_dbm=-97`` states.

    Args:
        text: path, equals sign, value. The value is read as TOML; a bare word is a text.

    Raises:
        ScenarioError: when the text has another form.
    """
    parts = _ASSIGNMENT.fullmatch(text)
    if not parts or not parts[1].strip() or not parts[2].strip():
        message = "must be a path, an equals sign and a value, as in jammers.M.power_w=10"
        raise ScenarioError([Fault(text, message)], "override")
    path, value = parts[1].strip(), parts[2].strip()
    return Override(path, _value(path, value))


def apply_overrides(scenario: Scenario, overrides: Iterable[str | Override]) -> Scenario:
    """Returns the scenario with the given values in place of its own, validated anew.

    Overrides are applied in order. Setting one key of a pair (W or dBm, gain or frequency, weight or
    requirement) drops the other; so does setting position_m where a latitude was stated, or a latitude where
    position_m was. Points that are stated by latitude and longitude stay there when the origin moves. A table
    that the scenario has not is begun.

    Args:
        scenario: where to start.
        overrides: texts such as ``jammers.M.power_w=10``, or Override values.

    Raises:
        ScenarioError: with every path that does not exist and every fault of the result.
    """
    data = scenario.to_dict()
    known = tuple(_known_paths(Scenario, scenario))
    faults: list[Fault] = []
    applied: list[Override] = []
    for override in overrides:
        try:
            parsed = parse_override(override) if isinstance(override, str) else override
            applied.append(parsed)
            _assign(data, _steps(parsed.path), deepcopy(plain(parsed.value)))
        except ScenarioError as error:
            faults += error.faults
        except _UnknownPathError as error:
            guess = _nearest_path(parsed.path, known)
            meant = f"; did you mean {guess}?" if guess != parsed.path else ""
            faults.append(Fault(parsed.path, f"{error}{meant}"))
    source = f"override {listed([str(override) for override in applied])}"
    try:
        changed = Scenario.from_dict(data)
    except ScenarioError as error:
        raise ScenarioError([*faults, *error.faults], source) from None
    if faults:
        raise ScenarioError(faults, source)
    return changed


class _UnknownPathError(Exception):
    """A path that leads nowhere; the message says where it ends."""


def _value(path: str, text: str) -> object:
    try:
        tables = tomllib.loads(f"value = {text}")
        if tables.keys() == {"value"}:
            return tables["value"]
    except (ValueError, RecursionError):
        pass  # not TOML; it may be a bare word
    try:
        return float(text)  # .5 and 5. are numbers to everyone but TOML
    except ValueError:
        pass
    if text[0] in "[{\"'" or "\n" in text:
        message = f"the value {text} is not TOML; write as in 10, [5, 20] or a bare word"
        raise ScenarioError([Fault(path, message)], "override")
    return text


def _steps(path: str) -> Place:
    """Returns the path as keys, names and indices; raises _UnknownPathError when it is not one."""
    steps: list[str | int] = []
    end = 0
    while end < len(path):
        step = _STEP.match(path, end)
        if not step:
            raise _UnknownPathError("this is not a path")
        steps.append(int(step[4]) if step[4] else next(word for word in step.groups() if word is not None))
        end = step.end()
    return tuple(steps)


def _assign(data: dict[str, Any], steps: Place, value: object) -> None:
    """Sets the value at the place that the steps lead to."""
    if not steps or steps[0] not in Scenario.model_fields:
        raise _UnknownPathError("there is no such value in a scenario")
    if steps[0] == "origin":
        unlocated(data)
    _assign_in_table(Scenario, data, steps, value)


def _assign_in_table(kind: type[Section], table: object, steps: Place, value: object) -> None:
    """Sets what the steps lead to inside a table; drops what it takes the place of."""
    key, rest = steps[0], steps[1:]
    if not isinstance(table, dict) or not isinstance(key, str) or key not in kind.model_fields:
        raise _UnknownPathError(f"there is no such key; the keys here are {listed(kind.model_fields)}")
    inner = inner_section(kind.model_fields[key])
    if not rest:
        table[key] = value
    elif inner is None:
        _assign_in_row(key, table.get(key), rest, value)
    elif inner.letter is None:
        # A table that is not there yet is begun, once the rest of the path has proved to lead somewhere.
        begun = table.get(key, {})
        _assign_in_table(inner, begun, rest, value)
        table[key] = begun
    else:
        members: Any = table.get(key)
        index = _index(key, inner.letter, members, rest[0])
        if len(rest) == 1:
            members[index] = value
        else:
            _assign_in_table(inner, members[index], rest[1:], value)
    for other in _replaced(kind, key):
        table.pop(other, None)


def _replaced(kind: type[Section], key: str) -> Iterator[str]:
    """Yields the keys that state in another way what a key states."""
    for one, other in (*kind.pairs, *kind.alternatives):
        if key in (one, other):
            yield other if key == one else one
    if any(key in way for way in kind.ways):
        yield from (other for way in kind.ways if key not in way for other in way)


def _index(key: str, letter: str, members: object, step: str | int) -> int:
    """Returns the index of the member with a name or an index."""
    if not isinstance(members, list) or not members:
        raise _UnknownPathError(f"the scenario has no {key}")
    names = [member.get("name") if isinstance(member, dict) else None for member in named(members, letter)]
    if step in names:
        return names.index(str(step))
    if isinstance(step, int) and step < len(members):
        return step
    have = listed([f"[{index}] {name}" for index, name in enumerate(names)])
    raise _UnknownPathError(f"{key} has no member {path_of((step,))}, it has {have}")


def _assign_in_row(key: str, row: object, steps: Place, value: object) -> None:
    """Sets a member of a list of numbers, or of a list of such lists."""
    index = steps[0]
    if not isinstance(row, list) or not isinstance(index, int) or index >= len(row):
        raise _UnknownPathError(f"{key} {_shape(row)}")
    if len(steps) == 1:
        row[index] = value
    else:
        _assign_in_row(f"{key}[{index}]", row[index], steps[1:], value)


def _shape(row: object) -> str:
    if row is None:
        return "is not given, so set it whole"
    return f"has the members [0] to [{len(row) - 1}]" if isinstance(row, list) else "is a single value"


def _nearest_path(path: str, known: Sequence[str]) -> str:
    """Returns a known path of the same depth and much like the given, else its known beginning, else any."""
    same_depth = [other for other in known if other.count(".") == path.count(".")]
    beginning = max((other for other in known if path.startswith(other)), key=len, default="")
    return nearest(path, same_depth, at_least=0.7) or beginning or nearest(path, known, at_least=0.0)


def _known_paths(kind: type[Section], values: Section | None, at: Place = ()) -> Iterator[str]:
    """Yields every path that may be set below a place, members by name and by index."""
    for key, field in kind.model_fields.items():
        yield path_of((*at, key))
        inner = inner_section(field)
        value = getattr(values, key, None)
        if inner is not None and inner.letter is None:
            yield from _known_paths(inner, value, (*at, key))
        elif inner is not None:
            for index, member in enumerate(value or ()):
                for step in (member.name, index):
                    yield path_of((*at, key, step))
                    yield from _known_paths(type(member), member, (*at, key, step))
