"""The panel's controls."""

from unittest.mock import MagicMock

import pytest

from nullpose.scenario import Scenario
from nullpose.studio.panel import Panel
from nullpose.studio.view import View


def test_the_power_shown_is_the_one_that_holds(paper: Scenario) -> None:
    """A text that is being typed stays until the scene changes or it is refused; then what holds is shown."""
    panel = Panel(MagicMock())
    view = View(scenario=paper).with_power_db(-99.0)
    panel.show(view)
    assert panel.power_text.value == "-99"
    assert panel.power.value == (-30.0,)  # as far as the slider goes
    panel.power_text.value = "1"
    panel.show(view)
    assert panel.power_text.value == "1"
    panel.show_power(view)
    assert panel.power_text.value == "-99"
    panel.show(view.with_power_db(12.3456))
    assert panel.power_text.value == "12.3456"
    assert panel.power.value == pytest.approx((12.3456,))
