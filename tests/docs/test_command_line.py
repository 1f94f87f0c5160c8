"""The command line page names every verb and every option, and nothing that is not there."""

import re
from pathlib import Path

import pytest
import typer

from nullpose.cli.app import app

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
SHARED = PAGE.split("## Options that several verbs share")[1].split("\n## ")[0]


def _section(verb: str) -> str:
    return re.split(r"\n## ", PAGE.split(f"\n## {verb}\n")[1])[0]


def _options(verb: str) -> set[str]:
    return {
        name
        for parameter in COMMANDS[verb].params
        for name in (*parameter.opts, *parameter.secondary_opts)
        if name.startswith("--") and name != "--help"
    }


@pytest.mark.parametrize("verb", sorted(COMMANDS))
def test_every_option_is_on_the_page(verb: str) -> None:
    """An option of a verb is in the verb's own section, or in a row of the shared table that names it."""
    rows = [row for row in SHARED.splitlines() if f"`{verb}`" in row or "| all but" in row]
    described = set(re.findall(r"--[a-z-]+", _section(verb) + "\n".join(rows)))
    assert _options(verb) <= described


def test_nothing_else_is_on_the_page() -> None:
    """Every option that the page names belongs to a verb or to the program."""
    program = {name for parameter in typer.main.get_command(app).params for name in parameter.opts}
    known = ({"--help"} | program).union(*(_options(verb) for verb in COMMANDS))
    assert set(re.findall(r"(?<![-\w])--[a-z][a-z-]*", PAGE)) <= known


def test_every_verb_is_in_the_overview() -> None:
    """The table at the top has a row for each verb and no other."""
    assert set(re.findall(r"^\| \[`([a-z]+)", PAGE, flags=re.MULTILINE)) == set(VERBS)
