"""What a browser's page says of its colours."""

from types import SimpleNamespace

import pytest

from nullpose.studio.guard import PREFERS_DARK, Guard
from nullpose.studio.opening import LOOPBACK


@pytest.mark.parametrize(("query", "dark"), [("dark=1&more=1", True), ("dark=yes", False), ("", False)])
def test_a_websocket_says_whether_it_prefers_dark(query: str, dark: bool) -> None:
    """Beside the token; what is not understood counts as no."""
    datastructures = pytest.importorskip("websockets.datastructures")
    guard = Guard(LOOPBACK, LOOPBACK)
    headers = datastructures.Headers(Host=LOOPBACK, Upgrade="websocket")
    request = SimpleNamespace(path=f"{guard.address(80).partition(':80')[2]}&{query}", headers=headers)
    connection = SimpleNamespace(local_address=(LOOPBACK, 80))
    assert guard._answer(lambda *_: None, connection, request) is None
    assert PREFERS_DARK.get() is dark
