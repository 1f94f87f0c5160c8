"""A scenario as the text of the file that it is from: brought up to date, everything else as it was."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from nullpose.files import PlainTable
from nullpose.scenario import Scenario
from nullpose.scenario.origin import POINT_LISTS, located
from nullpose.scenario.toml_file import tables_of

_FILES = re.compile(r"^[ \t]*(?:airspace\.)?(?:nodes|geofence|no_fly)_from\b.*\n", re.MULTILINE)
_BUILDINGS_FILE = re.compile(r"^[ \t]*buildings_from\b", re.MULTILINE)
_HEADER = re.compile(r"^([ \t]*\[\[?[ \t]*[\"'A-Za-z].*\n)", re.MULTILINE)  # and no line of a list of numbers
_PARTS = re.compile(  # keys with the comments directly below, what follows up to a blank line, the rest
    r"((?:(?s:.*)^[ \t]*[^#\s].*\n(?:(?:[ \t]*#.*\n)+(?=[ \t]*\n))?)?)((?:(?s:.*)^[ \t]*\n)?)((?s:.*))",
    re.MULTILINE,
)
_LISTS = ("no_fly", "buildings", *POINT_LISTS)
_PATHS = (  # in the order that is usual in a file
    "",
    *(path for key in Scenario.model_fields for path in (key, *["airspace.no_fly"] * (key == "airspace"))),
)


@dataclass(slots=True)
class _TomlBlock:
    """A table of a file: what stands before it, the comments directly above it, its header, its keys."""

    path: str
    gap: str
    lead: str
    header: str
    body: str


def toml_like(text: str, scenario: Scenario) -> str:
    """Return the text of a file, brought up to date with a scenario: its comments and its order are kept.

    A point or zone that is gone takes the comments directly above it along. What the text names other files
    for is stated in it.

    Args:
        text: of the file that the scenario is from. If it is none, the result is the scenario's own text.
        scenario: what the result loads as.
    """
    with suppress(Exception):  # whatever the text is, the scenario can be saved
        plain = _without_files(text.removeprefix("\ufeff").replace("\r\n", "\n"))
        found = _updated(plain, _stated_values(tables_of(plain), scenario.to_dict()), scenario.to_dict())
        if Scenario.from_dict(tables_of(found)) == scenario:
            return found.replace("\n", "\r\n") if "\r\n" in text else found
    return scenario.to_toml()


def _without_files(text: str) -> str:
    """Return the text without the keys that name files, and without the tables of files of buildings."""
    blocks = _blocks(f"{text}\n")
    for block in blocks:
        if block.path == "buildings" and _BUILDINGS_FILE.search(block.body):
            block.header = block.body = ""
    return _FILES.sub("", _joined(blocks)[:-1])


def _joined(blocks: list[_TomlBlock]) -> str:
    return "".join(f"{block.gap}{block.lead}{block.header}{block.body}" for block in blocks)


def _stated_values(raw: PlainTable, new: PlainTable) -> PlainTable:
    """Return the plain values of what a file states by itself, without the files that it names."""
    if "file" in raw.get("antenna", {}):
        raw["antenna"].setdefault("harmonics", [[-1.0]])  # in place of those in the file
    old = Scenario.from_dict({"nodes": new["nodes"]} | dict(located(raw))).to_dict()
    if not all("lat_deg" in point for key in POINT_LISTS for point in new.get(key, [])):
        for point in (point for key in POINT_LISTS for point in old.get(key, [])):
            if "lat_deg" in point:
                del point["position_m"]  # where a point is in metres, all state theirs
    return old if "nodes" in raw else old | {"nodes": []}


def _updated(text: str, old: PlainTable, new: PlainTable) -> str:
    blocks = _blocks(f"{text}\n")
    for path in _PATHS:
        _update(blocks, path, _tables(old, path), _tables(new, path))
    return _joined(blocks).rstrip("\n") + text[len(text.rstrip("\n")) :]


def _blocks(text: str) -> list[_TomlBlock]:
    """Return the blocks of a file; the first has the keys above all headers, the last what ends the file."""
    texts = _HEADER.split(text)
    bodies, gaps, leads = zip(*(_PARTS.findall(part)[0] for part in texts[::2]), strict=True)
    headers = ["", *texts[1::2], ""]
    paths = [re.sub(r"#.*|[^\w.]", "", header) for header in headers]
    return list(map(_TomlBlock, paths, ["", *gaps], ["", *leads], headers, [*bodies, ""]))


def _tables(values: Any, path: str) -> list[PlainTable]:
    """Return the tables of a path, none if there are none."""
    for key in path.split(".") if path else ():
        values = values.get(key, [])
    return [table for table in (values if isinstance(values, list) else [values]) if isinstance(table, dict)]


def _update(blocks: list[_TomlBlock], path: str, old: list[PlainTable], new: list[PlainTable]) -> None:
    """Bring the tables of one path up to date."""
    members, stay = [block for block in blocks[:-1] if block.path == path], _staying(old, new)
    if len(members) != len(old):
        return  # they stand in a key of another table, and are edited with it
    if 0 not in stay and stay and not any(block.lead for block in members[1:]):
        members[min(stay)].lead = members[0].lead  # a comment above the first only is of all
    for at, block in enumerate(members):
        if at in stay:  # a name that was given by the place does not go along to another place
            was = old[at] | ({} if stay[at] == at else {"name": ""})
            block.body = block.body if was == new[stay[at]] else _edited(block.body, was, new[stay[at]])
        else:
            block.gap = block.gap if "#" in block.gap else ""  # a comment that stands by itself stays
            block.lead = block.header = block.body = ""
    for table in (table for place, table in enumerate(new) if place not in stay.values()):
        before = [path] if members else _PATHS[: _PATHS.index(path) + 1]
        after = max(at for at, block in enumerate(blocks[:-1]) if block.path in before)
        header = f"[[{path}]]\n" if "name" in table else f"[{path}]\n"
        blocks.insert(after + 1, _TomlBlock(path, "\n", "", header, _edited("", {}, table)))


def _staying(old: list[PlainTable], new: list[PlainTable]) -> dict[int, int]:
    """Map the tables that stay from old place to new: those of the same name, or renamed in place."""
    before, after = ([table.get("name") for table in tables] for tables in (old, new))
    return {
        at: after.index(name) if name in after else at
        for at, name in enumerate(before)
        if name in after or (at < len(after) and after[at] not in before)
    }


def _edited(body: str, old: PlainTable, new: PlainTable) -> str:
    """Return the keys of a table with their new values; a key that gives way to another has its place."""
    import tomlkit

    table = tomlkit.parse(body)
    gone = [key for key in table if key in old and (key not in new or table[key] == [] != new[key])]
    come = [
        key
        for key, value in new.items()
        if key not in (*table, *_LISTS) and not isinstance(value, dict) and value != old.get(key)
    ]
    for key, other in zip(gone, come, strict=False):
        body = re.sub(rf"^([ \t]*){key}\b", rf"\g<1>{other}", body, count=1, flags=re.MULTILINE)
    table = tomlkit.parse(body)
    for key in gone[len(come) :]:
        table.remove(key)
    table.update({key: new[key] for key in come})
    for key in table.keys() & new.keys():
        _put(table, key, old.get(key), new[key])
    return str(tomlkit.dumps(table))


def _put(holder: Any, key: str | int, old: object, new: object) -> None:
    """Replace a value, or of a list only the parts of it that are others now."""
    if isinstance(new, list) and isinstance(old, list) and len(holder[key]) == len(old) == len(new):
        for place, value in enumerate(new):
            _put(holder[key], place, old[place], value)
    elif old != new and holder[key] != new:
        holder[key] = new
