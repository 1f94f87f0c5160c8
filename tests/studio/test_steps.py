"""The power curve: its search can be ended before any of its poses."""

import pytest

from nullpose.scenario import Scenario
from nullpose.studio.steps import power_curves
from nullpose.studio.view import View


class Enough(BaseException):
    """Ends a curve."""


def test_a_curve_asks_before_every_search(paper: Scenario) -> None:
    """So that a moving hand never waits for more than one."""
    asked = 0

    def go_on() -> None:
        nonlocal asked
        asked += 1

    *growing, last = power_curves(1, View(scenario=paper), go_on)
    assert last.complete
    assert not any(curve.complete for curve in growing)
    assert asked == len(last.table.rows)
    sizes = [len(curve.table.rows) for curve in (*growing, last)]
    assert sizes == sorted(sizes)
    assert len(sizes) >= 4


def test_a_curve_ends_when_told(paper: Scenario) -> None:
    """At the search before which it was told."""
    asked = 0

    def go_on() -> None:
        nonlocal asked
        asked += 1
        if asked == 3:
            raise Enough

    with pytest.raises(Enough):
        next(power_curves(1, View(scenario=paper), go_on))
    assert asked == 3
