"""The page on studies describes every key of a spec and every column of a row, and nothing else."""

import contextlib
import io
import re
from pathlib import Path

import pytest
from sizes import and_slow

from nullpose.study.monte_carlo import load_spec, run_study
from nullpose.study.monte_carlo.distribution import Distribution
from nullpose.study.monte_carlo.rows import schema_of
from reference import key_rows, keys_of

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


@pytest.mark.parametrize("path", ["study", "study.nodes", "study.buildings", "study.cases"])
def test_keys_are_on_the_page(path: str) -> None:
    """The page shows the keys of a spec, each with its meaning."""
    assert f"```{{keys}} {path}\n" in PAGE
    assert len(list(key_rows(path))) == 2 + len(keys_of(path)) > 2
    assert all(entry["description"] for entry in keys_of(path).values())


def test_keys_of_a_distribution() -> None:
    """Each has a row, and so have those of the scene that no scenario file has."""
    assert _first_cells(_section(DRAWN)) == [set(Distribution.model_fields)]
    assert _first_cells(_section("### `[scene]`")) == [{"file", "files", "objective"}]


def test_columns_of_a_row() -> None:
    """Each has a row in the table of columns."""
    columns = _first_cells(_section("## The folder"))[1]
    always = set(schema_of(load_spec(ROOT / "examples" / "study.toml")).names) - {"jammers.M.power_w"}
    assert columns == always | {"least_tilt_deg", "too_little_deg"}


@pytest.mark.parametrize("scenes", and_slow([20], [200]))
def test_the_study_among_buildings(scenes: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Run as the page says, the program prints what the page shows; of fewer scenes, other numbers."""
    monkeypatch.chdir(tmp_path)
    spec = load_spec(ROOT / "examples" / "study-city.toml")
    run_study(spec.model_copy(update={"scenes": scenes}), "out/city", workers=0)
    section = PAGE.split("## A study among random buildings")[1]
    program, shown = (
        re.split(f"```{language}\n(.*?)```", section, flags=re.DOTALL)[1] for language in ("python", "text")
    )
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(compile(program, "studies.md", "exec"), {})
    words = (re.sub(r"[-\d.]+", "#", text) if scenes < 200 else text for text in (printed.getvalue(), shown))
    assert next(words) == next(words)
