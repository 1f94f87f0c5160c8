"""The page on scenario files shows every key, and its examples load."""

import io
import re
import tomllib
from contextlib import redirect_stdout
from pathlib import Path

import pytest

import nullpose
from reference import key_rows, keys_of, schema_at, table_schema

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "scenario-files.md").read_text(encoding="utf-8")


def _tables(path: str = "") -> list[str]:
    """The paths of all tables that a file can have, from one on."""
    inner = {key: table_schema(entry) for key, entry in schema_at(path)["properties"].items()}
    names = [f"{path}.{key}".removeprefix(".") for key, schema in inner.items() if schema is not None]
    return [path, *(below for name in names for below in _tables(name))]


@pytest.mark.parametrize("path", ["places", *_tables()])
def test_every_table_is_on_the_page(path: str) -> None:
    """The page shows the keys of every table, and each with its meaning."""
    assert f"```{{keys}} {path}".strip() + "\n" in PAGE
    rows = list(key_rows(path))
    assert len(rows) == 2 + len(keys_of(path)) > 2
    assert all(entry["description"] for entry in keys_of(path).values())


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


def test_the_stream_prints_what_stands_below_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every step is certified, and the pose jumps from one side of the nodes' line to the other."""
    monkeypatch.chdir(ROOT)
    ((code, text),) = re.findall(r"```python\n(.*?)```\n+```text\n(.*?)```", PAGE, flags=re.DOTALL)
    with redirect_stdout(io.StringIO()) as printed:
        exec(compile(code, "scenario-files.md", "exec"), {"nullpose": nullpose})
    assert printed.getvalue() == text
