"""The recipes work: each runs in a folder that has its files and the page's first scene, and nothing else."""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from nullpose.cli.app import app

PAGE = (Path(__file__).parents[2] / "docs" / "recipes.md").read_text(encoding="utf-8")
RECIPES = {part.splitlines()[0]: part for part in PAGE.split("\n## ")}
WIDE = ["--gap", "0.1"]
QUICK = {"solve": WIDE, "sweep": WIDE, "compare": ["--fast"]}


def _blocks(recipe: str) -> list[tuple[str, str]]:
    """Returns the language and the text of each block, in the page's order."""
    return re.findall(r"```(toml|console|python)\n(.*?)```", recipe, flags=re.DOTALL)


def _run(command: str) -> None:
    """Runs a command in this process, with a wide gap or, where arrays are compared, without proofs."""
    _, verb, *rest = command.split()
    quick = [] if "--gap" in rest else QUICK.get(verb, [])
    result = CliRunner().invoke(app, [verb, *rest, *quick])
    assert result.exit_code == 0, f"{command}: {result.output}"


@pytest.mark.parametrize("title", RECIPES)
def test_recipe_works(title: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands and programs run in the page's order, and every output that the recipe names is there."""
    monkeypatch.chdir(tmp_path)
    for language, text in [_blocks(PAGE)[0], *_blocks(RECIPES[title])]:
        if language == "toml":
            Path(text.split("\n")[0].removeprefix("# ")).write_text(text, encoding="utf-8")
        elif language == "console":
            for command in re.findall(r"^\$ (.*)$", text, flags=re.MULTILINE):
                _run(command)
        else:
            exec(compile(text, "recipes.md", "exec"), {})
    for name in re.findall(r"[\w/]+\.(?:svg|png|csv|html|pdf|geojson|plan)\b", RECIPES[title]):
        assert (tmp_path / name).is_file(), name
