"""One user's states: the one now, those before it and those undone, kept up to date by a worker."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace

from nullpose.studio.answer import Event, Flight
from nullpose.studio.state import State
from nullpose.studio.worker import FLIGHT_LIMIT_S, REST_S, Worker, answer_flight, answer_poses

_MOST_STEPS = 200


@dataclass(frozen=True, slots=True)
class History:
    """The state now, those before it and those undone.

    Args:
        present: the state now.
        past: earlier ones, the last being the latest; at most 200 are kept.
        future: undone ones, the last being the next to redo.
        gesture: the gesture that the present scene is a step of, such as one drag; empty if it is complete.
    """

    present: State
    past: tuple[State, ...] = ()
    future: tuple[State, ...] = ()
    gesture: str = ""

    def changed(self, state: State, gesture: str = "") -> History:
        """Return the history with a new state; a step only if its scene is another, and not just its instant.

        Args:
            state: the new one.
            gesture: a name that all steps of one gesture share, which are undone together; empty for a change
                of its own.
        """
        if state.scene == (now := self.present).scene:
            return replace(self, present=replace(state, version=now.version, events=now.events))
        if state.motion is not None and replace(state, scenario=now.scenario).scene == now.scene:
            return replace(self, present=self._next(state))
        if gesture and gesture == self.gesture:
            return replace(self, present=self._next(state), future=())
        return History(
            present=self._next(state),
            past=(*self.past, replace(now, events={}))[-_MOST_STEPS:],
            gesture=gesture,
        )

    def undone(self) -> History:
        """Return the history one step back; itself if there is none."""
        if not self.past:
            return self
        return History(
            present=self._next(self.present.with_scene_of(self.past[-1])),
            past=self.past[:-1],
            future=(*self.future, self.present),
        )

    def redone(self) -> History:
        """Return the history one step forward again; itself if there is none."""
        if not self.future:
            return self
        return History(
            present=self._next(self.present.with_scene_of(self.future[-1])),
            past=(*self.past, self.present),
            future=self.future[:-1],
        )

    def _next(self, state: State) -> State:
        """Return a state as the next version; the proofs of cases that are not shown would take up memory."""
        shown = {None, *state.cases}
        events = {key: event for key, event in self.present.events.items() if key[1] in shown}
        key = state.selected
        is_gone = key is not None and key[1] >= len(state.members(key[0]))
        return replace(
            state, version=self.present.version + 1, events=events, selected=None if is_gone else key
        )


class Session:
    """The states behind one page. All methods can be called from any thread.

    Every change of the scene makes a new version of it, for which the worker is asked. What the worker finds
    is kept with the version that it belongs to, so that nothing outdated passes for current.

    Args:
        state: to begin with.
        on_change: called after every change of the state.
        on_event: called with everything that the worker finds.
        rest_s: how long nothing must have changed before a proof begins, seconds.

    Attributes:
        history: the state now, those before it and those undone.
        still: a lock under which nothing changes.
    """

    def __init__(
        self,
        state: State,
        *,
        on_change: Callable[[], None] = lambda: None,
        on_event: Callable[[Event], None] = lambda event: None,
        rest_s: float = REST_S,
    ) -> None:
        self.still = threading.RLock()
        self._on_change, self._on_event = on_change, on_event
        self.history = History(state)
        self._worker = Worker(self.take, answer_poses, rest_s=rest_s)
        self._planner = Worker(self.take, answer_flight, name="planner")

    def start(self) -> None:
        """Ask for the first answers."""
        self._worker.request(self.state)

    def close(self, timeout_s: float = 5.0) -> bool:
        """End the worker; True if it ended within a time. A search for a flight ends some seconds later.

        Args:
            timeout_s: the longest to wait, seconds.
        """
        self._planner.close(0.0)
        return self._worker.close(timeout_s)

    @property
    def state(self) -> State:
        """The state now."""
        return self.history.present

    def change(self, change: Callable[[State], State], gesture: str = "") -> None:
        """Change the state.

        Args:
            change: from the state now to the new one.
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

    def plan(self) -> None:
        """Ask for a flight through the scene in motion; a change of it, but not of the instant, drops it."""
        if (motion := self.state.motion) is not None:
            words = (f"planning, about {FLIGHT_LIMIT_S:g} s; the first time longer",)
            self.take(Flight(version=self.state.version, motion=motion, words=words))
            self._planner.request(self.state)

    def _go(self, change: Callable[[History], History]) -> None:
        with self.still:
            before, self.history = self.state, change(self.history)
            if self.state.version != before.version:
                self._worker.request(self.state)
            if self.state.motion is not before.motion:
                self._planner.request(self.state)
        self._on_change()

    def take(self, event: Event) -> None:
        """Keep what was found for a version of the scene; called by the worker.

        Args:
            event: what was found.
        """
        with self.still:
            self.history = replace(self.history, present=self.state.with_event(event))
        self._on_event(event)
