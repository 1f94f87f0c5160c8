"""One user's state: the view with its history, its version, and what is known of it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace

from numpy.typing import ArrayLike

from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.studio.answer import Answer, status_words
from nullpose.studio.case import Case, cases_of
from nullpose.studio.events import Compiling, Event, Failure, FieldMap, PowerCurve
from nullpose.studio.history import History
from nullpose.studio.map_kernel import MapKernel
from nullpose.studio.view import PointKey, View
from nullpose.studio.worker import REST_S, Worker

__all__ = ["Session", "scenario_from_text"]


class Session:
    """The state behind one page. All methods can be called from any thread.

    Every change makes a new version of the scene, for which the worker is asked. What it finds is kept with
    the version that it belongs to, so that nothing outdated passes for current.

    Args:
        scenario: the scene to begin with.
        on_view: called after every change of the view.
        on_event: called with everything that the worker finds.
        map_kernel: shared by the sessions of one server; without it, one of its own.
        rest_s: how long nothing must have changed before a proof begins, seconds.
    """

    def __init__(
        self,
        scenario: Scenario,
        *,
        on_view: Callable[[], None] = lambda: None,
        on_event: Callable[[Event], None] = lambda event: None,
        map_kernel: MapKernel | None = None,
        rest_s: float = REST_S,
    ) -> None:
        self._lock = threading.RLock()
        self._on_view, self._on_event = on_view, on_event
        self._history = History(View(scenario=scenario, case=cases_of(scenario)[0]))
        self._version = 0
        self._answers: dict[Case, Answer] = {}
        self._failures: dict[Case, Failure] = {}
        self._map: FieldMap | None = None
        self._curve: PowerCurve | None = None
        self._compiling = False
        self._worker = Worker(self._take, map_kernel or MapKernel(), rest_s=rest_s)

    def start(self) -> None:
        """Ask for the first answers."""
        self._renew()

    def close(self, timeout_s: float = 5.0) -> bool:
        """Return whether the worker has ended within a time.

        Args:
            timeout_s: the longest to wait, seconds.
        """
        return self._worker.close(timeout_s)

    @property
    def view(self) -> View:
        """The view now."""
        return self._history.present

    @property
    def version(self) -> int:
        """The version of the scene now."""
        return self._version

    @property
    def can_undo(self) -> bool:
        """Whether there is a step back."""
        return bool(self._history.past)

    @property
    def can_redo(self) -> bool:
        """Whether there is a step forward."""
        return bool(self._history.future)

    @property
    def field_map(self) -> FieldMap | None:
        """The maps of the present version, or None."""
        found = self._map
        return found if found is not None and found.version == self._version else None

    @property
    def curve(self) -> PowerCurve | None:
        """The latest power curve, whatever version it is of, or None."""
        return self._curve

    def answer(self, case: Case) -> Answer | None:
        """Return the latest answer for a case, whatever version it is of; see :meth:`is_current`.

        Args:
            case: which.
        """
        return self._answers.get(case)

    def is_current(self, answer: Answer | None) -> bool:
        """Return whether an answer is one to the present version of the scene.

        Args:
            answer: or None, which is not.
        """
        return answer is not None and answer.version == self._version

    def status(self, case: Case) -> str:
        """Return how far the solve of a case has come, in words.

        Args:
            case: which.
        """
        with self._lock:
            failure = self._failures.get(case)
            if failure is not None and failure.version == self._version:
                return f"no pose: {failure.message}"
            words = status_words(self._version, self._answers.get(case))
            compiling = words == "solving" and self._compiling
            return "compiling the solver, once, which takes a minute" if compiling else words

    def move(self, key: PointKey, position_m: ArrayLike, gesture: str = "") -> None:
        """Put a ground point elsewhere.

        Args:
            key: which point.
            position_m: (3,) metres.
            gesture: a name that all steps of one drag share.

        Raises:
            ScenarioError: the scenario would be faulty; nothing changes.
        """
        self._change(lambda view: view.moved(key, position_m), gesture)

    def set_power_db(self, power_db: float, gesture: str = "power") -> None:
        """Set the jammers' power.

        Args:
            power_db: of the strongest jammer over the strongest transmitter to be heard, dB.
            gesture: a name that all steps of one gesture share.

        Raises:
            ScenarioError: the scenario would be faulty; nothing changes.
        """
        self._change(lambda view: view.with_power_db(power_db), gesture)

    def choose(self, case: Case) -> None:
        """Choose the case that is solved.

        Args:
            case: one that has a meaning for the scenario.
        """
        self._change(lambda view: view.with_case(case))

    def compare(self, case: Case | None) -> None:
        """Choose the case to set beside the first.

        Args:
            case: one that has a meaning for the scenario, or None.
        """
        self._change(lambda view: view.with_compared(case))

    def load(self, content: bytes, name: str) -> None:
        """Take the scenario of a file's content.

        Args:
            content: the file's bytes.
            name: what to call the file in messages.

        Raises:
            ScenarioError: with every fault of the content; nothing changes.
        """
        scenario = scenario_from_text(content, name)
        self._change(lambda view: view.with_scenario(scenario))

    def undo(self) -> None:
        """Go one step back, if there is one."""
        with self._lock:
            self._history = self._history.undone()
        self._renew()

    def redo(self) -> None:
        """Go one step forward again, if there is one."""
        with self._lock:
            self._history = self._history.redone()
        self._renew()

    def end_gesture(self) -> None:
        """Let the next change be one of its own, whatever its gesture."""
        with self._lock:
            self._history = replace(self._history, gesture="")

    def _change(self, change: Callable[[View], View], gesture: str = "") -> None:
        with self._lock:
            view = change(self._history.present)
            if view == self._history.present:
                return
            self._history = self._history.changed(view, gesture)
        self._renew()

    def _renew(self) -> None:
        with self._lock:
            self._version += 1
            self._worker.request(self._version, self._history.present)
        self._on_view()

    def _take(self, event: Event) -> None:
        with self._lock:
            if isinstance(event, Answer):
                self._answers[event.case] = event
                self._compiling = False
            elif isinstance(event, Failure):
                self._failures[event.case] = event
            elif isinstance(event, FieldMap):
                self._map = event
            elif isinstance(event, PowerCurve):
                self._curve = event
            elif isinstance(event, Compiling):
                self._compiling = True
        self._on_event(event)
