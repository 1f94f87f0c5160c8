"""What the pages that ended leave to those that come back."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence

from nullpose.studio.history import History

MOST_KEPT = 64
"""How many pages that ended are remembered."""


class Autosave:
    """The histories of browser tabs, by name; in memory only, and not thread-safe.

    A tab that is loaded again may come before its old page has ended. Then it goes on from the live page, and
    what that one leaves is not kept, unless it was changed since.
    """

    def __init__(self) -> None:
        self._kept: OrderedDict[str, History] = OrderedDict()

    def begin(self, tab: str, live: Sequence[History]) -> History | None:
        """Return what a tab goes on from; None if it is new.

        Args:
            tab: its name; empty for one that cannot come back.
            live: those of its pages that have not ended, the latest last.
        """
        if not tab:
            return None
        return self._kept.pop(tab, live[-1] if live else None)

    def end(self, tab: str, history: History, begun: Sequence[History | None]) -> None:
        """Keep what a page leaves when it ends.

        Args:
            tab: its name; empty for one that cannot come back.
            history: what it leaves.
            begun: what those pages of the tab went on from that have not ended.
        """
        if not tab or any(history is one for one in begun):
            return
        self._kept[tab] = history
        self._kept.move_to_end(tab)
        if len(self._kept) > MOST_KEPT:
            self._kept.popitem(last=False)
