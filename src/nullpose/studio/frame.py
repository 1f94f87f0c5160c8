"""What the studio adds to viser's page: a script before viser's own, and the look of the overlay."""

from __future__ import annotations

from functools import cache
from importlib.resources import files


def framed(page: bytes) -> bytes:
    """Return viser's page with the studio's title, style, and script, which runs before anything of viser's.

    Args:
        page: viser's page as HTML.
    """
    head = f"<head>{look_html()}<script>{_asset('frame.js')}</script>"
    return page.replace(b"<head>", head.encode(), 1).replace(b"<title>Viser<", b"<title>nullpose studio<", 1)


def look_html() -> str:
    """Return the overlay's style and what keeps the colours of lines, for an exported page too."""
    return f"<style>{_asset('frame.css')}</style><script>{_asset('lines.js')}</script>"


@cache
def _asset(name: str) -> str:
    return (files("nullpose.studio") / "assets" / name).read_text(encoding="utf-8")
