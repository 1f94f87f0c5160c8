"""A scene in motion: the instant that the slider is at is shown and solved, and it plays to its end."""

import threading
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from unittest.mock import MagicMock

import pytest
from hypothesis import given, seed, strategies as st

from nullpose import load, solve
from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.studio.case import OPTIMUM
from nullpose.studio.edits import entries_of, with_added, with_typed, without
from nullpose.studio.panel import Panel
from nullpose.studio.player import FRAME_S, Player
from nullpose.studio.session import History, Session
from nullpose.studio.state import Key, State
from nullpose.studio.toml_like import toml_like

FILE = Path(__file__).parents[2] / "examples" / "moving_jammer.toml"
MOTION = load(FILE)
JAMMER: Key = ("jammers", 0)
_PATIENCE_S = 600.0


def opened(scenario: Scenario = MOTION) -> State:
    """Return the state of a page that opens a scene."""
    return State(scenario=scenario.still()).with_scenario(scenario, FILE.read_text())


def changer(session: Session, shown_s: list[tuple[float, float | None]]) -> Callable[..., bool]:
    """Return what changes a session's state as a page does, and notes its instants and when they came."""

    def change(step: Callable[[State], State]) -> bool:
        try:
            session.change(step)
        except ScenarioError:
            return False
        shown_s.append((time.monotonic(), session.state.scenario.at_s))
        return True

    return change


@pytest.fixture
def session() -> Iterator[Session]:
    """A session of the scene in motion, with five instants, started."""
    coarse = MOTION.model_copy(update={"time": MOTION.time.model_copy(update={"step_s": 16.0})})
    running = Session(opened(coarse), rest_s=0.05)
    running.start()
    yield running
    assert running.close(_PATIENCE_S)


@seed(0)
@given(t_s=st.floats(0.0, 60.0))
def test_the_slider_shows_its_instant(t_s: float) -> None:
    """The scene is exactly the one of the nearest instant, and the panel says which."""
    state = opened().at_time(t_s)
    assert abs(state.scenario.at_s - t_s) <= 0.5
    assert state.scenario == MOTION.at(state.scenario.at_s)
    assert opened().at_time(90.0).scenario == MOTION.at(60.0)


def test_an_instant_is_solved_like_a_scene_of_its_own(session: Session) -> None:
    """The value at the slider's instant is that of solving it alone; a move in time is no step to undo."""
    session.change(lambda state: state.at_time(16.0))
    until = time.monotonic() + _PATIENCE_S
    while not session.state.is_answered:
        assert time.monotonic() < until
        time.sleep(0.01)
    found = session.state.current(OPTIMUM).result.objective
    assert found.value == pytest.approx(solve(MOTION.at(16.0), certify=False).objective.value, rel=1e-6)
    assert session.history.past == ()


def test_a_play_shows_every_instant_with_its_pose_and_ends_at_the_last(session: Session) -> None:
    """At most five a second, each solved before the next; from the end it begins at 0 again."""
    shown_s: list[tuple[float, float | None]] = []
    solved_s: set[float | None] = set()
    change = changer(session, shown_s)

    def step(how: Callable[[State], State]) -> bool:
        assert session.state.is_answered or not shown_s
        solved_s.add(session.state.scenario.at_s)
        return change(how)

    player, until = Player(session, step), time.monotonic() + _PATIENCE_S
    player.press()
    while player.is_playing:
        assert time.monotonic() < until
        time.sleep(0.01)
    assert [t_s for _, t_s in shown_s] == [16.0, 32.0, 48.0, 60.0]
    assert session.state.is_answered
    assert solved_s == {0.0, 16.0, 32.0, 48.0}
    times = [at for at, _ in shown_s]
    assert all(after - before >= FRAME_S for before, after in pairwise(times))
    player.press()
    while session.state.scenario.at_s != 0.0:
        assert time.monotonic() < until
    player.press()
    assert not player.is_playing
    time.sleep(3 * FRAME_S)
    assert session.state.scenario.at_s == 0.0
    assert not [thread for thread in threading.enumerate() if thread.name == "nullpose-studio-player"]


def test_edits_are_of_the_whole_motion() -> None:
    """What is edited at one instant holds at all, and the file keeps its motion."""
    state = opened().at_time(10.0)
    edited = without(with_added(state.with_power_db(10.0), "jammer", (5.0, 5.0), 100.0), ("nodes", 1))
    edited = edited.moved(("nodes", 0), (1.0, 2.0, 0.0))
    (tilt, *_) = entries_of(edited, None)
    edited = with_typed(edited, tilt, "30")
    for t_s in (10.0, 40.0):
        scene = edited.at_time(t_s).scenario
        assert scene.jammers[0].position_m == MOTION.at(t_s).jammers[0].position_m
        assert [jammer.power_w for jammer in scene.jammers] == pytest.approx([10.0, 10.0])
        assert [node.position_m for node in scene.nodes] == [(1.0, 2.0, 0.0)]
        assert scene.airframe.tilt_max_deg == 30.0
    assert toml_like(state.text, state.draft) == FILE.read_text()
    assert scenario_from_text(toml_like(edited.text, edited.draft).encode(), FILE.name) == edited.motion


def test_a_point_in_motion_is_not_put_elsewhere() -> None:
    """It is refused in words, dragged or typed, and its place now is what the panel shows."""
    state = opened().at_time(10.0)
    with pytest.raises(ScenarioError, match=r"jammers\[0\]\.position_m: it moves"):
        state.moved(JAMMER, (0.0, 1.0, 2.0))
    east = entries_of(state, JAMMER)[1]
    assert east.text == "-20"
    with pytest.raises(ScenarioError, match=r"jammers\[0\]\.position_m: it moves"):
        with_typed(state, east, "5")


def test_only_a_scene_in_motion_has_a_slider(paper: Scenario) -> None:
    """It goes to the last instant by the scene's step, and is at the instant that is shown.

    A flight is planned only for a vehicle with a speed.
    """
    gui = MagicMock()
    for add in (gui.add_multi_slider, gui.add_text, gui.add_button):
        add.side_effect = lambda *_, **__: MagicMock()
    panel = Panel(gui, MagicMock())
    panel.render(History(State(scenario=paper)))
    assert not panel.time.visible
    assert not panel.play.visible
    assert not panel.plan.visible
    slow = MOTION.airframe.model_copy(update={"speed_max_m_s": None})
    panel.render(History(opened(MOTION.model_copy(update={"airframe": slow}))))
    assert panel.play.visible
    assert not panel.plan.visible
    panel.render(History(opened().at_time(7.0)))
    assert panel.time.visible
    assert panel.play.visible
    assert panel.plan.visible
    assert (panel.time.value, panel.time.max, panel.time.step) == ((7.0,), 60.0, 1.0)
