"""The solves behind a page: a quick one while the hand moves, a proved one when it rests, a power curve."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from nullpose.solver import Scheme, SolveKeywords, solve
from nullpose.studio.answer import Answer, PowerCurve, TiltNotice, answer_of, tilt_words, with_errors
from nullpose.studio.case import OPTIMUM, PoseCase
from nullpose.studio.state import POWER_DB, State
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
