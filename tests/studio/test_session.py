"""A session: what is shown always belongs to the present scene, or is said not to."""

import threading
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, seed, strategies as st

from nullpose import load
from nullpose.errors import ScenarioError, SolveError
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.solver import Status, solve
from nullpose.studio.answer import Answer, Progress
from nullpose.studio.case import CASES, OPTIMUM, case_named
from nullpose.studio.session import History, Session
from nullpose.studio.state import Event, Key, State

_PATIENCE_S = 120.0
EXAMPLES = Path(__file__).parents[2] / "examples"
JAMMER: Key = ("jammers", 0)


def wait(condition: Callable[[], bool]) -> None:
    """Wait until a condition holds; fail if it never does."""
    until = time.monotonic() + _PATIENCE_S
    while not condition():
        assert time.monotonic() < until, "it never came"
        time.sleep(0.01)


@pytest.fixture
def session(paper: Scenario) -> Iterator[Session]:
    """A session of the paper's scene, started."""
    running = Session(State(scenario=paper), rest_s=0.05)
    running.start()
    yield running
    assert running.close(_PATIENCE_S)


def _certified(session: Session) -> bool:
    answer = session.state.current(session.state.case)
    return answer is not None and answer.result.status is Status.CERTIFIED


def test_the_answer_is_the_solvers(session: Session) -> None:
    """What is certified is what the solver says of the same scene, before a move and after one."""
    for position_m in ((17.0, 15.0, 4.0), (25.0, 30.0, 4.0)):
        session.change(lambda view, place=position_m: view.moved(JAMMER, place))
        wait(lambda: _certified(session))
        answer = session.state.answer(OPTIMUM)
        assert answer is not None
        expected = solve(session.state.scenario)
        assert answer.result.objective.value == pytest.approx(expected.objective.value, rel=1e-9)
        assert answer.result.objective.upper_bound == pytest.approx(expected.objective.upper_bound, rel=1e-9)


def test_an_old_answer_is_never_current(session: Session) -> None:
    """From a change until its answer the status is solving, whatever was known before."""
    wait(lambda: _certified(session))
    old = session.state.answer(OPTIMUM)
    session.change(lambda view: view.moved(JAMMER, (30.0, 30.0, 4.0)))
    seen = session.state.answer(OPTIMUM)
    if seen is old:
        assert session.state.current(OPTIMUM) is None
        assert session.state.status(OPTIMUM) == "solving"
    wait(lambda: _certified(session))
    new = session.state.answer(OPTIMUM)
    assert new is not None
    assert new.version == session.state.version
    assert session.state.status(OPTIMUM).startswith("certified to 1e-6")


def test_everything_told_names_its_version(paper: Scenario) -> None:
    """Versions only grow, each answer is of the scene of its version, and the last scene is answered."""
    answers: list[Answer] = []
    session = Session(
        State(scenario=paper),
        on_event=lambda event: answers.append(event) if isinstance(event, Answer) else None,
        rest_s=0.05,
    )
    scenes = {}
    for i in range(12):
        session.change(lambda view, i=i: view.moved(JAMMER, (17.0 + i, 15.0 + i, 4.0)), "drag")
        scenes[session.state.version] = session.state.scenario
        time.sleep(0.01)
    wait(lambda: _certified(session))
    assert session.close(_PATIENCE_S)
    versions = [answer.version for answer in answers]
    assert versions == sorted(versions)
    assert all(answer.result.scenario == scenes[answer.version] for answer in answers)
    assert versions[-1] == session.state.version


def test_maps_and_curve_follow_at_rest(session: Session) -> None:
    """At rest the maps and the whole power curve of the present version come; a change outdates the maps."""
    wait(lambda: session.state.field_map is not None)
    curve = session.state.curve
    assert curve is not None
    assert curve.complete
    assert curve.version == session.state.version
    session.change(lambda view: view.with_power_db(10.0))
    assert session.state.field_map is None


def test_two_cases_are_answered(session: Session) -> None:
    """With a second case chosen both are certified, the free axis at least as good."""
    vertical = case_named("Vertical")
    session.change(lambda view: view.with_compared(vertical))
    wait(lambda: session.state.status(vertical).startswith("certified") and _certified(session))
    first, second = session.state.answer(OPTIMUM), session.state.answer(vertical)
    assert first is not None
    assert second is not None
    assert first.result.objective.value >= second.result.objective.value


def test_undo_and_redo_are_solved_too(session: Session) -> None:
    """One step back is the scene before, with an answer of its own."""
    session.change(lambda view: view.with_power_db(20.0))
    session.undo()
    assert session.state.power_db == pytest.approx(0.0)
    assert session.history.future
    session.redo()
    assert session.state.power_db == pytest.approx(20.0)
    wait(lambda: _certified(session))


def test_a_refused_change_changes_nothing(session: Session) -> None:
    """A place that makes no scenario leaves version and view as they were."""
    state = session.state
    with pytest.raises(ScenarioError):
        session.change(lambda view: view.moved(JAMMER, (float("inf"), 0.0, 0.0)))
    assert session.state == state


