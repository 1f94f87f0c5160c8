"""What a browser asks for when it opens its websocket: which tab it is, light or dark, which scene."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextvars import ContextVar
from dataclasses import dataclass

_PAGE = re.compile(r"[A-Za-z0-9_-]{1,64}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """What one browser's tab asks for.

    Args:
        page: a name that the tab keeps when it is loaded again; empty if it has none.
        dark: whether the browser prefers dark pages.
        scene: the scene in the page's address as a text; empty without one.
        address: the studio's address as this browser reaches it, with the token.
    """

    page: str = ""
    dark: bool = False
    scene: str = ""
    address: str = ""


ASKED: ContextVar[Asked] = ContextVar("asked")
"""What is asked for by the websocket that the running task serves."""


def asked_of(given: Mapping[str, Sequence[str]], address: str) -> Asked:
    """Return what a websocket's request asks for; what is not understood is left out.

    Args:
        given: the query's values by name.
        address: the studio's address as this browser reaches it.
    """
    page, dark, scene = (given.get(name, [""])[0] for name in ("page", "dark", "scene"))
    known = page if _PAGE.fullmatch(page) else ""
    return Asked(page=known, dark=dark == "1", scene=scene, address=address)
