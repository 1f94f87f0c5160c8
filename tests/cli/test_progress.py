"""Progress on standard error, of steps, proofs and studies: only when there is something to wait for."""

import io
import sys
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, strategies as st

import nullpose.cli.progress
from nullpose.cli.progress import GapBar, StudyBar, Ticker
from nullpose.study.monte_carlo import StudyProgress


class Clock:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def monotonic(self) -> float:
        """The time shown."""
        return self.now_s


class Terminal(io.StringIO):
    """Something that is written to, and says that it is a terminal."""

    def isatty(self) -> bool:
        """Yes."""
        return True


def _at(done: int, **values: Any) -> StudyProgress:
    usual = {"scenes": 2000, "rows": 20 * done, "failed": 0, "workers": 2, "rate": 12.5}
    return StudyProgress(done=done, **{**usual, **values})


Begin = Callable[[], Any]
BARS = [
    pytest.param(lambda: Ticker("work"), lambda step: (step, 30), "work: 10 of 30 (33 %)", id="steps"),
    pytest.param(
        lambda: GapBar(1e-6),
        lambda step: (1e-3, step),
        "proving: gap 1.0e-03 of 1.0e-06, 10 boxes",
        id="proof",
    ),
    pytest.param(
        StudyBar,
        lambda step: (_at(step * 50, failed=3),),
        "study: 500 of 2000 scenes (25 %), 12.5 scenes/s, 0:02:00 left, 2 workers, 3 failed",
        id="study",
    ),
]


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Replaces the clock that progress goes by."""
    clock = Clock()
    monkeypatch.setattr(nullpose.cli.progress, "time", clock)
    return clock


@pytest.mark.parametrize(("begin", "values", "line"), BARS)
def test_a_log_gets_a_line_now_and_then(
    begin: Begin, values: Any, line: str, clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    """Off a terminal, nothing in the first second, then a line every ten seconds, to standard error."""
    with begin() as bar:
        for step in range(9):
            clock.now_s += 0.1
            bar(*values(step))
        assert capsys.readouterr() == ("", "")
        clock.now_s = 101.0
        for step in range(2, 26):
            clock.now_s += 1.0
            bar(*values(step))
    out, err = capsys.readouterr()
    assert (out, len(err.splitlines())) == ("", 2)
    assert err.splitlines()[0] == line


@pytest.mark.parametrize(("begin", "values", "line"), BARS)
def test_a_terminal_gets_a_bar(
    begin: Begin, values: Any, line: str, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a terminal, long work draws a bar with the same words beside it."""
    terminal = Terminal()
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setattr(sys, "stderr", terminal)
    with begin() as bar:
        clock.now_s += 2.0
        bar(*values(5))
        bar(*values(10))
    what, words = line.split(": ", 1)
    assert what in terminal.getvalue()
    assert words in terminal.getvalue()


@pytest.mark.parametrize("on_terminal", [True, False])
def test_notes_are_told_at_once_and_once(
    on_terminal: bool, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What went wrong in a study, or is waited for, is a line of its own, above the bar if there is one."""
    told = Terminal() if on_terminal else io.StringIO()
    monkeypatch.setattr(sys, "stderr", told)
    with StudyBar() as bar:
        for _ in range(3):
            bar(_at(0, note="no worker yet"))
            clock.now_s += 2.0
        bar(_at(0, note="1 worker [here]"))
    for note in ("study: no worker yet", "study: 1 worker [here]"):
        assert told.getvalue().count(note) == 1


def test_the_bar_of_a_proof_is_logarithmic() -> None:
    """Each tenth of the gap is as far as the one before; the target is the end."""
    bar = GapBar(1e-6)
    bar(1e2, 1)
    assert [bar.closed(10.0**power) for power in (2, 0, -2, -4)] == pytest.approx([0.0, 0.25, 0.5, 0.75])
    assert bar.closed(1e-6) == bar.closed(1e-9) == bar.closed(0.0) == 1.0
    assert bar.closed(1e5) == 0.0


@given(
    gaps=st.lists(st.floats(0.0, 1e12), min_size=1, max_size=10),
    target=st.floats(1e-9, 10.0),
)
def test_the_bar_stays_on_the_bar(gaps: list[float], target: float) -> None:
    """Whatever gaps come, the share closed is between nothing and all, and grows as the gap closes."""
    bar = GapBar(target)
    for gap in gaps:
        bar(gap, 1)
    shares = [bar.closed(gap) for gap in sorted(gaps, reverse=True)]
    assert all(0.0 <= share <= 1.0 for share in shares)
    assert shares == sorted(shares)
