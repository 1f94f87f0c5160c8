"""A session: what is shown always belongs to the present scene, or is said not to."""

import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, seed, strategies as st

from nullpose import least_tilt, load
from nullpose.errors import ScenarioError, SolveError
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.solver import Status, solve
from nullpose.studio.answer import Answer, Event, PowerCurve, Progress, TiltNotice
from nullpose.studio.case import CASES, OPTIMUM, case_named
from nullpose.studio.readout import card_html
from nullpose.studio.session import History, Session
from nullpose.studio.state import Key, State
from scenes import EXAMPLES

_PATIENCE_S = 600.0
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


def test_the_answer_is_the_solvers_and_never_an_old_one(session: Session) -> None:
    """What is certified is what the solver says of the same scene; until then the status is solving."""
    wait(lambda: _certified(session))
    for step in range(2):
        old = session.state.answer(OPTIMUM)
        session.change(lambda view, step=step: view.moved(JAMMER, (25.0 + step, 30.0, 4.0)))
        if session.state.answer(OPTIMUM) is old:
            assert session.state.current(OPTIMUM) is None
            assert session.state.status(OPTIMUM) == "solving"
        wait(lambda: _certified(session))
        found = session.state.current(OPTIMUM).result.objective
        expected = solve(session.state.scenario).objective
        assert found.value == pytest.approx(expected.value, rel=1e-9)
        assert found.upper_bound == pytest.approx(expected.upper_bound, rel=1e-9)
        assert session.state.status(OPTIMUM).startswith("Proved optimal (gap 0.0001 %)")


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
    """At rest maps, power curve and least tilt of the present version come; a change outdates all."""
    wait(lambda: session.state.field_map is not None)
    curve = session.state.latest(PowerCurve)
    assert curve is not None
    assert curve.complete
    assert curve.version == session.state.version
    wait(lambda: session.state.present(TiltNotice) is not None)
    (upright, *_) = least_tilt(session.state.scenario).mounts
    card = card_html(session.state)
    assert f"Least tilt {upright.suffices_deg:.1f}\N{DEGREE SIGN} (mount 0\N{DEGREE SIGN}) for 99 %" in card
    assert f"; {upright.fails_deg:.1f}\N{DEGREE SIGN} is proved too little" in card
    session.change(lambda view: view.with_power_db(10.0))
    assert session.state.field_map is None
    assert "Least tilt" not in card_html(session.state)


def test_two_cases_are_answered(session: Session) -> None:
    """With a second case chosen both are certified, the free axis at least as good."""
    vertical = case_named("Vertical")
    session.change(lambda view: replace(view, compared=vertical))
    wait(lambda: session.state.status(vertical).startswith("Proved") and _certified(session))
    first, second = (session.state.answer(case).result.objective.value for case in (OPTIMUM, vertical))
    assert first >= second


