"""The solves behind a page: a quick one while the hand moves, a proved one when it rests, a power curve."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from nullpose.scenario import Scenario
from nullpose.solve import PAPER_SCHEMES, Scheme, Solution, Status, solve
from nullpose.solve.robust import solve_robust
from nullpose.studio.answer import Answer, Stage, answer_of, robust_answer_of
from nullpose.studio.case import Case
from nullpose.studio.events import PowerCurve
from nullpose.studio.view import POWER_DB, View
from nullpose.study import SweepRow, SweepTable

__all__ = ["POWER_LABEL", "power_curves", "proved_answers", "quick_answer"]

POWER_LABEL = "jamming power over node power (dB)"
"""What the power curve is drawn over."""

_PROOF_LIMIT_S = 30.0
_ROBUST_LIMIT_S = 20.0
_CURVE_POINTS = 15
_CURVE_SHOWN = 4  # a growing plot is drawn after so many points more
_QUICKLY_PROVED = 2  # nodes up to which a rough proof takes half the time of a thorough search
_QUICK_GAP = 1e-2
_QUICK_BOXES = 1000
_QUICK_ROBUST = "Best pose where all is as stated; what it guarantees is worked out at rest"


def quick_answer(version: int, view: View, case: Case) -> Answer:
    """Return the best pose that is found in a moment, for as long as the hand moves.

    For the robust case it is the pose that is best without errors.

    Args:
        version: the version of the scene.
        view: the scene.
        case: what to solve.

    Raises:
        NullposeError: there is no pose, or the case has no meaning here.
    """
    found = answer_of(version, case, _quick_solution(case.on(view.scenario), case.scheme))
    if found.stage is not Stage.BEST_SO_FAR:  # how far it is proved is for the proof to say, a moment later
        found = replace(found, stage=Stage.BEST_SO_FAR, bound=None, gap=None)
    return replace(found, note=_QUICK_ROBUST) if case.robust else found


def _quick_solution(scenario: Scenario, scheme: Scheme) -> Solution:
    """Return a rough proof's pose where that is quick, else that of a search which needs none."""
    if len(scenario.nodes) <= _QUICKLY_PROVED:
        proved = solve(scenario, scheme, gap=_QUICK_GAP, node_limit=_QUICK_BOXES, threads=1)
        if proved.status is Status.CERTIFIED:
            return proved
    return solve(scenario, scheme, certify=False)


def proved_answers(
    version: int, view: View, case: Case, on_progress: Callable[[float, int], None]
) -> Iterator[Answer]:
    """Yield the answers that a proof leads to, each better known than the one before.

    Args:
        version: the version of the scene.
        view: the scene.
        case: what to solve.
        on_progress: called now and then; what it raises ends the proof.

    Raises:
        NullposeError: there is no pose, or the case has no meaning here.
    """
    scenario = case.on(view.scenario)
    if case.robust:
        for certify in (False, True):
            yield robust_answer_of(
                version,
                case,
                solve_robust(
                    scenario, certify=certify, time_limit_s=_ROBUST_LIMIT_S, on_progress=on_progress
                ),
            )
        return
    yield answer_of(
        version,
        case,
        solve(scenario, case.scheme, time_limit_s=_PROOF_LIMIT_S, on_progress=on_progress),
    )


def power_curves(version: int, view: View, go_on: Callable[[], None] = lambda: None) -> Iterator[PowerCurve]:
    """Yield the schemes' values against the jamming power, first at few powers and then at more.

    The poses are searched for, not proved. Nothing comes without a jamming power to vary.

    Args:
        version: the version of the scene.
        view: the scene.
        go_on: called before every search; what it raises ends the curve.

    Raises:
        NullposeError: there is no pose at some power.
    """
    if view.power_db is None:
        return
    schemes = [one for one in PAPER_SCHEMES if one.not_applicable(view.scenario) is None]
    low_db, high_db = POWER_DB
    rows: dict[tuple[float, str], SweepRow] = {}
    for every in (7, 1):
        for i in range(0, _CURVE_POINTS, every):
            power_db = low_db + (high_db - low_db) * i / (_CURVE_POINTS - 1)
            at_power = view.with_power_db(power_db)
            for scheme in schemes:
                if (power_db, scheme.value) not in rows:
                    go_on()
                    solution = solve(Case(label="").on(at_power.scenario), scheme, certify=False)
                    rows[power_db, scheme.value] = SweepRow.of(power_db, solution)
            if every == 1 and i % _CURVE_SHOWN == _CURVE_SHOWN - 1:
                yield _curve(version, rows, complete=False)
        yield _curve(version, rows, complete=every == 1)


def _curve(version: int, rows: dict[tuple[float, str], SweepRow], *, complete: bool) -> PowerCurve:
    table = SweepTable(path=POWER_LABEL, rows=tuple(rows[key] for key in sorted(rows)))
    return PowerCurve(version=version, table=table, complete=complete)