def test_a_scene_without_a_pose_says_so(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the solver finds no pose, the status is its message, and the session goes on."""
    wait(lambda: _certified(session))

    def none(*_: object, **__: object) -> Answer:
        raise SolveError("no position was found")

    with monkeypatch.context() as patched:
        patched.setattr("nullpose.studio.steps.solve", none)
        session.change(lambda view: view.with_power_db(10.0))
        wait(lambda: session.state.status(OPTIMUM) == "no pose: no position was found")
    session.undo()
    wait(lambda: _certified(session))


def test_a_closed_session_leaves_no_thread(paper: Scenario) -> None:
    """Closing ends the worker, in the middle of whatever it does."""
    for pause_s in (0.0, 0.02, 0.3):
        session = Session(State(scenario=paper), rest_s=0.01)
        session.start()
        time.sleep(pause_s)
        assert session.close(_PATIENCE_S)
    assert not [thread for thread in threading.enumerate() if thread.name == "nullpose-studio-worker"]


@pytest.mark.parametrize("file", ["/etc/hostname", "/etc/passwd.csv", "nodes.csv", "../nodes.csv"])
def test_a_loaded_file_may_name_no_other(file: str) -> None:
    """What the page sends reads no file of this machine: it is refused, and told what to do instead."""
    with pytest.raises(ScenarioError) as raised:
        scenario_from_text(f'nodes_from = "{file}"\n'.encode(), "mine.toml")
    (fault,) = raised.value.faults
    assert fault.path == "nodes_from"
    assert "list the nodes here, under [[nodes]]" in fault.message


def test_a_loaded_file_is_bounded() -> None:
    """More than 10 MB are refused unread."""
    with pytest.raises(ScenarioError, match="larger than 10 MB"):
        scenario_from_text(b"#" * 10_000_001, "mine.toml")


def test_a_long_proof_tells_how_far_it_has_come() -> None:
    """At most ten times a second, and only of the present scene; a new scene ends it."""
    told: list[tuple[float, Progress]] = []

    def take(event: Event) -> None:
        if isinstance(event, Progress):
            told.append((time.monotonic(), event))

    session = Session(State(scenario=load(EXAMPLES / "frame.toml")), rest_s=0.05, on_event=take)
    session.start()
    wait(lambda: len(told) > 2)
    assert session.state.progress(OPTIMUM) is not None
    session.change(lambda view: view.moved(JAMMER, (30.0, 30.0, 4.0)))
    assert session.state.progress(OPTIMUM) is None
    assert session.close(_PATIENCE_S)
    assert all(event.gap > event.target and event.boxes > 0 for _, event in told)
    assert min(after[0] - before[0] for before, after in pairwise(told)) > 0.09


def test_one_gesture_is_one_step(paper: Scenario) -> None:
    """All positions of one drag are undone together, and two drags apart."""
    history = History(State(scenario=paper))
    for drag in ("first", "second"):
        for step in range(5):
            east_m = {"first": 20.0, "second": 40.0}[drag] + step
            history = history.changed(history.present.moved(("jammers", 0), (east_m, 15.0, 4.0)), drag)
    assert history.present.scenario.jammers[0].position_m[0] == 44.0
    assert history.undone().present.scenario.jammers[0].position_m[0] == 24.0
    assert history.undone().undone().present.scenario == paper


def test_a_change_forgets_what_was_undone(paper: Scenario) -> None:
    """After undo and another change there is nothing to redo."""
    start = History(State(scenario=paper))
    undone = start.changed(start.present.with_power_db(5.0)).undone()
    assert undone.future
    assert not undone.changed(undone.present.with_power_db(7.0)).future


def test_no_change_is_no_step(paper: Scenario) -> None:
    """An equal scene is no step; a switch neither."""
    history = History(State(scenario=paper))
    assert history.changed(State(scenario=paper)).past == ()
    assert history.undone() is history
    assert history.redone() is history


@seed(0)
@given(choices=st.lists(st.integers(0, 3), max_size=12), back=st.integers(0, 15))
def test_redo_takes_back_undo(choices: list[int], back: int) -> None:
    """As many steps forward as back lead to the same view."""
    history = History(State(scenario=load(EXAMPLES / "paper.toml")))
    for choice in choices:
        history = history.changed(history.present.with_case(CASES[choice]))
    there = history
    steps = min(back, len(history.past))
    for _ in range(steps):
        there = there.undone()
    for _ in range(steps):
        there = there.redone()
    assert there.present.scene == history.present.scene
    assert len(there.past) == len(history.past)


def test_it_does_not_grow_without_end(paper: Scenario) -> None:
    """Only so many steps are kept."""
    history = History(State(scenario=paper))
    for i in range(300):
        history = history.changed(history.present.moved(("jammers", 0), (float(i), 15.0, 4.0)))
    assert len(history.past) == 200
