"""What the antennas of a scenario cost, and what a pose of their own gets back."""

from pathlib import Path

import pytest

from nullpose import Scenario, load
from nullpose.errors import UsageError
from nullpose.physics import min_sinr
from nullpose.solver import solve
from nullpose.study import AntennaComparison, compare_antennas

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def whips() -> AntennaComparison:
    """Returns the comparison of the paper's scene with whips and a null of 30 dB."""
    return compare_antennas(load(EXAMPLES / "whips.toml"))


def test_the_promise_is_the_papers(whips: AntennaComparison) -> None:
    """What is promised is the optimum of the paper's scene, and the promise is certified."""
    paper = solve(load(EXAMPLES / "paper.toml"))
    assert whips.promised.objective.value == paper.objective.value
    assert whips.promised.status == whips.possible.status == "certified"


def test_received_is_the_physics_of_that_pose(whips: AntennaComparison) -> None:
    """What is received is what the physics makes of the promised pose with the antennas stated."""
    assert whips.received == min_sinr(whips.scenario, whips.promised.pose)
    assert whips.received < whips.with_null
    assert whips.possible.objective.value > 100.0 * whips.received


def test_each_cause_alone_leaves_the_other_out(whips: AntennaComparison) -> None:
    """With the null perfect the ground's antennas are left, and the other way round."""
    pose, data = whips.promised.pose, whips.scenario.to_dict()
    perfect = {key: value for key, value in data.items() if key != "antenna"}
    assert whips.with_ground == min_sinr(Scenario.from_dict(perfect), pose)
    data["nodes"] = [
        {key: value for key, value in node.items() if "antenna" not in key} for node in data["nodes"]
    ]
    assert whips.with_null == min_sinr(Scenario.from_dict(data), pose)


def test_plain_data_have_every_value(whips: AntennaComparison) -> None:
    """The three values of the promised pose, and both solutions without their scenario."""
    told = whips.to_dict()
    assert told["received"] == {"value": whips.received, "unit": "dB"}
    assert "scenario" not in told["promised"]
    assert told["possible"]["objective"]["value"] == whips.possible.objective.value


def test_the_papers_antennas_have_nothing_to_be_compared_with() -> None:
    """A scenario that states no other antenna is refused, with what to state."""
    with pytest.raises(UsageError, match="null_depth_db"):
        compare_antennas(load(EXAMPLES / "paper.toml"))
