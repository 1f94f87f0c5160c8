"""The player of a scene in motion: one instant after the other, each when its pose is found."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial

from nullpose.studio.session import Session
from nullpose.studio.state import State

FRAME_S = 0.2
"""The least time from one instant to the next, seconds."""


class Player:
    """Shows the instants of a session's scene in motion in turn, and stops at the last.

    Args:
        session: with the scene.
        change: changes its state; False if that is refused.
    """

    def __init__(self, session: Session, change: Callable[[Callable[[State], State]], bool]) -> None:
        self._session, self._change = session, change
        self._stopped = threading.Event()
        self._stopped.set()

    @property
    def is_playing(self) -> bool:
        """Whether instants still follow."""
        return not self._stopped.is_set()

    def press(self) -> None:
        """Play from the present instant, from the first if it is the last; stop if that is under way."""
        if self.is_playing:
            self.stop()
        else:
            self._stopped = threading.Event()  # each play has its own, so that one that was stopped ends
            threading.Thread(
                target=self._play, args=(self._stopped,), name="nullpose-studio-player", daemon=True
            ).start()

    def stop(self) -> None:
        """Show no further instants."""
        self._stopped.set()

    def _play(self, stopped: threading.Event) -> None:
        next_s: float | None = self._session.state.next_s or 0.0
        while (
            next_s is not None and not stopped.is_set() and self._change(partial(State.at_time, t_s=next_s))
        ):
            while not stopped.wait(FRAME_S) and not self._session.state.is_answered:
                pass
            next_s = self._session.state.next_s
        stopped.set()
