"""The proof on a page: its bar, and the button that shows its boxes again."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable

from viser import ClientHandle

from nullpose.solver import Result
from nullpose.solver.proof_steps import ProofStep, has_proof_steps, proof_steps
from nullpose.studio.answer import Answer
from nullpose.studio.panel import Panel
from nullpose.studio.proof_bar import OPEN_BAR, answer_bar, progress_bar, step_bar
from nullpose.studio.replay import BOXES, MOST_BOXES, MOST_BOXES_BY_CARD, Replay, drawn_airspace_m
from nullpose.studio.session import Session

REPLAY_S = 6.0
"""How long a replay takes, seconds."""

_REST_S = 0.8  # that its first step and its last one stay longer

_log = logging.getLogger("nullpose.studio")


class _StoppedError(BaseException):
    """Ends a replay; no fault."""


class ProofView:
    """The bar and the replay of the chosen case's proof.

    Args:
        client: the browser.
        session: the page's.
        panel: the page's.
        lock: under which the page is drawn.
        refresh: draws the page.
        show_bar: draws what the bar is in.
        card: whether the browser draws with a graphics card.
    """

    def __init__(
        self,
        client: ClientHandle,
        session: Session,
        panel: Panel,
        lock: threading.RLock,
        refresh: Callable[[], None],
        show_bar: Callable[[], None],
        *,
        card: bool = False,
    ) -> None:
        self._client, self._session, self._lock = client, session, lock
        self._refresh, self._show_bar = refresh, show_bar
        self._most_boxes = MOST_BOXES_BY_CARD if card else MOST_BOXES
        self._stop: threading.Event | None = None
        self._step_bar = ""
        panel.replay.on_click(lambda event: self.press())

    @property
    def is_playing(self) -> bool:
        """Whether boxes are shown, which the antenna's pattern would hide."""
        return self._stop is not None

    @property
    def can_play(self) -> bool:
        """Whether the present scene has a proof whose boxes can be shown."""
        answer = self._session.current(self._session.view.case)
        return answer is not None and has_proof_steps(answer.result)

    @property
    def bar(self) -> str:
        """How far the proof of the present scene has come, or the step that is shown again, as HTML."""
        session, case = self._session, self._session.view.case
        answer, progress = session.current(case), session.progress(case)
        bar = "" if answer is None else self._step_bar or answer_bar(answer)
        return bar or (OPEN_BAR if progress is None else progress_bar(progress))

    def press(self) -> None:
        """Begin to show the boxes of the proof, or stop if they are being shown."""
        with self._lock:
            answer = self._session.current(self._session.view.case)
            if self._stop is not None:
                self.stop()
            elif answer is not None and has_proof_steps(answer.result):
                self._stop = threading.Event()
                self._refresh()
                run, given = self._run, (answer, self._stop)
                threading.Thread(target=run, args=given, name="nullpose-studio-replay", daemon=True).start()

    def stop(self) -> None:
        """Stop showing boxes, because the scene has changed, say."""
        if self._stop is not None:
            self._stop.set()

    def _run(self, answer: Answer, stop: threading.Event) -> None:
        def go_on() -> None:
            if stop.is_set() or self._session.version != answer.version:
                raise _StoppedError

        try:
            steps = proof_steps(answer.result, go_on)
            if steps:
                self._play(steps, answer.result, stop, go_on)
        except _StoppedError:
            pass
        except Exception:
            _log.exception("the proof could not be shown")
        with self._lock:
            self._stop, self._step_bar = None, ""
            self._client.scene.remove_by_name(BOXES)
            self._refresh()

    def _play(
        self,
        steps: tuple[ProofStep, ...],
        result: Result,
        stop: threading.Event,
        go_on: Callable[[], None],
    ) -> None:
        """Show the steps one after another; those that are late are left out."""
        replay = Replay(self._client.scene, drawn_airspace_m(result.scenario), self._most_boxes)
        began, every_s = time.monotonic() + _REST_S, REPLAY_S / len(steps)
        due = 0
        while due < len(steps):
            with self._lock:
                go_on()
                with self._client.atomic():
                    replay.show(steps[due])
                    self._step_bar = step_bar(result, steps[due], steps[-1])
                    self._show_bar()
                self._client.flush()
            stop.wait(max(0.0, began + due * every_s - time.monotonic()))
            passed = int((time.monotonic() - began) / every_s)
            due = max(due + 1, min(passed, len(steps) - 1))
        stop.wait(_REST_S)
