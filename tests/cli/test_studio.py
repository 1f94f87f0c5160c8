"""The verb ``studio``."""

import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from nullpose.cli.app import app


def test_a_missing_extra_ends_with_code_2(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without viser the verb says in one line how to install it."""
    monkeypatch.setitem(sys.modules, "viser", None)
    result = CliRunner().invoke(app, ["studio", str(Path(__file__).parents[2] / "examples" / "paper.toml")])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "pip install -e '.[studio]'" in result.stderr


def test_a_faulty_file_ends_with_code_2(tmp_path: Path) -> None:
    """A file at fault is refused before anything is opened, with its faults by path."""
    path = tmp_path / "broken.toml"
    path.write_text("[airspace]\naltitude_m = 3\n")
    result = CliRunner().invoke(app, ["studio", str(path)])
    assert result.exit_code == 2
    assert "airspace.altitude_m" in result.stderr
