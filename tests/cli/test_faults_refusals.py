"""Command lines of refusals.toml: one message, exit code 2, nothing solved and nothing written."""

import re
import shlex
import tomllib
from importlib import import_module
from pathlib import Path

import pytest

from scenes import Run

REFUSALS = tomllib.loads(Path(__file__).with_name("refusals.toml").read_text(encoding="utf-8"))
CASES = [(f"{verb} {line}", words) for verb, lines in REFUSALS.items() for line, words in lines.items()]


@pytest.mark.parametrize(("command", "words"), CASES, ids=[command for command, _ in CASES])
def test_bad_input_is_refused_in_words(
    run: Run, tmp_path: Path, command: str, words: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before any work, by what was given and what is allowed; one fault is told once."""
    for solver in ("nullpose.study", "nullpose.solver"):  # the first keeps the solver that it finds
        monkeypatch.setattr(import_module(solver), "solve", None, raising=False)
    named = re.sub(r"\b[A-Z_]{4,}\b", lambda found: f"examples/{found[0].lower()}.toml", command)
    result = run(*shlex.split(named.replace("OUT", str(tmp_path / "out"))))
    told = " ".join(result.stderr.split())
    assert (result.exit_code, result.stdout) == (2, ""), told
    assert [word for word in words if word.replace("OUT", str(tmp_path / "out")) not in told] == [], told
    assert "Traceback" not in told
    assert told.count("allowed: ") <= 1
    made = [path.name for path in tmp_path.rglob("*")]
    assert made in ([], ["out"] * ("--mount" in command or "--reach" in command))
