"""The thread that solves for one page: the newest scene first, proofs only when the hand rests."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable, Iterable
from functools import partial

from nullpose.errors import NullposeError
from nullpose.objectives import Quantity
from nullpose.solver import announce_compiling
from nullpose.studio.answer import Event, Notice, Progress
from nullpose.studio.case import PoseCase
from nullpose.studio.field_map import field_map, map_compiler
from nullpose.studio.state import AnyEvent, State
from nullpose.studio.steps import least_tilts, power_curves, proved_answers, quick_answers

REST_S = 0.35
"""How long nothing must have changed before a proof begins, seconds."""

_COMPILING = "compiling the solver for this machine, once for dipoles and once for patterns"

_PROGRESS_S = 0.1  # between two reports of a proof


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
        self._pending: State | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="nullpose-studio-worker", daemon=True)
        self._thread.start()

    def request(self, state: State) -> None:
        """Ask for answers to a version of the scene; the work for an older one is dropped.

        Args:
            state: with the scene; its version is larger than any before.
        """
        with self._changed:
            self._pending = state
            self._changed.notify()

    def close(self, timeout_s: float = 5.0) -> bool:
        """End the thread; True if it ended within a time.

        Args:
            timeout_s: the longest to wait, seconds.
        """
        with self._changed:
            self._closed = True
            self._changed.notify()
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(self._is_superseded)
                if self._closed or self._pending is None:
                    return
                state, self._pending = self._pending, None
            try:
                with announce_compiling(
                    partial(self._publish, Notice(version=state.version, case=None, words=_COMPILING))
                ):
                    self._serve(state)
            except _SupersededError:
                continue
            except Exception:
                _log.exception("the studio's worker met an unexpected fault")

    def _serve(self, state: State) -> None:
        for case in state.cases:
            # published even if the hand has moved on since: else nothing would move while it does
            self._publish_all(state, case, quick_answers(state, case), late=True)
        self._rest()
        proved = [
            self._publish_all(state, case, proved_answers(state, case, self._progress(state, case)))
            for case in state.cases
        ]
        self._rest()  # as long again: what takes longer than a proof would be in the way of the next move
        self._publish_all(state, state.case, power_curves(state, self._go_on))
        if (best := next(filter(None, proved), None)) is not None:
            while map_compiler().is_busy():
                self._rest()
            self._publish_all(state, best.case, [field_map(best, self._go_on)])
            self._publish_all(state, best.case, least_tilts(state, self._go_on))

    def _publish_all(
        self, state: State, case: PoseCase, events: Iterable[AnyEvent], *, late: bool = False
    ) -> AnyEvent | None:
        """Publish events and return the last; a failure is published in their place, and None returned."""
        last = None
        try:
            for last in events:
                if not late:
                    self._go_on()
                self._publish(last)
        except NullposeError as error:
            self._go_on()
            self._publish(Notice(version=state.version, case=case, words=f"no pose: {error}"))
            return None
        return last

    def _progress(self, state: State, case: PoseCase) -> Callable[[float, int], None]:
        """Return a callback for a proof, which publishes its progress ten times a second at most."""
        # the proof of a rate tells the gap of the ratio
        published_at, is_rate = time.monotonic(), Quantity.of(state.scenario).is_rate

        def on_progress(gap: float, boxes: int) -> None:
            nonlocal published_at
            self._go_on()
            if not is_rate and math.isfinite(gap) and time.monotonic() - published_at > _PROGRESS_S:
                published_at = time.monotonic()
                self._publish(Progress(version=state.version, case=case, gap=gap, boxes=boxes))

        return on_progress

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
