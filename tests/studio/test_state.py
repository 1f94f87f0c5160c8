"""What a user changes: every change makes another view."""

import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario, load
from nullpose.studio.case import OPTIMUM, case_named
from nullpose.studio.state import State


def test_a_moved_point_moves_alone(paper: Scenario) -> None:
    """Moving the jammer changes its position, to a millimetre, and nothing else; the first state stays."""
    view = State(scenario=paper)
    moved = view.moved(("jammers", 0), (1.00049, 2.0, 3.0))
    assert moved.scenario.jammers[0].position_m == (1.0, 2.0, 3.0)
    assert moved.scenario.nodes == paper.nodes
    assert view.scenario == paper
    assert moved.moved(("jammers", 0), (17.0, 15.0, 4.0)).scenario == paper


def test_all_jammers_are_scaled_alike(paper: Scenario) -> None:
    """The power set is the strongest jammer's over the strongest node's; ratios of jammers stay."""
    weak = paper.jammers[0].model_copy(update={"name": "W", "position_m": (30.0, 40.0, 0.0), "power_w": 0.1})
    both = State(scenario=paper.model_copy(update={"jammers": (*paper.jammers, weak)}))
    assert both.power_db == pytest.approx(0.0)
    louder = both.with_power_db(20.0)
    assert louder.power_db == pytest.approx(20.0)
    assert [j.transmit_power_w for j in louder.scenario.jammers] == pytest.approx([100.0, 10.0])
    assert louder.with_power_db(0.0).scenario == both.scenario
    silent = State(scenario=paper.model_copy(update={"jammers": ()}))
    assert silent.power_db is None
    assert silent.with_power_db(10.0) == silent


@pytest.mark.parametrize(("text", "power_db"), [("12.3456", 12.3456), (" 1e1 ", 10.0), ("\u221230", -30.0)])
def test_a_typed_power_holds_as_typed(paper: Scenario, text: str, power_db: float) -> None:
    """What is typed in the range is the power to the last digit, and is shown so."""
    view = State(scenario=paper).with_power_text(text)
    assert view.power_db == pytest.approx(power_db, abs=1e-9)
    assert view.power_text == f"{power_db:g}"
    assert view.with_power_text(view.power_text) is view


@pytest.mark.parametrize("text", ["-99", "1e3", "12,5", "nan", "inf", "-", ""])
def test_a_typed_power_out_of_range_is_refused(paper: Scenario, text: str) -> None:
    """It is said what was given, what is allowed, and what holds."""
    with pytest.raises(ScenarioError, match=rf"given {text or 'nothing'}; .*-30 to 40.* stays at 0"):
        State(scenario=paper).with_power_text(text)


def test_another_scenario_keeps_the_cases_that_it_has(paper: Scenario, secret: Scenario) -> None:
    """A case without meaning for a loaded scenario gives way to one that has; a second case falls away."""
    gain, vertical = case_named("Maximum gain"), case_named("Vertical")
    view = State(scenario=paper, case=gain, compared=vertical)
    assert view.with_scenario(paper) == view
    other = view.with_scenario(secret)
    assert other.case == OPTIMUM
    assert other.compared == vertical


def test_a_case_is_not_compared_with_itself(paper: Scenario) -> None:
    """Choosing the compared case as the first compares nothing."""
    vertical = case_named("Vertical")
    assert State(scenario=paper, compared=vertical).with_case(vertical).compared is None


def test_a_relays_destination_is_moved_like_a_node() -> None:
    """It is one of the points; another place is its own alone, and without it there is no relay."""
    view = State(scenario=load("examples/relay.toml"))
    key = ("destinations", 0)
    assert dict(view.points())[key].name == "command post"
    moved = view.moved(key, (700.0, 90.0, 5.0))
    assert moved.scenario.destination.position_m == (700.0, 90.0, 5.0)
    assert moved.scenario.nodes == view.scenario.nodes
    with pytest.raises(ScenarioError, match=r"headed \[destination\]"):
        view.with_members("destinations", [])


def test_a_source_is_moved_like_a_node() -> None:
    """Where the drone jams, sources are among the points, and another place is one's own alone."""
    view = State(scenario=load("examples/friendly-jamming.toml"))
    assert ("sources", 0) in dict(view.points())
    moved = view.moved(("sources", 0), (5.0, 6.0, 7.0))
    assert moved.scenario.sources[0].position_m == (5.0, 6.0, 7.0)
    assert moved.scenario.nodes == view.scenario.nodes
