"""What the studio adds to viser's page."""

import re
from pathlib import Path

import pytest

from nullpose.studio.frame import framed, look_html

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
    viser = pytest.importorskip("viser")
    page = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_bytes()
    assert page.count(b"<head>") == 1
    assert framed(page).count(b"<title>nullpose studio</title>") == 1
