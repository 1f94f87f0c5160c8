"""Undo and redo."""

from hypothesis import given, seed, strategies as st

from nullpose.scenario import Scenario
from nullpose.studio.case import CASES
from nullpose.studio.history import History
from nullpose.studio.view import View


def test_one_gesture_is_one_step(paper: Scenario) -> None:
    """All positions of one drag are undone together, and two drags apart."""
    history = History(View(scenario=paper))
    for drag in ("first", "second"):
        for step in range(5):
            east_m = {"first": 20.0, "second": 40.0}[drag] + step
            history = history.changed(history.present.moved(("jammers", 0), (east_m, 15.0, 4.0)), drag)
    assert history.present.scenario.jammers[0].position_m[0] == 44.0
    assert history.undone().present.scenario.jammers[0].position_m[0] == 24.0
    assert history.undone().undone().present.scenario == paper


def test_a_change_forgets_what_was_undone(paper: Scenario) -> None:
    """After undo and another change there is nothing to redo."""
    start = History(View(scenario=paper))
    undone = start.changed(start.present.with_power_db(5.0)).undone()
    assert undone.future
    assert not undone.changed(undone.present.with_power_db(7.0)).future


def test_no_change_is_no_step(paper: Scenario) -> None:
    """An equal view leaves the history as it was."""
    history = History(View(scenario=paper))
    assert history.changed(View(scenario=paper)) is history
    assert history.undone() is history
    assert history.redone() is history


@seed(0)
@given(choices=st.lists(st.integers(0, 3), max_size=12), back=st.integers(0, 15))
def test_redo_takes_back_undo(choices: list[int], back: int) -> None:
    """As many steps forward as back lead to the same view."""
    paper = Scenario.from_dict(_PAPER)
    history = History(View(scenario=paper))
    for choice in choices:
        history = history.changed(history.present.with_case(CASES[choice]))
    there = history
    steps = min(back, len(history.past))
    for _ in range(steps):
        there = there.undone()
    for _ in range(steps):
        there = there.redone()
    assert there.present == history.present
    assert len(there.past) == len(history.past)


def test_it_does_not_grow_without_end(paper: Scenario) -> None:
    """Only so many steps are kept."""
    history = History(View(scenario=paper))
    for i in range(300):
        history = history.changed(history.present.moved(("jammers", 0), (float(i), 15.0, 4.0)))
    assert len(history.past) == 200


_PAPER = {
    "airspace": {"altitude_m": [8.0, 30.0]},
    "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    "nodes": [
        {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0},
        {"position_m": [0.0, 50.0, 0.0], "power_w": 1.0},
    ],
    "jammers": [{"position_m": [17.0, 15.0, 4.0], "power_w": 1.0}],
}
