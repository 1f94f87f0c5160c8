"""One user's state: the view with its history, its version, and what is known of it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from nullpose.scenario import Scenario
from nullpose.studio.answer import Answer, status_words
from nullpose.studio.case import Case, cases_of
from nullpose.studio.events import Event, Notice, PowerCurve, Progress
from nullpose.studio.field_map import FieldMap
from nullpose.studio.history import History
from nullpose.studio.view import View
from nullpose.studio.worker import REST_S, Worker

_E = TypeVar("_E", Answer, Notice, FieldMap, PowerCurve, Progress)


class Session:
    """The state behind one page. All methods can be called from any thread.

    Every change makes a new version of the scene, for which the worker is asked. What it finds is kept with
    the version that it belongs to, so that nothing outdated passes for current.

    Args:
        scenario: the scene to begin with.
        text: of the file that it is from; empty without a file.
        on_view: called after every change of the view.
        on_event: called with everything that the worker finds.
        rest_s: how long nothing must have changed before a proof begins, seconds.
        case: how the pose is chosen at first; None for the first case that the scene allows.

    Attributes:
        version: of the scene now.
        history: the view now, those before it and those undone.
        still: a lock under which nothing changes, to read several things that belong together.
    """

    def __init__(
        self,
        scenario: Scenario,
        text: str = "",
        *,
        on_view: Callable[[], None] = lambda: None,
        on_event: Callable[[Event], None] = lambda event: None,
        rest_s: float = REST_S,
        case: Case | None = None,
    ) -> None:
        self.still = threading.RLock()
        self._on_view, self._on_event = on_view, on_event
        self.version = 0
        self.history = History(View(scenario=scenario, case=case or cases_of(scenario)[0], text=text))
        self._found: dict[tuple[type, Case | None], Event] = {}
        self._worker = Worker(self.take, rest_s=rest_s)

    def start(self) -> None:
        """Ask for the first answers."""
        self._go(replace)

    def close(self, timeout_s: float = 5.0) -> bool:
        """Return whether the worker has ended within a time.

        Args:
            timeout_s: the longest to wait, seconds.
        """
        return self._worker.close(timeout_s)

    @property
    def view(self) -> View:
        """The view now."""
        return self.history.present

    @property
    def field_map(self) -> FieldMap | None:
        """The maps of the present version, or None."""
        return self._last(FieldMap, current=True)

    @property
    def curve(self) -> PowerCurve | None:
        """The latest power curve, whatever version it is of, or None."""
        return self._last(PowerCurve)

    def progress(self, case: Case) -> Progress | None:
        """Return how far the proof of a case has come for the present version, or None.

        Args:
            case: which.
        """
        return self._last(Progress, case, current=True)

    def answer(self, case: Case) -> Answer | None:
        """Return the latest answer for a case, whatever version it is of; see :meth:`current`.

        Args:
            case: which.
        """
        return self._last(Answer, case)

    def current(self, case: Case) -> Answer | None:
        """Return the answer for a case to the present version of the scene, or None.

        Args:
            case: which.
        """
        return self._last(Answer, case, current=True)

    def status(self, case: Case) -> str:
        """Return how far the solve of a case has come, in words.

        Args:
            case: which.
        """
        with self.still:
            answer = self.current(case)
            compiling = self._last(Notice) if answer is None else None
            notice = self._last(Notice, case, current=True) or compiling
            return status_words(answer) if notice is None else notice.words

    def change(self, change: Callable[[View], View], gesture: str = "") -> None:
        """Change the view.

        Args:
            change: returns the new view for the one now.
            gesture: a name that all steps of one drag share, which are undone together.

        Raises:
            ScenarioError: the scenario would be faulty; nothing changes.
        """
        self._go(lambda history: history.changed(change(history.present), gesture))

    def undo(self) -> None:
        """Go one step back, if there is one."""
        self._go(History.undone)

    def redo(self) -> None:
        """Go one step forward again, if there is one."""
        self._go(History.redone)

    def _go(self, change: Callable[[History], History]) -> None:
        with self.still:
            history = change(self.history)
            if history is self.history:
                return
            self.history = history
            self.version += 1
            shown = {None, *history.present.cases}  # the proofs of the others would only take up memory
            self._found = {key: event for key, event in self._found.items() if key[1] in shown}
            self._worker.request(self.version, history.present)
        self._on_view()

    def _last(self, kind: type[_E], case: Case | None = None, *, current: bool = False) -> _E | None:
        """Return the latest event of a kind, if there is one, or only one of the present version."""
        found = self._found.get((kind, case))
        if not isinstance(found, kind) or (current and found.version != self.version):
            return None
        return found

    def take(self, event: Event) -> None:
        """Keep what was found for a version of the scene; called by the worker.

        Args:
            event: what was found.
        """
        with self.still:
            self._found[type(event), getattr(event, "case", None)] = event
            if isinstance(event, Answer):
                self._found.pop((Notice, None), None)
        self._on_event(event)
