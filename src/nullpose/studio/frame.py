"""What the studio adds to viser's page: a script before viser's own, and the look of the overlay."""

from __future__ import annotations

from functools import cache
from importlib.resources import files


def framed(page: bytes) -> bytes:
    """Return viser's page with the studio's title, style, and script, which runs before anything of viser's.

    Args:
        page: viser's page as HTML.
    """
    head = f"<head><style>{overlay_style()}</style><script>{_asset('frame.js')}</script>"
    return page.replace(b"<head>", head.encode(), 1).replace(b"<title>Viser<", b"<title>nullpose studio<", 1)


def overlay_style() -> str:
    """Return the style sheet of the overlay, which an exported page needs too."""
    return _asset("frame.css")


@cache
def _asset(name: str) -> str:
    return (files("nullpose.studio") / "assets" / name).read_text(encoding="utf-8")
