"""What the command line's tests share: the scenario files and a way to run a verb."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from nullpose import compare, load
from nullpose.cli.app import app

ROOT = Path(__file__).parents[2]

Run = Callable[..., Result]
Process = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session", autouse=True)
def _kernels() -> None:
    """Compiles the kernels if they are not cached, so that no test meets the notice by chance."""
    for example in ("paper.toml", "field.toml"):
        compare(load(ROOT / "examples" / example), gap=1.0)


@pytest.fixture
def paper() -> str:
    """The paper's scenario file."""
    return str(ROOT / "examples" / "paper.toml")


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs a verb in this process, on a terminal wide enough that no line is broken."""
    monkeypatch.setenv("COLUMNS", "200")
    runner = CliRunner()
    return lambda *arguments: runner.invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def process() -> Process:
    """Runs the whole program in a process of its own."""
    environment = os.environ | {"COLUMNS": "200"}
    return lambda *arguments: subprocess.run(
        [sys.executable, "-m", "nullpose", *(str(argument) for argument in arguments)],
        capture_output=True,
        text=True,
        env=environment,
        check=False,
        timeout=600,
    )
