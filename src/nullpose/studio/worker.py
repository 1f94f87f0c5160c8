"""The thread that solves for one page: the newest scene first, proofs only when the hand rests."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from nullpose.errors import NullposeError
from nullpose.objectives import Quantity
from nullpose.solver import Scheme, SolveKeywords, announce_compiling, solve
from nullpose.studio.answer import (
    Answer,
    Event,
    Notice,
    PowerCurve,
    Progress,
    TiltNotice,
    answer_of,
    tilt_words,
    with_errors,
)
from nullpose.studio.case import OPTIMUM, PoseCase
from nullpose.studio.field_map import field_map, map_compiler
from nullpose.studio.state import POWER_DB, AnyEvent, State
from nullpose.study import ResultRow, ResultTable
from nullpose.study.least_tilt import tilt_search

POWER_LABEL = "strongest jammer over strongest node (dB)"
"""What the power curve is drawn over."""

_PROOF_LIMIT_S = 30.0
_ROBUST_LIMIT_S = 20.0
_TILT_LIMIT_S = 5.0  # of each proof
_SHARE = 0.99  # of the best value, with which a tilt suffices
_CURVE_POINTS = 15
_QUICK_ROBUST = "Best pose where all is as stated; what it guarantees is worked out at rest"


class _Watched(SolveKeywords, total=False):
    """Options of solves that can be ended."""

    on_progress: Callable[..., None]


def quick_answers(state: State, case: PoseCase) -> Iterator[Answer]:
    """Yield the best pose that is found in a moment, for as long as the hand moves.

    For the robust case it is the pose that is best without errors. How far any is proved is for the proof to
    say, a moment later.

    Args:
        state: with the scene.
        case: what to solve.

    Raises:
        NullposeError: there is no pose, or the case has no meaning here.
    """
    answer = answer_of(state.version, case, solve(case.on(state.scenario), case.scheme, certify=False))
    yield replace(answer, note=_QUICK_ROBUST) if case.robust else answer


def proved_answers(
    state: State, case: PoseCase, on_progress: Callable[[float, int], None]
) -> Iterator[Answer]:
    """Yield the answers that a proof leads to, each better known than the one before.

    Args:
        state: with the scene.
        case: what to solve.
        on_progress: called now and then; what it raises ends the proof.

    Raises:
        NullposeError: there is no pose, or the case has no meaning here.
    """
    scenario = case.on(state.scenario)
    if not case.robust:
        proved = solve(scenario, case.scheme, time_limit_s=_PROOF_LIMIT_S, on_progress=on_progress)
        answer = answer_of(state.version, case, proved)
        yield answer
        yield with_errors(answer)
    for certify in (False, True) if case.robust else ():
        guarded = solve(
            scenario, robust=True, certify=certify, time_limit_s=_ROBUST_LIMIT_S, on_progress=on_progress
        )
        yield answer_of(state.version, case, guarded)


def least_tilts(state: State, go_on: Callable[..., None]) -> Iterator[TiltNotice]:
    """Yield the least tilt that the chosen case's vehicle needs; no words for a robust case or a pattern.

    Args:
        state: with the scene.
        go_on: called now and then; what it raises ends the search.
    """
    scenario, words = state.case.on(state.scenario), ""
    if scenario.antenna_record.is_quadratic and not state.case.robust:
        mount_deg = 0.0 if scenario.airframe is None else scenario.airframe.mount_deg
        search = tilt_search(scenario, _SHARE, _Watched(time_limit_s=_TILT_LIMIT_S, on_progress=go_on))
        words = tilt_words(search.sides(mount_deg), _SHARE)
    yield TiltNotice(version=state.version, case=None, words=words)


def power_curves(state: State, go_on: Callable[[], None] = lambda: None) -> Iterator[PowerCurve]:
    """Yield the schemes' values against the jamming power, as far as they are known.

    The poses are searched for, not proved. Nothing comes without a jamming power to vary.

    Args:
        state: with the scene.
        go_on: called before every search; what it raises ends the curve.

    Raises:
        NullposeError: there is no pose at some power.
    """
    if state.power_db is None:
        return
    schemes = [scheme for scheme in Scheme if scheme.not_applicable(state.scenario) is None]
    rows: list[ResultRow] = []
    for done, power_db in enumerate(np.linspace(*POWER_DB, _CURVE_POINTS).tolist(), start=1):
        scenario = OPTIMUM.on(state.with_power_db(power_db).scenario)
        for scheme in schemes:
            go_on()
            rows.append(ResultRow.of(power_db, solve(scenario, scheme, certify=False)))
        yield PowerCurve(
            version=state.version,
            table=ResultTable(path=POWER_LABEL, rows=tuple(rows)),
            complete=done == _CURVE_POINTS,
        )


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
