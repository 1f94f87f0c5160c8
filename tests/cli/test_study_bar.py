"""Progress of a study: a bar on a terminal, lines in a log, and what is told besides."""

import io
import sys
from typing import Any

import pytest

from nullpose.cli import study_bar
from nullpose.cli.study_bar import StudyBar
from nullpose.study.monte_carlo import StudyProgress


def _at(done: int, **values: Any) -> StudyProgress:
    usual = {"scenes": 2000, "rows": 20 * done, "failed": 0, "workers": 2, "rate": 12.5}
    return StudyProgress(done=done, **{**usual, **values})


@pytest.fixture
def later(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A clock that is moved by hand."""
    now = [0.0]
    monkeypatch.setattr(study_bar.time, "monotonic", lambda: now[0])
    return lambda seconds: now.__setitem__(0, now[0] + seconds)


def test_a_line_now_and_then_in_a_log(later: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """Rate, time left, workers and failures, every ten seconds."""
    with StudyBar() as bar:
        bar(_at(10))
        later(11)
        bar(_at(500, failed=3))
        bar(_at(510))
        later(11)
        bar(_at(1000, workers=1, rate=0.0))
    assert capsys.readouterr().err.splitlines() == [
        "study: 500 of 2000 scenes (25 %), 12.5 scenes/s, 0:02:00 left, 2 workers, 3 failed",
        "study: 1000 of 2000 scenes (50 %), 1 worker, none failed",
    ]


def test_notes_are_told_at_once_and_once(later: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """What went wrong, or is waited for, is a line of its own."""
    with StudyBar() as bar:
        for _ in range(3):
            bar(_at(0, note="no worker yet"))
            later(1)
        bar(_at(0, note="1 worker"))
    assert capsys.readouterr().err.splitlines() == ["study: no worker yet", "study: 1 worker"]


def test_a_bar_on_a_terminal(later: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same numbers beside a bar; notes stand above it."""

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setenv("TERM", "xterm")
    with StudyBar() as bar:
        later(2)
        bar(_at(500, failed=1))
        bar(_at(500, failed=1, note="1 worker"))
    drawn = terminal.getvalue()
    assert "500/2000" in drawn
    assert "12.5 scenes/s, 0:02:00 left, 2 workers, 1 failed" in drawn
    assert "study: 1 worker" in drawn
