"""Tables that the pages take from the program: keys of scenario and study files, options of a verb."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import typer

import nullpose
from nullpose.cli.app import app
from nullpose.scenario.json_schema import _TomlSchema
from nullpose.study.monte_carlo.spec import StudySpec

SCENARIO = nullpose.json_schema()
STUDY = StudySpec.model_json_schema(schema_generator=_TomlSchema)
CODE = re.compile(
    r"(?<![\w`])(--[a-z][a-z-]*|\[{1,2}[a-z][\w.]*\]{1,2}|(?:[\w*]+\.)*[a-z]+(?:_[a-z0-9]+)+(?:=[\w.]*\w)?)(?!\w)"
)
POINTS = ("nodes", "jammers", "eavesdroppers", "destination", "sources")


def table_schema(entry: dict[str, Any]) -> dict[str, Any] | None:
    """Find the schema of the table that a key holds, or a list of; None for a value."""
    name = (entry.get("$ref") or entry.get("items", {}).get("$ref", "")).rsplit("/", 1)[-1]
    if not name or name == "Distribution":  # or a number in its place
        return None
    return (SCENARIO["$defs"] | STUDY["$defs"])[name]


def schema_at(path: str) -> dict[str, Any]:
    """Find the schema of a table by its path: "", "airspace.no_fly", "study", "study.cases"."""
    first, _, rest = path.partition(".")
    schema, names = (STUDY, rest) if first == "study" else (SCENARIO, path)
    for name in names.split(".") if names else ():
        entry = schema["properties"][name]
        schema = table_schema(entry.get("anyOf", [entry])[-1])  # the last, where a name may stand for a table
    return schema


def keys_of(path: str) -> dict[str, dict[str, Any]]:
    """Collect the keys of a table that hold a value; "places" are those that all points share."""
    schema = schema_at("nodes" if path == "places" else path)
    is_case = path == "study.cases"  # whose tables have no sections of their own
    found = {key: entry for key, entry in schema["properties"].items() if is_case or not table_schema(entry)}
    if path in (*POINTS, "places"):
        shared = set.intersection(*(set(schema_at(name)["properties"]) for name in POINTS))
        found = {key: entry for key, entry in found.items() if (key in shared) == (path == "places")}
    required = schema.get("required", ())
    return {key: {**entry, "required": key in required} for key, entry in found.items()}


def allowed(entry: dict[str, Any]) -> str:
    """Describe the values that a key takes."""
    if table_schema(entry):
        return "a table"
    if "anyOf" in entry:
        return ", or ".join(map(allowed, entry["anyOf"]))
    if "$ref" in entry:
        return "a number, or a [distribution](#what-drawn-points-keep)"
    if "enum" in entry:
        return ", ".join(f'`"{value}"`' for value in entry["enum"])
    ends = [
        f"{entry[end]:g}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")
        for end in ("minimum", "maximum")
        if end in entry
    ]
    numbers = " to ".join(ends)
    if entry.get("type") == "boolean":
        return "true, false"
    if "items" not in entry:
        return numbers or "text"
    if "maxItems" not in entry:
        return "a table"
    least, most = entry["minItems"], entry["maxItems"]
    length = f"{least}" if least == most else f"{least} to {most:,}"
    inner = entry["items"]
    if inner["type"] == "integer":
        return "a whole number, or two"
    kind = "lists of" if "items" in inner else "texts" if inner["type"] == "string" else "numbers,"
    lists = f"{length} {kind} {allowed(inner) if 'minimum' in inner or 'items' in inner else ''}".rstrip(", ")
    return f"{numbers}, or {lists}" if numbers else lists


def default(entry: dict[str, Any]) -> str:
    """Describe what counts where the key is left out."""
    if entry["required"]:
        return "required"
    return "" if entry.get("default") is None else f"`{entry['default']}`"


def marked(text: str) -> str:
    """Put the names of keys, tables and options into code, and make the text fit for a cell."""
    text = " ".join(text.split()).replace("|", "\\|")
    return re.sub(CODE, r"`\1`", text)


def key_rows(path: str) -> Iterator[str]:
    """Yield the lines of the table of a table's keys."""
    yield from ("| key | what | default | allowed |", "|---|---|---|---|")
    for key, entry in keys_of(path).items():
        yield f"| `{key}` | {marked(entry['description'])} | {default(entry)} | {allowed(entry)} |"


def option_rows(verb: str) -> Iterator[str]:
    """Yield the lines of the table of a verb's options."""
    command: Any = typer.main.get_command(app)
    for name in verb.split():
        command = command.commands[name]
    yield from ("| option | what |", "|---|---|")
    for option in command.params:
        names = [name for name in (*option.opts, *option.secondary_opts) if name.startswith("--")]
        if names and not getattr(option, "hidden", False):
            metavar = f" {option.metavar}" if option.metavar else ""
            shown = option.show_default if isinstance(option.show_default, str) else option.default
            ending = f" Default: {shown}." if shown and shown is not True and not option.required else ""
            shown_names = ", ".join(f"`{name}{metavar}`" for name in names)
            yield f"| {shown_names} | {marked(option.help + ending)} |"
