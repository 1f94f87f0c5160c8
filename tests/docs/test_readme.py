"""The README's promises: its example prints what it says, its commands and links work, and it stays short."""

import contextlib
import io
import re
import shutil
from pathlib import Path

import pytest
from sizes import chosen
from typer.testing import CliRunner

import nullpose
from nullpose.cli.app import app
from nullpose.study.monte_carlo import load_spec

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
EXAMPLE = re.search(r"```python\n(.*?)```.*?```text\n(.*?)```", README, flags=re.DOTALL)
GALLERY = re.findall(r"^\| <img .*\| `(nullpose .*)` \|$", README, flags=re.MULTILINE)
SCREEN = re.search(r"```console\n(\$ nullpose solve .*?)```", README, flags=re.DOTALL)


def test_example_prints_what_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """Run from the root, the Python example prints the text below it, character for character."""
    assert EXAMPLE is not None
    code, shown = EXAMPLE.groups()
    monkeypatch.chdir(ROOT)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), {"__name__": "__main__"})
    assert printed.getvalue() == shown


def test_first_screen_is_real(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every line that the README shows of solve and verify is printed, but for the number of leaves."""
    assert SCREEN is not None
    command, *shown = SCREEN[1].splitlines()
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.chdir(ROOT)
    printed = ""
    for words in command.removeprefix("$ ").split(" && "):
        arguments = [
            str(tmp_path / word) if word == "paper.cert.json" else word for word in words.split()[1:]
        ]
        result = CliRunner().invoke(app, arguments)
        assert (words.split()[0], result.exit_code) == ("nullpose", 0)
        printed += result.stdout
    lines = [_without_leaves(line) for line in printed.splitlines()]
    assert [line for line in shown if line != "..." and _without_leaves(line) not in lines] == []


def test_the_pose_of_free_space_loses_in_the_city_what_it_says() -> None:
    """The command prints how far the pose is below the bound, and where the best one is."""
    command = re.search(r"`nullpose (evaluate examples/urban\.toml [^`]*)`", README)
    assert command is not None
    free = nullpose.load(ROOT / "examples" / "urban.toml").model_copy(update={"channel": None})
    best = nullpose.solve(free, certify=False).pose.position_m
    assert f"--pose={best[0]:.1f},{best[1]:.0f},{best[2]:.0f} " in command[1]
    printed = CliRunner().invoke(app, command[1].split()).stdout
    assert "10 dB below the bound" in printed
    higher_m = float(re.search(r"best pose: .* ([0-9.]+)\) m", printed)[1]) - best[2]
    assert f"{round(higher_m, -1):.0f} m higher" in README


def _without_leaves(line: str) -> str:
    return re.sub(r"\d+ leaves", "N leaves", line.rstrip())


@pytest.mark.parametrize("command", GALLERY)
def test_gallery_command_works(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every command of the gallery ends well; a study and the studio only read their file."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    _, verb, *rest = command.split()
    if verb == "study":
        load_spec(rest[1])
    elif verb == "studio":
        nullpose.load(rest[0])
    else:
        assert CliRunner().invoke(app, [verb, *rest]).exit_code == 0


@pytest.mark.parametrize("target", re.findall(r"(?:\]\(|src=\")([^):\"]+)[)\"]", README))
def test_link_leads_somewhere(target: str) -> None:
    """Every link to a file of the repository, pictures included, finds it."""
    assert (ROOT / target).is_file()


PAGE = (Path(__file__).parents[2] / "docs" / "recipes.md").read_text(encoding="utf-8")
RECIPES = {part.splitlines()[0]: part for part in PAGE.split("\n## ")}
SHORT = [
    i for i, title in enumerate(RECIPES) if title not in {"My jammer drives past", "A Monte Carlo table"}
]
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


@pytest.mark.parametrize("title", chosen(RECIPES, SHORT))
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
