"""A scenario as the text of the file that it is from: brought up to date, everything else as it was."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise, takewhile, zip_longest
from typing import Any

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario
from nullpose.scenario.origin import POINT_LISTS, located
from nullpose.scenario.toml_file import tables_of
from nullpose.scenario.toml_text import toml_value
from nullpose.scenario.units import watts_from_dbm

_Table = dict[str, Any]

_HEADER = re.compile(r"[ \t]*\[.*\][ \t]*(?:#.*)?\n")
_LISTS = ("airspace", "no_fly"), ("nodes",), ("jammers",), ("eavesdroppers",)
_FROM_FILES = "nodes_from", "geofence_from", "no_fly_from"
_PLACES = "position_m", "centre_m", "polygon_m", "x_m", "lat_deg"
_RANKS = {key: rank for rank, key in enumerate(Scenario.model_fields)}


@dataclass(slots=True, eq=False)
class _Block:
    """A table of a file with its header, the comments directly above it, and what follows its last key."""

    path: tuple[str, ...]
    lead: str
    header: str
    body: str
    tail: str = ""
    is_gone: bool = False


def toml_like(text: str, scenario: Scenario) -> str:
    """Return the text of a file, brought up to date with a scenario: its comments and its order are kept.

    A point or zone that is gone takes the comments directly above it along. What the text names other files
    for is stated in it. A power that is new stays in dBm where the file has dBm, if that is exact.

    Args:
        text: of the file that the scenario is from. If it is none, the result is the scenario's own text.
        scenario: what the result loads as.
    """
    from tomlkit.exceptions import TOMLKitError

    plain = text.removeprefix("\ufeff").replace("\r\n", "\n")
    with suppress(ScenarioError, TOMLKitError, ValueError):
        old, new = _stated(tables_of(plain), scenario)
        found = _updated(plain, old, new)
        if Scenario.from_dict(tables_of(found)) == Scenario.from_dict(new):
            return found.replace("\n", "\r\n") if "\r\n" in text else found
    return scenario.to_toml()


def _stated(raw: _Table, scenario: Scenario) -> tuple[_Table, _Table]:
    """Return what a file states by itself, and what it is to state; both as plain values."""
    new = scenario.to_dict()
    files = {key: raw.pop(key) for key in _FROM_FILES if key in raw}
    airspace = raw.setdefault("airspace", {})
    areas = {key: airspace.pop(key) for key in _FROM_FILES if key in airspace}
    is_filed = "harmonics" not in raw.get("antenna", {"harmonics": None}) and "file" in raw["antenna"]
    if is_filed:
        raw["antenna"]["harmonics"] = new.get("antenna", {}).get("harmonics", [[1.0]])
    old = Scenario.from_dict({"nodes": new["nodes"]} | dict(located(raw))).to_dict()
    if is_filed:
        del old["antenna"]["harmonics"]
    old |= files | ({} if "nodes" in raw else {"nodes": []})
    old["airspace"] |= areas
    for key in POINT_LISTS:
        _keep_dbm(old.get(key, []), new.get(key, []))
    earthly = ["lat_deg" in one for key in POINT_LISTS for one in new.get(key, [])]
    if any(earthly) and not all(earthly):  # such a file states every point in metres, some in degrees too
        for one in (one for key in POINT_LISTS for one in old.get(key, []) if "lat_deg" in one):
            del one["position_m"]
    return old, new


def _keep_dbm(old: Sequence[_Table], new: Sequence[_Table]) -> None:
    named = {one["name"]: one for one in old}
    for one in new:
        like = named.get(one["name"], old[0] if old else {})
        if "power_dbm" in like and "power_w" in one:
            power_dbm = round(10.0 * math.log10(one["power_w"]) + 30.0, 9)
            if watts_from_dbm(power_dbm) == one["power_w"]:
                del one["power_w"]
                one["power_dbm"] = power_dbm


def _at(tables: _Table, path: tuple[str, ...]) -> Any:
    """Return what is at a path, an empty list if nothing is."""
    for key in path:
        tables = tables.get(key, [])
    return tables


def _updated(text: str, old: _Table, new: _Table) -> str:
    blocks = _blocks(text if text.endswith("\n") else f"{text}\n")
    for block in blocks:
        if block.path not in _LISTS:
            now = _at(new, block.path)
            block.is_gone = now == []
            block.body = block.body if block.is_gone else _edited(block.body, _at(old, block.path), now)
    for key, value in new.items():
        if isinstance(value, Mapping) and key not in old:
            _insert(blocks, (key,), value)
    for path in _LISTS:
        _update_members(blocks, path, _at(old, path), _at(new, path))
    kept = blocks[0]
    for block in blocks:
        if not block.is_gone:
            kept = block
        elif "#" in block.tail:  # a remark that stands by itself stays
            kept.tail = (kept.tail.rstrip("\n") + "\n" if "#" in kept.tail else "") + block.tail
    whole = "".join(f"{one.lead}{one.header}{one.body}{one.tail}" for one in blocks if not one.is_gone)
    return whole.rstrip("\n") + text[len(text.rstrip("\n")) :]


def _blocks(text: str) -> list[_Block]:
    """Return the blocks of a file; the first has the keys above all headers."""
    lines, starts, lead = re.findall(r"[^\n]*\n", text), [-1], list[str]()
    for at, line in enumerate(lines):
        if _HEADER.fullmatch(line) and _is_whole("".join(lines[max(starts[-1], 0) : at])):
            starts.append(at)
    blocks = []
    for start, end in pairwise((*starts, len(lines))):
        rows = lines[start + 1 : end]
        above = rows[_end(rows, "#") :] if end < len(lines) else []
        rows = rows[: len(rows) - len(above)]
        last = _end(rows, "#\n")
        last += len(list(takewhile(_is_comment, rows[last:]))) if last else 0
        header = lines[start] if start >= 0 else ""
        body, tail = "".join(rows[:last]), "".join(rows[last:])
        blocks.append(_Block(_path(header), "".join(lead), header, body, tail))
        lead = above
    return blocks


def _is_whole(text: str) -> bool:
    """Return whether a text does not end within a list or a string."""
    with suppress(ValueError):
        return tomllib.loads(text) is not None
    return False


def _is_comment(line: str) -> bool:
    return line.lstrip(" \t").startswith("#")


def _end(rows: Sequence[str], marks: str) -> int:
    """Return where the last rows begin that all start with one of some signs."""
    return len(rows) - len(list(takewhile(lambda row: row.lstrip(" \t")[0] in marks, reversed(rows))))


def _path(header: str) -> tuple[str, ...]:
    path, inside = [], tomllib.loads(header)
    while inside:
        ((key, inside),) = (inside[0] if isinstance(inside, list) else inside).items()
        path.append(key)
        inside = inside[0] if isinstance(inside, list) else inside
    return tuple(path)


def _update_members(
    blocks: list[_Block], path: tuple[str, ...], old: Sequence[_Table], new: Sequence[_Table]
) -> None:
    """Bring the blocks of one list up to date: those of the same name or place stay."""
    members = [block for block in blocks if block.path == path]
    if len(members) != len(old):
        return  # they stand within one line, which is edited as a whole
    left = dict(enumerate(old))
    before = blocks[blocks.index(members[0]) - 1] if members else None
    for place, one in enumerate(new):
        match = next((at for at, was in left.items() if was["name"] == one["name"]), None)
        if match is None:
            match = next((at for at, was in left.items() if _is_there(was, one, new)), None)
        if match is None:
            before = _insert(blocks, path, one, before)
            continue
        was = left.pop(match)  # one that is named by its place has another name in another place
        before = members[match]
        before.body = _edited(before.body, was if match == place else was | {"name": ""}, one)
    for at in left:
        members[at].is_gone = True
    if 0 in left and len(left) < len(members) and not any(block.lead for block in members[1:]):
        next(block for block in members if not block.is_gone).lead = members[0].lead  # it is of all


def _is_there(was: _Table, one: _Table, new: Sequence[_Table]) -> bool:
    """Return whether a member is an earlier one by another name."""
    is_named = any(other["name"] == was["name"] for other in new)
    return not is_named and any(key in one and one[key] == was.get(key) for key in _PLACES)


def _insert(
    blocks: list[_Block], path: tuple[str, ...], values: Mapping[str, Any], before: _Block | None = None
) -> _Block:
    """Add a block after a given one, or after those that usually stand before it."""
    name = ".".join(path)
    header = f"[[{name}]]\n" if path in _LISTS else f"[{name}]\n"
    body = "".join(f"{key} = {toml_value(value)}\n" for key, value in values.items())
    rank = _RANKS[path[0]]
    after = before or [one for one in blocks if not one.path or _RANKS[one.path[0]] <= rank][-1]
    block = _Block(path, "", header, body, after.tail)
    after.tail = "\n"
    blocks.insert(blocks.index(after) + 1, block)
    return block


def _edited(body: str, old: _Table, new: _Table) -> str:
    """Return the keys of a block with their new values; a key that gives way to another has its place."""
    import tomlkit

    table = tomlkit.parse(body)
    gone = [key for key in table if key in old and (key not in new or (table[key] == [] != new[key]))]
    come = [
        key for key, value in new.items() if key not in table and value != old.get(key) and _is_plain(value)
    ]
    for key, other in zip_longest(gone, come):
        if other is None:
            table.remove(key)
        else:
            table[key or other] = new[other]
    for key in table:
        if key in new:
            _put(table, key, old.get(key), new[key])
    text = tomlkit.dumps(table)
    for key, other in zip(gone, come, strict=False):
        text = re.sub(rf"^([ \t]*){key}\b", rf"\g<1>{other}", text, count=1, flags=re.MULTILINE)
    return str(text)


def _is_plain(value: object) -> bool:
    """Return whether a value stands in a line of its own, and not under a header."""
    return value != [] and not isinstance(value[0] if isinstance(value, list) else value, Mapping)


def _put(holder: Any, key: Any, old: Any, new: Any) -> None:
    """Replace a value, or only the parts of it that are others now."""
    here = holder[key]
    if old == new or here == new:
        return
    if isinstance(here, dict) and isinstance(old, dict):
        for inner in [inner for inner in here if inner in old and inner not in new]:
            del here[inner]
        for inner, value in new.items():
            if inner in here:
                _put(here, inner, old.get(inner), value)
            elif value != old.get(inner):
                here[inner] = value
    elif isinstance(new, list) and isinstance(old, list) and len(here) == len(old) == len(new):
        for place, value in enumerate(new):
            _put(here, place, old[place], value)
    else:
        holder[key] = new
