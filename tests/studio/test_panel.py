"""The panel's controls."""

from unittest.mock import MagicMock

import pytest

from nullpose.scenario import Scenario
from nullpose.studio.panel import Panel
from nullpose.studio.session import History
from nullpose.studio.state import State


def test_the_panel_shows_the_state(paper: Scenario) -> None:
    """The power as it is, on the slider as far as that goes, and whether there is a step to undo."""
    gui = MagicMock()
    for add in (gui.add_text, gui.add_button):
        add.side_effect = lambda *_, **__: MagicMock()
    panel = Panel(gui, MagicMock())
    history = History(State(scenario=paper).with_power_db(-99.0))
    panel.render(history)
    assert panel.power_text.value == "-99"
    assert panel.power.value == (-30.0,)
    assert panel.undo.disabled
    history = history.changed(history.present.with_power_db(12.3456))
    panel.render(history)
    assert panel.power_text.value == "12.3456"
    assert panel.power.value == pytest.approx((12.3456,))
    assert not panel.undo.disabled
