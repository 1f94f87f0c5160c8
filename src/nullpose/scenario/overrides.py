"""Changing single values of a scenario by their path, as in ``jammers.M.power_w=10``."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterable, Sequence
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from nullpose.errors import ScenarioError, checked
from nullpose.files import PlainTable
from nullpose.scenario.faults import (
    call_each,
    described,
    nearest,
    path_of,
    plain,
    raise_all,
    refusal,
    require,
)
from nullpose.scenario.origin import POINT_LISTS
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.section import Section, table_of
from nullpose.scenario.units import EARTHLY

_ASSIGNMENT = re.compile(r"""((?:"[^"]*"|'[^']*'|[^="'])+)=(.*)""", re.DOTALL)
_STEP = re.compile(r"""(?:^|\.)(?:"([^"]*)"|'([^']*)'|([^."'\[\]]+))|\[(\d+)\]""")
_PATH = re.compile(rf"(?:{_STEP.pattern})+")


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
    """Return the override that a text such as ``receiver.noise_dbm=-97`` states.

    Args:
        text: path, equals sign, value. The value is read as TOML; a bare word is a text.

    Raises:
        ScenarioError: when the text has another form.
    """
    parts = _ASSIGNMENT.fullmatch(text)
    path, value = (part.strip() for part in parts.groups()) if parts else ("", "")
    if not path or not value:
        blank = "" if text.strip() else f"got {described(text)}, "
        raise refusal(
            text.strip(),
            f"{blank}must be a path, an equals sign and a value, as in jammers.M.power_w=10",
            "override",
        )
    return Override(path, _value(path, value))


@checked
def apply_overrides(scenario: Scenario, overrides: Iterable[str | Override]) -> Scenario:
    """Return the scenario with the given values in place of its own, validated anew.

    Overrides are applied in order. Setting one key of a pair (W or dBm, gain or frequency, weight or
    requirement) drops the other; so does setting position_m where a latitude was stated, or a latitude where
    position_m was. Points that are stated by latitude and longitude stay there when the origin moves. A table
    that the scenario has not is begun.

    Args:
        scenario: where to start.
        overrides: texts such as ``jammers.M.power_w=10``, or Override values.

    Raises:
        ScenarioError: with every path that does not exist and every fault of the result.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> strong = nullpose.apply_overrides(scenario, ["jammers.M.power_w=10", "receiver.noise_dbm=0"])
        >>> strong.jammers[0].power_w, strong.receiver.noise_dbm
        (10.0, 0.0)
    """
    data, changes = scenario.to_dict(), list(overrides)
    _, faults = call_each(lambda change: _apply(change, data), changes)
    try:
        changed = Scenario.from_dict(data)
    except ScenarioError as error:
        faults += error.faults
    raise_all(faults, _source(changes))
    return changed


def overridden(tables: PlainTable, overrides: Sequence[str | Override]) -> PlainTable:
    """Return the tables of a scenario file with the given values in place of its own, not validated.

    Args:
        tables: of the file.
        overrides: as for :func:`apply_overrides`.

    Raises:
        ScenarioError: with every path that does not exist.
    """
    data = deepcopy(dict(tables))
    _, faults = call_each(lambda change: _apply(change, data), overrides)
    raise_all(faults, _source(overrides))
    return data


def _source(overrides: Sequence[str | Override]) -> str:
    return f"override {', '.join([str(override).strip() or '(blank)' for override in overrides])}"


def _apply(raw: str | Override, data: PlainTable) -> None:
    """Set one value of a raw scenario, and drop what it replaces."""
    override = parse_override(raw) if isinstance(raw, str) else raw
    path = override.path
    require(_PATH.fullmatch(path), path, "this is not a path")
    steps: list[str | int] = [
        int(index) if index else double or single or bare
        for double, single, bare, index in (step.groups(default="") for step in _STEP.finditer(path))
    ]
    _assign(Scenario, data, steps, deepcopy(plain(override.value)), path)
    if steps[0] == "antenna" and len(steps) > 1 and steps[1] not in ("normalise", "gain_dbi", "harmonics"):
        data["antenna"].pop("harmonics", None)  # what was read of a file is no longer right
    if steps[0] == "origin":  # points and areas stay where they are on the Earth
        airspace = data.get("airspace", {})
        points = (point for kind in POINT_LISTS for point in data.get(kind, ()))
        areas = (airspace, *airspace.get("no_fly", ()), *data.get("buildings", ()))
        for table in (*points, data.get("destination"), *areas):
            for key, metric in EARTHLY.items() if isinstance(table, dict) else ():
                if key in table:
                    table.pop(metric, None)


def _value(path: str, text: str) -> object:
    with suppress(ValueError, RecursionError):  # it may be a bare word
        if (tables := tomllib.loads(f"value = {text}")).keys() == {"value"}:
            return tables["value"]
    with suppress(ValueError):
        return float(text)  # .5 and 5. are numbers to everyone but TOML
    if text[0] in "[{\"'" or "\n" in text:
        raise refusal(
            path, f"the value {text} is not TOML; write as in 10, [5, 20] or a bare word", "override"
        )
    return text


def _assign(
    kind: type[Section] | None, holder: Any, steps: Sequence[str | int], value: object, path: str
) -> None:
    """Set the value at the place in a raw table or list that the steps lead to; drops what it replaces.

    Args:
        kind: what kind of table the holder is, or its members are; None where there are none.
        holder: the table or list, which is changed.
        steps: from it to the place.
        value: the new value.
        path: all steps as they were given, for messages.
    """
    members, (step, *rest) = _members(kind, holder), steps
    if step not in members:
        raise refusal(path, f"got {path_of((step,))}, {_instead(step, members, path)}")
    member = members[step]
    table = kind if isinstance(holder, dict) else None
    inner = kind if table is None else table_of(table, str(member))
    if rest:
        is_table = inner is not None and inner.letter is None
        below = holder.get(member, {} if is_table else None) if isinstance(holder, dict) else holder[member]
        _assign(inner, below, rest, value, path)
        value = below
    holder[member] = value
    for ways in table.ways if table else ():
        for other in ways.others(str(member)):
            holder.pop(other, None)


def _members(kind: type[Section] | None, holder: object) -> dict[str | int, str | int]:
    """Return the steps that lead on from a raw table or list, with the key or index that each means."""
    if isinstance(holder, dict):
        return {key: key for key in kind.model_fields} if kind else {}
    members = holder if isinstance(holder, list) else []
    steps: dict[str | int, str | int] = {index: index for index in range(len(members))}
    return steps | {
        member.get("name") or f"{kind.letter}{index}": index - 1
        for index, member in enumerate(members, 1)
        if kind is not None and isinstance(member, dict)
    }


def _instead(step: str | int, members: Collection[str | int], path: str) -> str:
    """Word the fault of a step that leads nowhere."""
    names = [member for member in members if isinstance(member, str)]
    guess = nearest(str(step), names) or (names[0] if len(names) == 1 else "")
    meant = f"; did you mean {path.replace(path_of((step,)), path_of((guess,)), 1)}?" if guess else ""
    if not members:
        return "but it has no members, so set it whole"
    return f"must be one of {', '.join([path_of((member,)) for member in members])}{meant}"
