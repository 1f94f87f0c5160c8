"""The solves behind a page: a quick one while the hand moves, a proved one when it rests, a power curve."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import replace

from nullpose.objectives import Quantity
from nullpose.solver import Rigour, Scheme, Status, default_gap_of, solve
from nullpose.solver.robust import ROBUST_GAP
from nullpose.studio.answer import Answer, PowerCurve, answer_of, with_errors
from nullpose.studio.case import OPTIMUM, Case
from nullpose.studio.state import POWER_DB, State
from nullpose.study import ResultRow, ResultTable

POWER_LABEL = "strongest jammer over strongest node (dB)"
"""What the power curve is drawn over."""

_PROOF_LIMIT_S = 30.0
_ROBUST_LIMIT_S = 20.0
_CURVE_POINTS = 15
_CURVE_SHOWN = 4  # a growing plot is drawn after so many points more
_QUICKLY_PROVED = 2  # nodes up to which a rough proof takes half the time of a thorough search
_QUICK_GAP = 1e-2
_QUICK_BOXES = 1000
_proved = threading.Event()  # of this process: before its first proof the proof may have to be compiled
_QUICK_ROBUST = "Best pose where all is as stated; what it guarantees is worked out at rest"


def quick_answers(state: State, case: Case) -> Iterator[Answer]:
    """Yield the best pose that is found in a moment, for as long as the hand moves.

    For the robust case it is the pose that is best without errors. How far any is proved is for the proof to
    say, a moment later.

    Args:
        state: with the scene.
        case: what to solve.

    Raises:
        NullposeError: there is no pose, or the case has no meaning here.
    """
    scenario = case.on(state.scenario)
    if len(scenario.nodes) <= _QUICKLY_PROVED and _proved.is_set():
        found = solve(scenario, case.scheme, gap=_QUICK_GAP, node_limit=_QUICK_BOXES, threads=1)
    else:
        found = solve(scenario, case.scheme, certify=False)
    unproved = replace(found.objective, upper_bound=None, relative_gap=None, rigour=Rigour.NONE)
    result = replace(found, status=Status.BEST_FOUND, objective=unproved, proofs=(), reason="")
    answer = answer_of(state.version, case, result)
    yield replace(answer, note=_QUICK_ROBUST) if case.robust else answer


def proved_answers(state: State, case: Case, on_progress: Callable[[float, int], None]) -> Iterator[Answer]:
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
        _proved.set()
        answer = answer_of(state.version, case, proved)
        yield answer
        yield with_errors(answer)
        return
    for certify in (False, True):
        guarded = solve(
            scenario, robust=True, certify=certify, time_limit_s=_ROBUST_LIMIT_S, on_progress=on_progress
        )
        yield answer_of(state.version, case, guarded)


def target_gap(state: State, case: Case) -> float | None:
    """Return the gap that a case's proof aims at; None of a rate, whose proof tells the gap of the ratio.

    Args:
        state: with the scene.
        case: what is proved.
    """
    scenario = case.on(state.scenario)
    if Quantity.of(scenario).is_rate:
        return None
    return ROBUST_GAP if case.robust else default_gap_of(scenario)


def power_curves(state: State, go_on: Callable[[], None] = lambda: None) -> Iterator[PowerCurve]:
    """Yield the schemes' values against the jamming power, first at few powers and then at more.

    The poses are searched for, not proved. Nothing comes without a jamming power to vary.

    Args:
        state: with the scene.
        go_on: called before every search; what it raises ends the curve.

    Raises:
        NullposeError: there is no pose at some power.
    """
    if state.power_db is None:
        return
    low_db, high_db = POWER_DB
    schemes = [scheme for scheme in Scheme if scheme.not_applicable(state.scenario) is None]
    coarse = range(0, _CURVE_POINTS, 7)
    order = [*coarse, *(i for i in range(_CURVE_POINTS) if i not in coarse)]
    rows: list[ResultRow] = []
    for done, i in enumerate(order, start=1):
        power_db = low_db + (high_db - low_db) * i / (_CURVE_POINTS - 1)
        scenario = OPTIMUM.on(state.with_power_db(power_db).scenario)
        for scheme in schemes:
            go_on()
            rows.append(ResultRow.of(power_db, solve(scenario, scheme, certify=False)))
        complete = done == len(order)
        if complete or (done - len(coarse)) % _CURVE_SHOWN == 0:
            table = ResultTable(
                path=POWER_LABEL, rows=tuple(sorted(rows, key=lambda row: (row.value, row.scheme)))
            )
            yield PowerCurve(version=state.version, table=table, complete=complete)
