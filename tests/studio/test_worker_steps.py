"""What is solved behind a page: poses for a moving hand, and the power curve, which can be ended at once."""

import pytest

from nullpose import apply_overrides, load
from nullpose.scenario import Scenario
from nullpose.solver import Status, solve
from nullpose.studio.answer import Flight
from nullpose.studio.case import cases_of
from nullpose.studio.state import State
from nullpose.studio.worker import flights, least_tilts, power_curves, quick_answers


@pytest.mark.parametrize("power_db", [-30.0, 0.0, 20.0, 40.0])
def test_a_quick_answer_is_the_best_pose(paper: Scenario, power_db: float) -> None:
    """Of every case, though nothing of it is said to be proved."""
    state = State(scenario=paper, version=3).with_power_db(power_db)
    for case in cases_of(state.scenario):
        (answer,) = quick_answers(state, case)
        assert answer.version == 3
        assert answer.result.status is Status.BEST_FOUND
        assert answer.result.objective.upper_bound is None
        best = solve(case.on(state.scenario), case.scheme, node_limit=50_000)
        assert answer.result.objective.value == pytest.approx(best.objective.value, rel=1e-6)


class Enough(BaseException):
    """Ends a curve."""


def test_a_curve_asks_before_every_search(paper: Scenario) -> None:
    """So that a moving hand never waits for more than one, and it ends at the search where it is told to."""
    calls: list[int] = []

    def go_on(most: int = 1000) -> None:
        calls.append(1)
        if len(calls) == most:
            raise Enough

    *growing, last = power_curves(State(scenario=paper), go_on)
    assert last.complete
    assert not any(curve.complete for curve in growing)
    assert len(calls) == len(last.table.rows)
    sizes = [len(curve.table.rows) for curve in (*growing, last)]
    assert sizes == sorted(sizes)
    assert len(sizes) >= 4
    calls.clear()
    with pytest.raises(Enough):
        next(power_curves(State(scenario=paper), lambda: go_on(3)))
    assert len(calls) == 3


def test_a_new_scene_ends_the_least_tilt_and_the_planning() -> None:
    """In the middle of a proof."""

    def go_on(*_: object) -> None:
        raise Enough

    with pytest.raises(Enough):
        next(least_tilts(State(scenario=load("examples/field.toml")), go_on))
    motion = load("examples/moving_jammer.toml")
    state = State(scenario=motion.still(), motion=motion)
    with pytest.raises(Enough):
        next(flights(state.with_event(Flight(version=1, motion=motion, words=())), go_on))


def test_where_there_is_no_flight_its_place_says_why() -> None:
    """As the solver does."""
    motion = apply_overrides(load("examples/moving_jammer.toml"), ["airframe.speed_max_m_s=0"])
    state = State(scenario=motion.still(), motion=motion)
    (flight,) = flights(state.with_event(Flight(version=1, motion=motion, words=())))
    assert flight.found is None
    assert flight.words[0].startswith("no flight: airframe.speed_max_m_s: given 0")
