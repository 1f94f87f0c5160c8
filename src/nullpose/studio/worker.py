"""The thread that solves for one page: the newest scene first, proofs only when the hand rests."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import TypeVar

from nullpose.errors import NullposeError
from nullpose.solver import announce_compiling
from nullpose.studio.answer import Answer, with_errors
from nullpose.studio.case import Case
from nullpose.studio.events import Event, Notice, Progress
from nullpose.studio.field_map import field_map
from nullpose.studio.map_kernel import map_kernel_is_ready
from nullpose.studio.steps import power_curves, proved_answers, quick_answers, target_gap
from nullpose.studio.view import View

REST_S = 0.35
"""How long nothing must have changed before a proof begins, seconds."""

_COMPILING = "compiling the solver, once, which takes about 20 s"

_TOLD_S = 0.1  # between two tellings of how far a proof has come

_E = TypeVar("_E", bound=Event)

_log = logging.getLogger("nullpose.studio")


class _SupersededError(BaseException):
    """Ends a step whose scene is no longer the newest; no fault, so that no handler of faults stops it."""


class Worker:
    """A thread that answers for the newest version of a scene and drops what is outdated.

    Args:
        publish: called from the thread with everything found, in order of its version. What a search found
            may come after a newer version was requested, so that poses follow a moving hand; a proof, a map
            or a curve of an outdated version does not.
        rest_s: how long nothing must have changed before a proof begins, seconds; as long again, and the plot
            and the maps do.
    """

    def __init__(self, publish: Callable[[Event], None], *, rest_s: float = REST_S) -> None:
        self._publish, self._rest_s = publish, rest_s
        self._changed = threading.Condition()
        self._pending: tuple[int, View] | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="nullpose-studio-worker", daemon=True)
        self._thread.start()

    def request(self, version: int, view: View) -> None:
        """Ask for answers to a version of the scene; what runs for an older one is dropped.

        Args:
            version: of the scene; larger than any before.
            view: the scene.
        """
        with self._changed:
            self._pending = version, view
            self._changed.notify()

    def close(self, timeout_s: float = 5.0) -> bool:
        """Return whether the thread has ended within a time.

        Args:
            timeout_s: the longest to wait, seconds.
        """
        with self._changed:
            self._closed = True
            self._changed.notify()
        if threading.current_thread() is not self._thread:
            self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(self._is_superseded)
                if self._closed or self._pending is None:
                    return
                (version, view), self._pending = self._pending, None
            try:
                compiling = Notice(version=version, case=None, words=_COMPILING)
                with announce_compiling(partial(self._publish, compiling)):
                    self._serve(version, view)
            except _SupersededError:
                continue
            except Exception:
                _log.exception("the studio's worker met an unexpected fault")

    def _serve(self, version: int, view: View) -> None:
        for case in view.cases:
            # told even if the hand has moved on since: else nothing would move while it does
            self._tell_all(version, case, quick_answers(version, view, case), late=True)
        self._rest()
        best: Answer | None = None
        for case in view.cases:
            told = self._progress(version, view, case)
            last = self._tell_all(version, case, proved_answers(version, view, case, told))
            if last is not None:
                last = self._tell_all(version, case, map(with_errors, [last]))
            best = best or last
        self._rest()  # as long again: what takes longer than a proof would be in the way of the next move
        self._tell_all(version, view.case, power_curves(version, view, self._go_on))
        if best is not None:
            while not map_kernel_is_ready():
                self._rest()
            self._tell_all(version, best.case, [field_map(best, self._go_on)])

    def _tell_all(self, version: int, case: Case, events: Iterable[_E], *, late: bool = False) -> _E | None:
        """Return the last of some events, all told, or the failure in their place; none if there was one."""
        last = None
        try:
            for last in events:
                if not late:
                    self._go_on()
                self._publish(last)
        except NullposeError as error:
            self._go_on()
            self._publish(Notice(version=version, case=case, words=f"no pose: {error}"))
            return None
        return last

    def _progress(self, version: int, view: View, case: Case) -> Callable[[float, int], None]:
        """Return what a proof calls now and then, which is told ten times a second at most."""
        told_at, target = time.monotonic(), target_gap(view, case)

        def told(gap: float, boxes: int) -> None:
            nonlocal told_at
            self._go_on()
            if target is not None and math.isfinite(gap) and time.monotonic() - told_at > _TOLD_S:
                told_at = time.monotonic()
                self._publish(Progress(version=version, case=case, gap=gap, target=target, boxes=boxes))

        return told

    def _is_superseded(self) -> bool:
        return self._closed or self._pending is not None

    def _go_on(self, *_: object) -> None:
        """End the step if its scene is no longer the newest; takes whatever a solver says of its progress."""
        if self._is_superseded():
            raise _SupersededError

    def _rest(self) -> None:
        with self._changed:
            self._changed.wait_for(self._is_superseded, timeout=self._rest_s)
        self._go_on()
