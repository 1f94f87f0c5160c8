"""The studio's part of viser's page, and a browser's preference of colours."""

import re
from pathlib import Path
from types import SimpleNamespace

import pytest
import viser
from websockets.datastructures import Headers

from nullpose.studio.guard import LOOPBACK, PREFERS_DARK, Guard, framed, look_html


@pytest.mark.parametrize(("query", "dark"), [("dark=1&more=1", True), ("dark=yes", False), ("", False)])
def test_a_websocket_says_whether_it_prefers_dark(query: str, dark: bool) -> None:
    """Beside the token; what is not understood counts as no."""
    guard = Guard(LOOPBACK, LOOPBACK)
    headers = Headers(Host=LOOPBACK, Upgrade="websocket")
    request = SimpleNamespace(path=f"{guard.address(80).partition(':80')[2]}&{query}", headers=headers)
    connection = SimpleNamespace(local_address=(LOOPBACK, 80))
    assert guard._answer(lambda *_: None, connection, request) is None
    assert PREFERS_DARK.get() is dark


PAGE = b"<!doctype html><html><head><script>viser()</script></head><body></body></html>"


def test_it_runs_before_viser_and_changes_nothing_else() -> None:
    """Since it tells viser where its websocket is."""
    before, found, after = framed(PAGE).partition(b"<script>viser()</script>")
    assert found
    assert before.startswith(b"<!doctype html><html><head><style>")
    assert before.endswith(b"</script>")
    assert after == b"</head><body></body></html>"


def test_it_loads_nothing_from_elsewhere() -> None:
    """Neither in the page nor in the style that an export takes."""
    for text in (framed(PAGE).decode(), look_html()):
        assert re.findall(r"https?://|@import|url\(", text) == []


def test_viser_has_the_page_that_it_is_added_to() -> None:
    """The installed one has one head."""
    page = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_bytes()
    assert page.count(b"<head>") == 1
    assert framed(page).count(b"<title>nullpose studio</title>") == 1
