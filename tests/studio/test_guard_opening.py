"""What is checked before a server opens."""

import socket
import sys
from collections.abc import Callable
from unittest.mock import MagicMock

import pytest

import nullpose
from nullpose.errors import UsageError
from nullpose.scenario import Scenario
from nullpose.studio.case import new_scenario
from nullpose.studio.guard import LOOPBACK, open_server, require_viser
from nullpose.studio.panel import Panel
from nullpose.studio.session import History
from nullpose.studio.state import State


@pytest.mark.parametrize("act", [require_viser, lambda: nullpose.show(new_scenario())])
def test_without_the_extra_one_line_says_what_to_do(
    act: Callable[[], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where viser is missing, the message is one line with the command that installs it."""
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(UsageError, match=r"-m pip install -e '\.\[studio\]'") as raised:
        act()
    assert "\n" not in str(raised.value)


def test_a_port_in_use_is_told() -> None:
    """Another program's port is not taken, and no other is taken in its place."""
    with socket.socket() as other:
        other.bind((LOOPBACK, 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(UsageError, match=f"--port: {port} is in use"):
            open_server(LOOPBACK, port)


@pytest.mark.parametrize("host", ["203.0.113.7", "no-such-host.invalid"])
def test_an_address_elsewhere_is_told(host: str) -> None:
    """An address that is not this machine's is refused by name."""
    with pytest.raises(UsageError, match=f"--host: given {host}"):
        open_server(host, 0)


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
