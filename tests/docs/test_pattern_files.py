"""What docs/antennas.md says of pattern files is what is read."""

import io
import re
from pathlib import Path

from rich.console import Console

from nullpose.antenna.files import read_pattern
from nullpose.antenna.summary import summary_of
from nullpose.report.pattern import pattern_view

ROOT = Path(__file__).parents[2]
SECTION = (ROOT / "docs" / "antennas.md").read_text(encoding="utf-8").split("## Reading a pattern file")[1]


def test_the_console_block_is_what_is_printed() -> None:
    """Line by line."""
    file, shown = re.findall(r"\$ nullpose antenna (\S+)\n(.*?)\n```", SECTION, flags=re.DOTALL)[0]
    console = Console(file=io.StringIO(), width=80, highlight=False)
    console.print(pattern_view(summary_of(read_pattern(ROOT / file))))
    printed = [line.rstrip() for line in console.file.getvalue().rstrip().splitlines()]
    assert shown.splitlines() == printed
