"""What commands print is what stands in transcripts.txt, numbers within rounding; tables keep to a width.

After a change of words: NULLPOSE_TRANSCRIBE=1 .venv/bin/pytest tests/cli/test_printing_transcripts.py
"""

import os
import re
import shlex
from pathlib import Path

import pytest

from scenes import Run

FILE = Path(__file__).with_name("transcripts.txt")
BLOCKS = re.split(r"^(?=\$ )", FILE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
NUMBER = re.compile(r"-?\d[\d,]*\.?\d*(?:e[-+]?\d+)?")
# told on a slow machine only
WAITING = re.compile(r"^Compiling kernels|^proving: |: \d+ of \d+ \(")
# how far a proof came, which changes with the solver; other tests hold bounds to what they bound
EFFORT = re.compile(r"^(?:upper bound|boxes checked|.*relative gap) .*", re.MULTILINE)


def parts(text: str) -> tuple[str, list[float]]:
    """Return a text without its numbers, its rules of one length, and the numbers."""
    text = EFFORT.sub(lambda line: NUMBER.sub("#", line[0]), re.sub(r"search: .*", "search", text))
    text = re.sub(r"─+", "─", text)
    return " ".join(NUMBER.sub("#", text).split()), [float(x.replace(",", "")) for x in NUMBER.findall(text)]


@pytest.mark.parametrize("block", BLOCKS, ids=[each.partition("\n")[0] for each in BLOCKS])
def test_what_is_printed(block: str, run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Words and numbers of each command on both streams; no line is too long, and nothing is not a number."""
    command, printed = block.partition("\n")[0], ""
    width = 80 if "compare" in command else 120
    monkeypatch.setenv("COLUMNS", str(width))
    for words in command.removeprefix("$ ").split(" && "):
        result = run(*shlex.split(words.replace("OUT", str(tmp_path)))[1:])
        assert result.exit_code == 0, result.output
        notices = [line for line in result.stderr.splitlines() if WAITING.search(line)]
        lines = [line.rstrip() for line in result.output.splitlines() if line not in notices]
        printed += "\n".join(lines) + "\n"
    assert not re.search(r"\bnan\b|\binf\b", printed)
    assert [line for line in printed.splitlines() if len(line) > width and "/" not in line] == []
    printed = printed.replace(str(tmp_path), "OUT")
    if os.environ.get("NULLPOSE_TRANSCRIBE"):
        FILE.write_text(FILE.read_text("utf-8").replace(block, f"{command}\n{printed}\n"), "utf-8")
        return
    (words, numbers), (expected, known) = parts(printed), parts(block.partition("\n")[2])
    assert words == expected
    assert "--node-limit" in command or numbers == pytest.approx(known, rel=1e-3, abs=2e-3)
