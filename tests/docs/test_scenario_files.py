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


PLACES = "### Places: nodes, jammers and eavesdroppers"
POINTS = ("nodes", "jammers", "eavesdroppers")


def _resolved(entry: dict[str, Any]) -> dict[str, Any] | None:
    """The schema of the table that a key holds, or a list of; None for a value."""
    reference = entry.get("$ref") or entry.get("items", {}).get("$ref")
    return SCHEMA["$defs"][reference.rsplit("/", 1)[-1]] if reference else None


def _tables() -> dict[str, dict[str, Any]]:
    """Every table of a file with its schema, by its heading on the page; the top first."""
    found = {"### At the top": SCHEMA}
    pending = [("", SCHEMA)]
    while pending:
        path, table = pending.pop()
        for key, entry in table["properties"].items():
            inner = _resolved(entry)
            if inner is not None:
                name = f"{path}.{key}".removeprefix(".")
                brackets = ("[[", "]]") if "items" in entry else ("[", "]")
                found[f"### `{name.join(brackets)}`"] = inner
                pending.append((name, inner))
    return found


TABLES = _tables()
SHARED = set.intersection(*(set(TABLES[f"### `[[{name}]]`"]["properties"]) for name in POINTS))


def _section(heading: str) -> str:
    return re.split(r"\n##+ ", PAGE.split(heading)[1])[0]


def _rows(heading: str) -> dict[str, str]:
    rows = re.findall(r"^\| `\w+` \|.*$", _section(heading), flags=re.MULTILINE)
    return {row.split("`")[1]: row for row in rows}


def _keys(heading: str) -> dict[str, dict[str, Any]]:
    """The keys that hold a value, less those that points share, with their schemas."""
    shared = SHARED if any(f"[[{name}]]" in heading for name in POINTS) else set()
    return {
        key: entry
        for key, entry in TABLES[heading]["properties"].items()
        if key not in shared and _resolved(entry) is None
    }


def _numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?(?!\w)", text)]


def _limits(entry: dict[str, Any]) -> list[float] | None:
    """The least and the greatest number that a key takes, in however many lists; None for a text."""
    while "minimum" not in entry and "items" in entry:
        entry = entry["items"]
    return [entry["minimum"], entry["maximum"]] if "minimum" in entry else None


@pytest.mark.parametrize("heading", TABLES)
def test_every_key_has_a_row(heading: str) -> None:
    """Each key that holds a value has a row in its table's section, and no row is about anything else."""
    assert _rows(heading).keys() == _keys(heading).keys()


@pytest.mark.parametrize("heading", [*TABLES, PLACES])
def test_limits_are_those_of_the_program(heading: str) -> None:
    """The numbers in a row's last column are the limits of the schema; "as above" means the row before."""
    entries = TABLES["### `[[nodes]]`"]["properties"] if heading == PLACES else _keys(heading)
    rows = list(_rows(heading).values())
    for index, row in enumerate(rows):
        limits = _limits(entries[row.split("`")[1]])
        while row.rstrip("| ").endswith("as above"):
            index -= 1
            row = rows[index]
        if limits is not None:
            assert _numbers(row.rstrip("| ").rsplit("|", 1)[1])[-2:] == limits


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
