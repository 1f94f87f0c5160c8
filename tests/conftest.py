"""What every test runs under: figures without a screen, and the same hypothesis examples on every run."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

os.environ["MPLBACKEND"] = "Agg"

# Compiling a kernel inside an example would break any deadline.
settings.register_profile("house", derandomize=True, deadline=None)
settings.load_profile("house")

LONG_FILE_LINES = 350


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the source files that are getting long, before they reach the limit of tests/test_house.py."""
    source = Path(__file__).parents[1] / "src" / "nullpose"
    lengths = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in source.rglob("*.py")}
    long_files = {path: lines for path, lines in sorted(lengths.items()) if lines > LONG_FILE_LINES}
    if long_files:
        terminalreporter.section(f"source files over {LONG_FILE_LINES} lines")
        for path, lines in long_files.items():
            terminalreporter.line(f"{path.relative_to(source)}: {lines}")