def test_a_session_goes_on_after_failures(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the solver finds no pose, or a change is refused, that is said, and the session goes on."""
    wait(lambda: _certified(session))

    def none(*_: object, **__: object) -> Answer:
        raise SolveError("no position was found")

    with monkeypatch.context() as patched:
        patched.setattr("nullpose.studio.worker.solve", none)
        session.change(lambda view: view.with_power_db(10.0))
        wait(lambda: session.state.status(OPTIMUM) == "no pose: no position was found")
    session.undo()
    assert session.state.power_db == pytest.approx(0.0)
    wait(lambda: _certified(session))
    session.redo()
    state = session.state
    assert state.power_db == pytest.approx(10.0)
    with pytest.raises(ScenarioError, match="position_m"):
        session.change(lambda view: view.moved(JAMMER, (float("inf"), 0.0, 0.0)))
    assert (session.state.version, session.state.scenario) == (state.version, state.scenario)


def test_a_closed_session_leaves_no_thread(paper: Scenario) -> None:
    """Closing ends the worker, in the middle of whatever it does."""
    for pause_s in (0.0, 0.02, 0.3):
        session = Session(State(scenario=paper), rest_s=0.01)
        session.start()
        time.sleep(pause_s)
        assert session.close(_PATIENCE_S)
    assert not [thread for thread in threading.enumerate() if thread.name == "nullpose-studio-worker"]


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ('nodes_from = "/etc/passwd.csv"', "nodes_from"),
        ('nodes_from = "../nodes.csv"', "nodes_from"),
        ('[antenna]\nfile = "/etc/hostname"', "antenna.file"),
        ('[airspace]\ngeofence_from = "/etc/hostname"', "airspace.geofence_from"),
        ("[airspace", "line 1, column 10"),
        ("\udcff", "line 1"),
    ],
)
def test_a_loaded_file_may_name_no_other(text: str, path: str) -> None:
    """What the page sends, of at most 10 MB, reads no file of this machine, and shows no folder of it."""
    with pytest.raises(ScenarioError) as raised:
        scenario_from_text(text.encode(errors="surrogateescape"), "mine.toml")
    assert path in [fault.path for fault in raised.value.faults]
    assert tempfile.gettempdir() not in str(raised.value)
    with pytest.raises(ScenarioError, match="larger than 10 MB"):
        scenario_from_text(b"#" * 10_000_001, "mine.toml")


def test_a_long_proof_tells_how_far_it_has_come() -> None:
    """At most ten times a second, and only of the present scene; a new scene ends it."""
    told: list[tuple[float, Progress]] = []

    def take(event: Event) -> None:
        if isinstance(event, Progress):
            told.append((time.monotonic(), event))

    places_m = np.random.default_rng(1).uniform(0.0, [100.0, 100.0, 5.0], (30, 3))
    many = Scenario.from_arrays(places_m[:20], places_m[20:], noise_w=1e-3, altitude_m=(8.0, 30.0))
    session = Session(State(scenario=many), rest_s=0.05, on_event=take)
    session.start()
    wait(lambda: len(told) > 2)
    assert session.state.present(Progress, OPTIMUM) is not None
    session.change(lambda view: view.moved(JAMMER, (30.0, 30.0, 4.0)))
    assert session.state.present(Progress, OPTIMUM) is None
    assert session.close(_PATIENCE_S)
    assert all(event.gap > 0.0 and event.boxes > 0 for _, event in told)
    assert min(after[0] - before[0] for before, after in pairwise(told)) > 0.09


def _moved(history: History, east_m: float, gesture: str = "") -> History:
    return history.changed(history.present.moved(JAMMER, (east_m, 15.0, 4.0)), gesture)


def test_one_gesture_is_one_step(paper: Scenario) -> None:
    """All positions of one drag are undone together, and two drags apart."""
    history = History(State(scenario=paper))
    for drag, start_m in (("first", 20.0), ("second", 40.0)):
        for step in range(5):
            history = _moved(history, start_m + step, drag)
    assert history.present.scenario.jammers[0].position_m[0] == 44.0
    assert history.undone().present.scenario.jammers[0].position_m[0] == 24.0
    assert history.undone().undone().present.scenario == paper


def test_a_history_keeps_what_can_be_undone(paper: Scenario) -> None:
    """No change and no switch is a step; a change after undo forgets what was undone; 200 steps are kept."""
    history = History(State(scenario=paper))
    assert history.changed(State(scenario=paper, has_pattern=False)).past == ()
    assert history.undone() is history.redone() is history
    undone = _moved(history, 5.0).undone()
    assert undone.future
    assert not _moved(undone, 7.0).future
    for i in range(300):
        history = _moved(history, float(i))
    assert len(history.past) == 200


@seed(0)
@given(choices=st.lists(st.integers(0, 3), max_size=12), back=st.integers(0, 15))
def test_redo_takes_back_undo(choices: list[int], back: int) -> None:
    """As many steps forward as back lead to the same view."""
    history = History(State(scenario=load(EXAMPLES / "paper.toml")))
    for choice in choices:
        history = history.changed(history.present.with_case(CASES[choice]))
    there = history
    for step in (History.undone, History.redone):
        for _ in range(min(back, len(history.past))):
            there = step(there)
    assert there.present.scene == history.present.scene
    assert len(there.past) == len(history.past)
