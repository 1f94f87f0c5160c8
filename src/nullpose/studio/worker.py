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
from nullpose.report.numbers import MINUS
from nullpose.report.trajectory import flight_words
from nullpose.solver import Scheme, SolveKeywords, announce_compiling, solve
from nullpose.solver.trajectory import solve_trajectory
from nullpose.studio.answer import (
    Answer,
    Event,
    Flight,
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
from nullpose.study.between_instants import sample_between
from nullpose.study.least_tilt import tilt_search

POWER_LABEL = "strongest jammer over strongest node (dB)"
"""What the power curve is drawn over."""

_PROOF_LIMIT_S = 30.0
_ROBUST_LIMIT_S = 20.0
_TILT_LIMIT_S = 5.0  # of each proof
_SHARE = 0.99  # of the best value, with which a tilt suffices
_CURVE_POINTS = 15
FLIGHT_LIMIT_S = 10.0
"""The time limit of search and proof of a flight, seconds."""

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
        answer = answer_of(
            state.version,
            case,
            solve(scenario, case.scheme, time_limit_s=_PROOF_LIMIT_S, on_progress=on_progress),
        )
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


def flights(state: State, go_on: Callable[..., None] = lambda *_: None) -> Iterator[Flight]:
    """Yield the flight that is asked for, or why there is none; nothing if none is.

    Args:
        state: with the scene in motion.
        go_on: called now and then; what it raises ends the search.
    """
    if (flight := state.flight) is not None and flight.found is None:
        try:
            found = solve_trajectory(flight.motion, time_limit_s=FLIGHT_LIMIT_S, on_progress=go_on)
            words = (each.replace(" -", f" {MINUS}") for each in flight_words(found, sample_between(found)))
            yield replace(flight, words=tuple(words), found=found)
        except NullposeError as error:
            yield replace(flight, words=(f"no flight: {error}",))


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
        serve: called in the thread with the worker and the newest state, to publish what answers it.
        rest_s: how long nothing must have changed before a proof begins, seconds; as long again, and the plot
            and the maps do.
        name: of the thread.
    """

    def __init__(
        self,
        publish: Callable[[Event], None],
        serve: Callable[[Worker, State], None],
        *,
        rest_s: float = REST_S,
        name: str = "worker",
    ) -> None:
        self._publish, self._serve, self._rest_s = publish, serve, rest_s
        self._news, self._closed = threading.Event(), False
        self._newest: State | None = None
        self._thread = threading.Thread(target=self._run, name=f"nullpose-studio-{name}", daemon=True)
        self._thread.start()

    def request(self, state: State) -> None:
        """Ask for answers to a version of the scene; the work for an older one is dropped.

        Args:
            state: with the scene; its version is larger than any before.
        """
        self._newest = state
        self._news.set()

    def close(self, timeout_s: float = 5.0) -> bool:
        """End the thread; True if it ended within a time.

        Args:
            timeout_s: the longest to wait, seconds.
        """
        self._closed = True
        self._news.set()
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def _run(self) -> None:
        while self._news.wait():
            self._news.clear()  # first: what comes now is the newest, or ends the steps at once
            if self._closed or (state := self._newest) is None:
                return
            try:
                with announce_compiling(
                    partial(self._publish, Notice(version=state.version, case=None, words=_COMPILING))
                ):
                    self._serve(self, state)
            except _SupersededError:
                continue
            except Exception:
                _log.exception("the studio's worker met an unexpected fault")

    def publish_all(
        self, state: State, case: PoseCase | None, events: Iterable[AnyEvent], *, late: bool = False
    ) -> AnyEvent | None:
        """Publish events and return the last; a failure is published in their place, and None returned.

        Args:
            state: that they are of.
            case: that they are of; None for no single one.
            events: in turn.
            late: whether they are published even if a newer version was requested.
        """
        last = None
        try:
            for last in events:
                if not late:
                    self.go_on()
                self._publish(last)
        except NullposeError as error:
            self.go_on()
            self._publish(Notice(version=state.version, case=case, words=f"no pose: {error}"))
            return None
        return last

    def progress(self, state: State, case: PoseCase) -> Callable[[float, int], None]:
        """Return a callback for a proof, which publishes its progress ten times a second at most.

        Args:
            state: that is solved.
            case: that is proved.
        """
        # the proof of a rate tells the gap of the ratio
        published_at, is_rate = time.monotonic(), Quantity.of(state.scenario).is_rate

        def on_progress(gap: float, boxes: int) -> None:
            nonlocal published_at
            self.go_on()
            if not is_rate and math.isfinite(gap) and time.monotonic() - published_at > _PROGRESS_S:
                published_at = time.monotonic()
                self._publish(Progress(version=state.version, case=case, gap=gap, boxes=boxes))

        return on_progress

    def go_on(self, *_: object) -> None:
        """End the step if its scene is no longer the newest; takes whatever a solver says of its progress."""
        if self._news.is_set():
            raise _SupersededError

    def rest(self) -> None:
        """Wait until nothing has changed for a while; ends the step if something does."""
        self._news.wait(self._rest_s)
        self.go_on()


def answer_poses(worker: Worker, state: State) -> None:
    """Answer a version of the scene: a search at once, at rest the proofs, then plot, maps and least tilt.

    Args:
        worker: publishes the answers.
        state: with the scene.
    """
    for case in state.cases:
        # published even if the hand has moved on since: else nothing would move while it does
        worker.publish_all(state, case, quick_answers(state, case), late=True)
    worker.rest()
    proved = [
        worker.publish_all(state, case, proved_answers(state, case, worker.progress(state, case)))
        for case in state.cases
    ]
    worker.rest()  # as long again: what takes longer than a proof would be in the way of the next move
    worker.publish_all(state, state.case, power_curves(state, worker.go_on))
    if (best := next(filter(None, proved), None)) is not None:
        while map_compiler().is_busy():
            worker.rest()
        worker.publish_all(state, best.case, [field_map(best, worker.go_on)])
        worker.publish_all(state, best.case, least_tilts(state, worker.go_on))


def answer_flight(worker: Worker, state: State) -> None:
    """Answer with the flight that is asked for.

    Args:
        worker: publishes it.
        state: with the scene in motion.
    """
    worker.publish_all(state, None, flights(state, worker.go_on))
