"""What is printed: letters that an encoding lacks are replaced, and lines end between words."""

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from sizes import chosen

from nullpose.cli import printing
from scenes import EXAMPLES

NAME = "Größe \N{MINUS SIGN} ∞ ☃"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Returns a folder with a scenario whose file, title and node have names beyond ASCII."""
    text = (EXAMPLES / "paper.toml").read_text(encoding="utf-8").replace('"S1"', '"Knötchen"')
    title = text.index("name = "), text.index("\n", text.index("name = "))
    (tmp_path / "ü.toml").write_text(f'{text[: title[0]]}name = "{NAME}"{text[title[1] :]}', encoding="utf-8")
    return tmp_path


# A fork for each command, so that nothing is imported twice.
FORKS = """
import json, os, sys
import nullpose.solver.api, nullpose.report.scenario
from nullpose.cli.app import main
for number, words in enumerate(json.loads(sys.argv[1])):
    if not os.fork():
        for stream, name in (1, "out"), (2, "err"):
            os.dup2(os.open(f"{number}.{name}", os.O_CREAT | os.O_WRONLY), stream)
        sys.argv[1:] = words
        main()
        sys.exit()
    print(os.waitstatus_to_exitcode(os.wait()[1]))
"""
SHOWN = {"ascii": "Gro?e - inf ?", "cp1252": "Größe - inf ?"}
COMMANDS: dict[str, list[tuple[int, tuple[str, ...]]]] = {
    "cp1252": [(0, ("check", "ü.toml")), (2, ("check", "miß☃.toml"))],
    "ascii": [
        (0, ("check", "ü.toml")),
        (0, ("check", "ü.toml", "--json")),
        (2, ("check", "ü.toml", "--set", "nodes.Knötchen.power_w=0")),
        (0, ("solve", "ü.toml", "--fast", "--figure", "∞.svg", "--export", "☃.tum")),
        (2, ("solve", "ü.toml", "--schäme", "x")),
        (2, ("☃",)),
    ],
}


@pytest.mark.parametrize("encoding", chosen(COMMANDS, [1]))
def test_an_encoding_that_lacks_letters(folder: Path, encoding: str) -> None:
    """Every verb ends as it does elsewhere, without a traceback, and what it prints is in the encoding."""
    codes, words = zip(*COMMANDS[encoding], strict=True)
    done = subprocess.run(
        [sys.executable, "-c", FORKS, json.dumps(words)],
        capture_output=True,
        env=os.environ | {"PYTHONIOENCODING": encoding},
        cwd=folder,
        timeout=600,
    )
    assert tuple(map(int, done.stdout.split())) == codes
    for number, (code, options) in enumerate(COMMANDS[encoding]):
        shown, told = ((folder / f"{number}.{name}").read_bytes().decode(encoding) for name in ("out", "err"))
        assert "Traceback" not in told
        if code == 0 and "--json" not in options:
            assert SHOWN[encoding] in shown
    if encoding == "ascii":
        assert "DOCTYPE" in (folder / "∞.svg").read_text(encoding="utf-8")
        assert (folder / "☃.tum").exists()


@pytest.mark.parametrize("width", [20, 40, 80])
def test_sentences_break_between_words(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a terminal no line is longer than it, and each number and indented name is whole."""
    sentence = (
        "proved: gives every node an SINR above 0.876032032 (-0.5748001 dB), within 1.00e-06 of it\n"
        "  airspace.no_fly[0].centre_m: given -12.25, 30.5"
    )

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    shown = Terminal()
    monkeypatch.setattr(sys, "stdout", shown)
    monkeypatch.setenv("COLUMNS", str(width))
    printing.say(sentence)
    lines = shown.getvalue().splitlines()
    assert shown.getvalue().split() == sentence.split()
    assert all(len(line) <= width or len(line.split()) == 1 for line in lines)
    shown.truncate(0)
    shown.seek(0)
    printing.say(sentence, broken=False)
    assert shown.getvalue() == f"{sentence}\n"
