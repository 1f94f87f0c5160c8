"""What a browser's page says of its screen."""

from types import SimpleNamespace

import pytest

from nullpose.studio.guard import SCREEN, Guard, Screen
from nullpose.studio.opening import LOOPBACK


@pytest.mark.parametrize(
    ("said", "screen"),
    [
        ("dark=1&card=1", Screen(dark=True, card=True)),
        ("card=1", Screen(dark=False, card=True)),
        ("dark=yes&card=&more=1", Screen(dark=False, card=False)),
    ],
)
def test_a_websocket_says_what_its_screen_is(said: str, screen: Screen) -> None:
    """Beside the token; what is not understood counts as no."""
    datastructures = pytest.importorskip("websockets.datastructures")
    guard = Guard(LOOPBACK, LOOPBACK)
    headers = datastructures.Headers(Host=LOOPBACK, Upgrade="websocket")
    request = SimpleNamespace(path=f"{guard.address(80).partition(':80')[2]}&{said}", headers=headers)
    connection = SimpleNamespace(local_address=(LOOPBACK, 80))
    assert guard._answer(lambda *_: None, connection, request) is None
    assert SCREEN.get() == screen
