"""Progress of a proof: on standard error, and only when there is something to wait for."""

import io
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

import nullpose.cli.gap_bar
from nullpose.cli.gap_bar import GapBar


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
    monkeypatch.setattr(nullpose.cli.gap_bar, "time", clock)
    return clock


def test_short_proofs_are_silent(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    """Within the first second nothing is shown."""
    with GapBar(1e-6) as bar:
        for step in range(9):
            clock.now_s += 0.1
            bar(10.0**-step, 100 * step)
    assert capsys.readouterr() == ("", "")


def test_a_log_gets_a_line_now_and_then(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    """Off a terminal, a long proof writes a line every ten seconds."""
    with GapBar(1e-6) as bar:
        for step in range(25):
            clock.now_s += 1.0
            bar(1e-3, step)
    out, err = capsys.readouterr()
    assert out == ""
    assert err == ("proving: gap 1.0e-03 of 1.0e-06, 9 boxes\nproving: gap 1.0e-03 of 1.0e-06, 19 boxes\n")


def test_a_terminal_gets_a_bar(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a terminal, a long proof draws a bar with the gap and the boxes."""

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    terminal = Terminal()
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setattr(sys, "stderr", terminal)
    with GapBar(1e-6) as bar:
        clock.now_s += 2.0
        bar(1e-2, 12)
        bar(1e-4, 345)
    assert "proving" in terminal.getvalue()
    assert "gap 1.0e-04 of 1.0e-06, 345 boxes" in terminal.getvalue()


def test_the_bar_is_logarithmic() -> None:
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


def test_errors_pass_through() -> None:
    """An exception during a proof is not swallowed."""

    def interrupted() -> None:
        with GapBar(1e-6) as bar:
            bar(1.0, 1)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
