"""The README's promises: its example prints what it says, its links lead somewhere, and it stays short."""

import contextlib
import io
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
EXAMPLE = re.search(r"```python\n(.*?)```.*?```text\n(.*?)```", README, flags=re.DOTALL)


def test_example_prints_what_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """Run from the root, the Python example prints the text below it, character for character."""
    assert EXAMPLE is not None
    code, shown = EXAMPLE.groups()
    monkeypatch.chdir(ROOT)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), {"__name__": "__main__"})
    assert printed.getvalue() == shown


def test_example_is_short() -> None:
    """The example has at most twelve lines of code."""
    assert EXAMPLE is not None
    assert len([line for line in EXAMPLE[1].splitlines() if line]) <= 12


def test_readme_is_short() -> None:
    """The README has at most 120 lines."""
    assert len(README.splitlines()) <= 120


@pytest.mark.parametrize("target", re.findall(r"\]\(([^):]+)\)", README))
def test_link_leads_somewhere(target: str) -> None:
    """Every link to a file of the repository, pictures included, finds it."""
    assert (ROOT / target).is_file()
