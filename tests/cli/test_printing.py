"""What is printed: letters that an encoding lacks are replaced, and lines end between words."""

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from nullpose.cli import printing

EXAMPLES = Path(__file__).parents[2] / "examples"
NAME = "Größe \N{MINUS SIGN} ∞ ☃"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns a folder with a scenario whose file, title and node have names beyond ASCII."""
    folder = tmp_path_factory.mktemp("words")
    text = (EXAMPLES / "paper.toml").read_text(encoding="utf-8").replace('"S1"', '"Knötchen"')
    title = text.index("name = "), text.index("\n", text.index("name = "))
    (folder / "ü.toml").write_text(f'{text[: title[0]]}name = "{NAME}"{text[title[1] :]}', encoding="utf-8")
    return folder


@pytest.mark.parametrize(
    ("encoding", "arguments", "code"),
    [
        ("ascii", ("check", "ü.toml"), 0),
        ("cp1252", ("check", "ü.toml"), 0),
        ("ascii", ("check", "ü.toml", "--json"), 0),
        ("ascii", ("check", "ü.toml", "--set", "nodes.Knötchen.power_w=0"), 2),
        ("cp1252", ("check", "miß☃.toml"), 2),
        ("ascii", ("solve", "ü.toml", "--fast", "--figure", "∞.svg"), 0),
        ("ascii", ("map", "ü.toml", "--fast", "--cells", "5", "--out", "☃"), 0),
        ("ascii", ("solve", "ü.toml", "--schäme", "x"), 2),
        ("ascii", ("☃",), 2),
    ],
)
def test_an_encoding_that_lacks_letters(
    folder: Path, arguments: tuple[str, ...], code: int, encoding: str
) -> None:
    """Every verb ends as it does elsewhere, without a traceback, and what it prints is in the encoding."""
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    command = [sys.executable, "-m", "nullpose", *arguments]
    done = subprocess.run(command, capture_output=True, env=environment, cwd=folder, check=False, timeout=600)
    assert done.returncode == code
    assert b"Traceback" not in done.stderr
    shown, _ = done.stdout.decode(encoding), done.stderr.decode(encoding)
    if "--json" not in arguments and code == 0 and arguments[0] != "map":
        assert ("Gro?e - inf ?" if encoding == "ascii" else "Größe - inf ?") in shown
    if "∞.svg" in arguments:
        (figure,) = folder.glob("*.svg")
        assert "DOCTYPE" in figure.read_text(encoding="utf-8")


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
