"""Progress and notices: on standard error, and only when there is something to wait for."""

import io
import sys

import pytest

import nullpose.cli.output
from nullpose.cli.output import Ticker, compiling_announced


class Clock:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def monotonic(self) -> float:
        """The time shown."""
        return self.now_s


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Replaces the clock that progress goes by."""
    clock = Clock()
    monkeypatch.setattr(nullpose.cli.output, "time", clock)
    return clock


def test_short_work_is_silent(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    """Within the first second nothing is shown."""
    with Ticker("work") as tick:
        for done in range(1, 11):
            clock.now_s += 0.05
            tick(done, 10)
    assert capsys.readouterr() == ("", "")


def test_a_log_gets_a_line_now_and_then(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    """Off a terminal, long work writes a line every ten seconds."""
    with Ticker("work") as tick:
        for done in range(1, 26):
            clock.now_s += 1.0
            tick(done, 25)
    out, err = capsys.readouterr()
    assert out == ""
    assert err == "work: 10 of 25 (40 %)\nwork: 20 of 25 (80 %)\n"


def test_a_terminal_gets_a_bar(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a terminal, long work draws a bar."""

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    with Ticker("work") as tick:
        clock.now_s += 2.0
        tick(1, 2)
        tick(2, 2)
    assert "work" in terminal.getvalue()
    assert "2/2" in terminal.getvalue()


def test_compiling_is_announced_once(capsys: pytest.CaptureFixture[str]) -> None:
    """Compilations inside the block are announced once, on standard error; none, not at all."""
    import numba

    with compiling_announced():
        pass
    assert capsys.readouterr() == ("", "")
    with compiling_announced():
        for increment in (1, 2):
            numba.njit(lambda x, step=increment: x + step)(1)
    out, err = capsys.readouterr()
    assert out == ""
    assert err == "Compiling kernels for this machine (once, about a minute) ...\n"
