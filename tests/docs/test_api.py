"""The pages on Python name every public function, describe every public name, and their snippets run."""

import inspect
import re
from pathlib import Path

import pytest
import typer
from matplotlib import pyplot

import nullpose
from nullpose.cli.app import app

ROOT = Path(__file__).parents[2]
OVERVIEW = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
PAGES = {path.stem: path.read_text(encoding="utf-8") for path in sorted((ROOT / "docs" / "api").glob("*.md"))}
FUNCTIONS = [name for name in nullpose.__all__ if inspect.isfunction(getattr(nullpose, name))]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_public_function_is_in_the_overview(name: str) -> None:
    """Its call stands in the table."""
    assert f"`nullpose.{name}(" in OVERVIEW


def test_every_page_is_in_the_overview() -> None:
    """The overview leads to each page, and to no other."""
    assert set(re.findall(r"^api/(\w+)$", OVERVIEW, flags=re.MULTILINE)) == set(PAGES)


@pytest.mark.parametrize("page", [page for page, text in PAGES.items() if "```python" in text])
def test_snippets_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the paper's scene, and one in motion, each snippet of a page runs, from top to bottom."""
    scenario = nullpose.load(ROOT / "examples" / "paper.toml")
    vehicle = ["airframe.preset=omnidirectional", "airframe.speed_max_m_s=5", "time.step_s=10"]
    moving = nullpose.load(ROOT / "examples" / "moving_jammer.toml", overrides=vehicle)
    names = {
        "nullpose": nullpose,
        "Path": Path,
        "scenario": scenario,
        "scenarios": [scenario],
        "moving": moving,
    }
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text("nodes = 1\n", encoding="utf-8")
    for snippet in re.findall(r"```python\n(.*?)```", PAGES[page], flags=re.DOTALL):
        exec(compile(snippet, f"docs/api/{page}.md", "exec"), names)
    pyplot.close("all")


PAGE = (Path(__file__).parents[2] / "docs" / "command-line.md").read_text(encoding="utf-8")
VERBS = typer.main.get_command(app).commands
COMMANDS = {
    " ".join((verb, *rest)): command
    for verb, group in VERBS.items()
    for rest, command in (
        {(name,): inner for name, inner in group.commands.items()}
        if hasattr(group, "commands")
        else {(): group}
    ).items()
}
PARAMETERS = [parameter for command in COMMANDS.values() for parameter in command.params]
OPTIONS = {name for parameter in PARAMETERS for name in (*parameter.opts, *parameter.secondary_opts)}


@pytest.mark.parametrize("verb", [verb for verb in COMMANDS if verb != "schema"])
def test_every_verb_shows_its_options(verb: str) -> None:
    """A verb's section has the table of its options, and each has a help text."""
    assert f"```{{options}} {verb}\n" in PAGE.split(f"\n## {verb}\n")[1].split("\n## ")[0]
    assert not [option.name for option in COMMANDS[verb].params if not option.help]


def test_nothing_else_is_on_the_page() -> None:
    """Every option that the page names belongs to a verb or to the program."""
    program = {name for parameter in typer.main.get_command(app).params for name in parameter.opts}
    known = {"--help", *program, *OPTIONS}
    assert set(re.findall(r"(?<![-\w])--[a-z][a-z-]*", PAGE)) <= known


def test_every_verb_is_in_the_overview() -> None:
    """The table at the top has a row for each verb and no other."""
    assert set(re.findall(r"^\| \[`([a-z]+)", PAGE, flags=re.MULTILINE)) == set(VERBS)
