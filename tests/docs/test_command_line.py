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
