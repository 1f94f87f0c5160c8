"""Tabs that come back go on where they were."""

import numpy as np
import pytest

from nullpose.scenario import Scenario
from nullpose.studio.autosave import MOST_KEPT, Autosave, Left
from nullpose.studio.history import History
from nullpose.studio.view import View


@pytest.fixture
def first(paper: Scenario) -> Left:
    """What a page leaves after one step."""
    return _moved(Left(History(View(scenario=paper)), np.ones(3), np.zeros(3), {}), 1.0)


def _moved(left: Left, east_m: float) -> Left:
    history = left.history
    return left._replace(history=history.changed(history.present.moved(("nodes", 0), (east_m, 0.0, 0.0))))


def test_a_tab_that_ended_goes_on_where_it_was(first: Left) -> None:
    """With all that can be undone; another tab begins anew, and so does one without a name."""
    saved = Autosave()
    saved.end("tab", first, [])
    saved.end("", first, [])
    assert saved.begin("other", []) is None
    assert saved.begin("", [first]) is None
    assert saved.begin("tab", []) is first


def test_a_tab_that_is_back_before_it_ended_goes_on_from_its_live_page(first: Left) -> None:
    """What the old page leaves is not kept then; else the next reload would go back to it."""
    saved = Autosave()
    assert saved.begin("tab", [first]) is first
    saved.end("tab", first, [first.history])
    later = _moved(first, 2.0)
    assert saved.begin("tab", [later]) is later


def test_a_doubled_tab_begins_with_a_copy_and_both_are_kept_apart(first: Left) -> None:
    """The first one, changed since, leaves its own state."""
    saved = Autosave()
    assert saved.begin("tab", [first]) is first
    changed = _moved(first, 3.0)
    saved.end("tab", changed, [first.history])
    assert saved.begin("tab", [_moved(first, 2.0)]) is changed


def test_the_latest_are_remembered_and_no_more(first: Left) -> None:
    """The oldest is forgotten first."""
    saved = Autosave()
    for index in range(MOST_KEPT + 1):
        saved.end(f"tab {index}", first, [])
    assert saved.begin("tab 0", []) is None
    assert saved.begin("tab 1", []) is first
