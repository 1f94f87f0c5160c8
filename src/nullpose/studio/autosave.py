"""What the pages that ended leave to those that come back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.studio.history import History

MOST_KEPT = 64
"""How many pages that ended are remembered."""


class Left(NamedTuple):
    """What a page leaves.

    Args:
        history: of its session.
        eye_m: (3,) where its camera stands, metres.
        look_at_m: (3,) what the camera looks at, metres.
        controls: what is chosen for the picture, by the controls' names.
    """

    history: History
    eye_m: NDArray[np.float64]
    look_at_m: NDArray[np.float64]
    controls: Mapping[str, object]


class Autosave:
    """What browser tabs leave, by name; in memory only, and not thread-safe.

    A tab that is loaded again may come before its old page has ended. Then it goes on from the live page, and
    what that one leaves is not kept, unless it was changed since.
    """

    def __init__(self) -> None:
        self._kept: dict[str, Left] = {}  # the latest last

    def begin(self, tab: str, live: Sequence[Left]) -> Left | None:
        """Return what a tab goes on from; None if it is new.

        Args:
            tab: its name; empty for one that cannot come back.
            live: what its pages that have not ended would leave, the latest last.
        """
        if not tab:
            return None
        return self._kept.pop(tab, live[-1] if live else None)

    def end(self, tab: str, left: Left, begun: Sequence[History | None]) -> None:
        """Keep what a page leaves when it ends.

        Args:
            tab: its name; empty for one that cannot come back.
            left: what it leaves.
            begun: the histories that those pages of the tab went on from that have not ended.
        """
        if not tab or any(left.history is one for one in begun):
            return
        self._kept.pop(tab, None)
        self._kept[tab] = left
        if len(self._kept) > MOST_KEPT:
            del self._kept[next(iter(self._kept))]
