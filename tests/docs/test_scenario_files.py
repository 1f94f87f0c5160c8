"""The page on scenario files describes every key, with its limits, and its examples load."""

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

import nullpose

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "scenario-files.md").read_text(encoding="utf-8")
SCHEMA = nullpose.json_schema()


def _table(name: str) -> dict[str, Any]:
    """The schema of a table of the file; ``""`` is the top."""
    if not name:
        return SCHEMA
    entry = SCHEMA["properties"][name]
    reference = entry.get("$ref") or entry["items"]["$ref"]
    return SCHEMA["$defs"][reference.rsplit("/", 1)[-1]]


def _section(table: str) -> str:
    heading = {"": "### At the top", "nodes": "### `[[nodes]]`", "jammers": "### `[[jammers]]`"}.get(
        table, f"### `[{table}]`"
    )
    return re.split(r"\n##+ ", PAGE.split(heading)[1])[0]


def _numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?(?!\w)", text)]


@pytest.mark.parametrize("table", ["", "airspace", "receiver", "nodes"])
def test_every_key_has_a_row(table: str) -> None:
    """Each key that holds a value has a row in its table's section, and no row is about anything else."""
    keys = {
        key
        for key in _table(table)["properties"]
        if table or key not in ("airspace", "receiver", "nodes", "jammers")
    }
    assert set(re.findall(r"^\| `(\w+)` \|", _section(table), flags=re.MULTILINE)) == keys


def test_jammers_have_the_keys_of_nodes() -> None:
    """The page describes jammers by reference to nodes, so their keys must be the same."""
    assert _table("jammers")["properties"].keys() == _table("nodes")["properties"].keys()


@pytest.mark.parametrize(
    ("table", "key"),
    [
        (table, key)
        for table in ("airspace", "receiver", "nodes")
        for key, value in _table(table)["properties"].items()
        if value.get("type") in ("number", "array")
    ],
)
def test_limits_are_those_of_the_program(table: str, key: str) -> None:
    """The numbers in a row's last column are the limits of the schema; "as above" means the row before."""
    rows = re.findall(r"^\| `\w+` \|.*$", _section(table), flags=re.MULTILINE)
    row = next(row for row in rows if row.startswith(f"| `{key}` |"))
    while row.rstrip("| ").endswith("as above"):
        row = rows[rows.index(row) - 1]
    entry = _table(table)["properties"][key]
    entry = entry.get("items", entry)
    assert _numbers(row.rstrip("| ").rsplit("|", 1)[1])[-2:] == [entry["minimum"], entry["maximum"]]


def test_defaults_are_those_of_the_program() -> None:
    """The default that the page states for the keep-out radius is the one in force."""
    row = next(line for line in PAGE.splitlines() if line.startswith("| `keep_out_m` |"))
    assert f"| {_table('airspace')['properties']['keep_out_m']['default']} |" in row


def test_snippets_are_toml_that_loads() -> None:
    """A snippet on the page, put after the shipped ten-node scene, gives a scenario."""
    snippets = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    field = (ROOT / "examples" / "field.toml").read_text(encoding="utf-8")
    for snippet in snippets:
        text = "\n".join([field, *(line.strip() for line in snippet.splitlines())])
        nullpose.Scenario.from_dict(tomllib.loads(text))


@pytest.mark.parametrize("override", re.findall(r"^\| `([^`]+=[^`]+)` \|", PAGE, flags=re.MULTILINE))
def test_overrides_apply(override: str) -> None:
    """Every override in the table can be applied to the paper's scenario, and changes it."""
    scenario = nullpose.load(ROOT / "examples" / "paper.toml")
    assert nullpose.apply_overrides(scenario, [override]) != scenario
