"""The thread that solves for one page: the newest scene first, proofs only when the hand rests."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from nullpose.errors import NullposeError
from nullpose.solve import announce_compiling
from nullpose.studio.answer import Answer
from nullpose.studio.case import Case
from nullpose.studio.events import Compiling, Event, Failure
from nullpose.studio.field_map import field_map
from nullpose.studio.map_kernel import MapKernel
from nullpose.studio.steps import power_curves, proved_answers, quick_answer
from nullpose.studio.view import View

__all__ = ["REST_S", "Worker"]

REST_S = 0.35
"""How long nothing must have changed before a proof begins, seconds."""

_log = logging.getLogger("nullpose.studio")


@dataclass(frozen=True, slots=True)
class _Request:
    version: int
    view: View


class _SupersededError(BaseException):
    """Ends a step whose scene is no longer the newest; no fault, so that no handler of faults stops it."""


class Worker:
    """A thread that answers for the newest version of a scene and drops what is outdated.

    Args:
        publish: called from the thread with everything found, in order of its version. What a search found
            may come after a newer version was requested, so that poses follow a moving hand; a proof, a map
            or a curve of an outdated version does not.
        map_kernel: tells when the maps can be worked out.
        rest_s: how long nothing must have changed before a proof begins, seconds; as long again, and the plot
            and the maps do.
    """

    def __init__(
        self, publish: Callable[[Event], None], map_kernel: MapKernel, *, rest_s: float = REST_S
    ) -> None:
        self._publish, self._map_kernel, self._rest_s = publish, map_kernel, rest_s
        self._changed = threading.Condition()
        self._request: _Request | None = None
        self._pending = self._closed = False
        self._thread = threading.Thread(target=self._run, name="nullpose-studio-worker", daemon=True)
        self._thread.start()

    def request(self, version: int, view: View) -> None:
        """Ask for answers to a version of the scene; what runs for an older one is dropped.

        Args:
            version: of the scene; larger than any before.
            view: the scene.
        """
        with self._changed:
            self._request, self._pending = _Request(version, view), True
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
                self._changed.wait_for(lambda: self._pending or self._closed)
                if self._closed:
                    return
                request, self._pending = self._request, False
            assert request is not None, "something is pending"
            try:
                with announce_compiling(partial(self._publish, Compiling(version=request.version))):
                    self._serve(request)
            except _SupersededError:
                continue
            except Exception:
                _log.exception("the studio's worker met an unexpected fault")

    def _serve(self, request: _Request) -> None:
        view = request.view
        for case in view.cases:
            # told even if the hand has moved on since: else nothing would move while it does
            self._try(request, case, partial(self._answer_quickly, request, case))
        self._rest()
        best: Answer | None = None
        for case in view.cases:
            last = self._try(request, case, partial(self._prove, request, case))
            best = best or last
        self._rest()  # as long again: what takes longer than a proof would be in the way of the next move
        self._try(request, view.case, lambda: self._draw_curve(request))
        if best is not None:
            while not self._map_kernel.is_ready():
                self._rest()
            self._tell(request, field_map(best, self._go_on))

    def _answer_quickly(self, request: _Request, case: Case) -> None:
        self._publish(quick_answer(request.version, request.view, case))

    def _prove(self, request: _Request, case: Case) -> Answer | None:
        last = None
        for last in proved_answers(request.version, request.view, case, lambda _gap, _boxes: self._go_on()):
            self._tell(request, last)
        return last

    def _draw_curve(self, request: _Request) -> None:
        for curve in power_curves(request.version, request.view, self._go_on):
            self._tell(request, curve)

    def _try(
        self, request: _Request, case: Case, step: Callable[[], Answer | None] | Callable[[], None]
    ) -> Answer | None:
        try:
            return step()
        except NullposeError as error:
            self._tell(request, Failure(version=request.version, case=case, message=str(error)))
            return None

    def _tell(self, request: _Request, event: Event) -> None:
        self._go_on()
        self._publish(event)

    def _go_on(self) -> None:
        if self._pending or self._closed:
            raise _SupersededError

    def _rest(self) -> None:
        until = time.monotonic() + self._rest_s
        with self._changed:
            self._changed.wait_for(
                lambda: self._pending or self._closed, timeout=max(0.0, until - time.monotonic())
            )
        self._go_on()
