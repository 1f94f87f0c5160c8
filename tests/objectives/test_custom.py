"""Objectives that are functions in Python: what a scenario refuses of them, and what they evaluate."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nullpose
from nullpose import Scenario
from nullpose.errors import ScenarioError
from nullpose.objective import Custom

FIELD: dict[str, Any] = {
    "nodes_m": [[0, 0, 0], [0, 50, 0], [30, 10, 0]],
    "jammers_m": [[17, 15, 4]],
    "noise_w": 1e-3,
    "altitude_m": (8, 30),
}


def test_it_stands_beside_the_other_names_of_the_package() -> None:
    """As ``nullpose.objective.Custom``, and imported from there."""
    assert nullpose.objective.Custom is Custom


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda sinr: math.nan, r"returns nan .* must return a finite number"),
        (lambda sinr: math.inf, r"returns inf .* must return a finite number"),
        (lambda sinr: -math.inf, r"returns -inf .* must return a finite number"),
        (lambda sinr: sinr, r"returns array\(.* must return a finite number"),
        (lambda sinr: None, r"returns None .* must return a finite number"),
        (lambda sinr: "much", r"returns 'much' .* must return a finite number"),
        (lambda sinr: -float(np.min(sinr)), r"falls from .* must fall with no SINR"),
        (lambda sinr: float(sinr[0] + sinr[1] - sinr[2]), r"falls .* where the SINR of node 3 rises"),
    ],
)
def test_functions_that_are_no_objective_are_refused(function: Callable[..., Any], words: str) -> None:
    """By the scenario, with what they return or where they fall, and the key at fault."""
    with pytest.raises(ScenarioError, match=rf"^objective: got mine, which {words}"):
        Scenario.from_arrays(**FIELD, objective=Custom(function, name="mine"))


@pytest.mark.parametrize(
    "function",
    [
        np.min,
        np.median,
        np.sum,
        lambda sinr: np.mean(np.log(sinr)),
        lambda sinr: float(sinr[1]),
        lambda sinr: 3,
    ],
)
def test_functions_that_fall_nowhere_are_taken(function: Callable[..., Any]) -> None:
    """One that does not rise with every SINR, too."""
    scenario = Scenario.from_arrays(**FIELD, objective=Custom(function))
    assert str(scenario.objective) == scenario.to_dict()["objective"] == "custom"


def test_its_value_is_that_of_the_function_at_the_pose() -> None:
    """Evaluated from the SINRs that the pose gives, which the function may change."""

    def second(sinr: Any) -> float:
        sinr.sort()
        return float(sinr[1])

    scenario = Scenario.from_arrays(**FIELD, objective=Custom(second))
    pose = nullpose.Pose([10.0, 20.0, 9.0], roll_rad=0.3, pitch_rad=-1.0)
    links = nullpose.evaluate(scenario, pose)
    found = nullpose.solve(scenario)
    (given,) = nullpose.evaluate_against(found, [pose]).results
    assert given.objective.value == sorted(link.sinr for link in links)[1]
    assert (given.objective.upper_bound, given.status) == (None, "given")
    assert found.objective.value > given.objective.value


def test_no_file_can_hold_it() -> None:
    """What a scenario writes in its place is no objective's name."""
    scenario = Scenario.from_arrays(**FIELD, objective=Custom(np.min, name="worst"))
    with pytest.raises(ScenarioError, match=r'^objective: got the text "worst"'):
        Scenario.from_dict(scenario.to_dict())


def test_weights_have_no_meaning_under_it() -> None:
    """The function states them."""
    table = Scenario.from_arrays(**FIELD).to_dict()
    nodes = [node | {"weight": 2.0} for node in table["nodes"]]
    with pytest.raises(ScenarioError, match=r"nodes\[0\]\.weight: has no meaning"):
        Scenario.from_dict(table | {"nodes": nodes, "objective": Custom(np.min)})
