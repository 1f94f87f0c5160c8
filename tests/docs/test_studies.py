"""The page on studies describes every key of a spec and every column of a row, and nothing else."""

import re
from pathlib import Path

import pytest

from nullpose.scenario.section import Section
from nullpose.study.monte_carlo import StudyCase, StudySpec, load_spec
from nullpose.study.monte_carlo.distribution import Distribution
from nullpose.study.monte_carlo.layout import Eavesdroppers, Jammers, Nodes
from nullpose.study.monte_carlo.rows import schema_of
from nullpose.study.monte_carlo.scene import SceneBase

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")
DRAWN = "### `[nodes]`, `[jammers]`, `[eavesdroppers]`: what is drawn"


def _section(heading: str) -> str:
    return re.split(r"\n##+ ", PAGE.split(heading)[1])[0]


def _first_cells(text: str) -> list[set[str]]:
    """What stands in backticks in the first column, table by table."""
    tables: list[set[str]] = []
    for block in re.findall(r"(?:^\|.*\n)+", text, flags=re.MULTILINE):
        cells = [line.split("|")[1] for line in block.splitlines()[2:]]
        tables.append({name for cell in cells for name in re.findall(r"`([^`]+)`", cell)})
    return tables


def _keys(*kinds: type[Section]) -> set[str]:
    return {key for kind in kinds for key in kind.model_fields}


def test_keys_at_the_top() -> None:
    """Those that hold a value; tables have sections of their own."""
    tables = {"scene", "nodes", "jammers", "eavesdroppers", "cases", "sweep"}
    assert _first_cells(_section("### At the top")) == [_keys(StudySpec) - tables]


def test_keys_of_the_scene() -> None:
    """Those that no scenario file has; the others are named in the text."""
    (found,) = _first_cells(_section("### `[scene]`"))
    assert found == {"file", "files", "objective"}
    assert found <= _keys(SceneBase)


def test_keys_of_what_is_drawn() -> None:
    """Layouts of all kinds in the first table, distributions in the second."""
    points, distribution = _first_cells(_section(DRAWN))
    assert points == _keys(Nodes, Jammers, Eavesdroppers)
    assert distribution == _keys(Distribution)


def test_keys_of_a_case() -> None:
    """Each has a row."""
    assert _first_cells(_section("### `[[cases]]`")) == [_keys(StudyCase)]


def test_columns_of_a_row() -> None:
    """Each has a row in the table of columns."""
    pytest.importorskip("pyarrow")
    columns = _first_cells(_section("## The folder"))[1]
    assert columns == set(schema_of(load_spec(ROOT / "examples" / "study.toml")).names) - {
        "jammers.M.power_w"
    }
