"""The cases on offer."""

from pathlib import Path

from nullpose import apply_overrides, load
from nullpose.scenario import Scenario
from nullpose.studio.case import CASES, OPTIMUM, case_named, cases_of
from nullpose.study import AIRFRAME_CASES


def test_the_papers_cases_and_vehicles_are_offered(paper: Scenario, unsure: Scenario) -> None:
    """Its four cases under labels of their own, the vehicles, and a robust one only if it states errors."""
    assert [case_named(case.label) for case in CASES] == list(CASES)
    assert "Robust pose" in [case.label for case in cases_of(unsure)]
    labels = [case.label for case in cases_of(paper)]
    assert labels[:4] == ["Optimum pose", "Zero interference", "Maximum gain", "Vertical"]
    assert "Robust pose" not in labels
    assert sum(label.startswith("Vehicle: ") for label in labels) == len(AIRFRAME_CASES)


def test_a_secrecy_rate_leaves_few_cases(secret: Scenario) -> None:
    """Cases that the paper states for a receiving drone are not offered for a transmitting one."""
    labels = [case.label for case in cases_of(secret)]
    assert "Zero interference" not in labels
    assert "Optimum pose" in labels


def test_every_case_that_is_offered_has_a_meaning(paper: Scenario) -> None:
    """A file that is loaded after another, with another antenna, has the cases of its own."""
    cases_of(paper)
    frame = load(Path(__file__).parents[2] / "examples" / "frame.toml")
    assert [case.label for case in cases_of(frame) if case.missing(frame) is not None] == []


def test_what_the_solver_refuses_is_not_offered() -> None:
    """Among buildings no robust pose; the best pose says why."""
    town = load(Path(__file__).parents[2] / "examples" / "town.toml")
    unsure = apply_overrides(town, ["receiver.attitude_error_deg=1"])
    labels = [case.label for case in cases_of(unsure)]
    assert "Vertical" in labels
    assert "Robust pose" not in labels
    assert "robust poses do not allow for its" in OPTIMUM.left_out(unsure)


def test_a_vehicle_takes_the_place_of_the_scenarios_own(paper: Scenario) -> None:
    """A vehicle's case solves the same scene with another airframe."""
    level = case_named("Vehicle: level, vertical").on(paper)
    assert level.axis_band == (1.0, 1.0)
    assert level.nodes == paper.nodes
    assert OPTIMUM.on(paper) == paper
