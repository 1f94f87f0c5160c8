"""What the antennas of a scenario cost, and what a pose of their own gets back."""

import pytest

from nullpose import Scenario, load
from nullpose.errors import UsageError
from nullpose.physics import min_sinr
from nullpose.solver import solve
from nullpose.study import ResultTable, compare_antennas
from scenes import EXAMPLES


@pytest.fixture(scope="module")
def whips() -> ResultTable:
    """Returns the comparison of the paper's scene with whips and a null of 30 dB."""
    return compare_antennas(load(EXAMPLES / "whips.toml"))


def value_of(table: ResultTable, name: str) -> float:
    """Returns the value of a row."""
    return table.of(name)[0].objective.value


def test_the_promise_is_the_papers(whips: ResultTable) -> None:
    """What is promised is the optimum of the paper's scene, and the promise is certified."""
    paper = solve(load(EXAMPLES / "paper.toml"))
    assert value_of(whips, "promised") == paper.objective.value
    assert whips.of("promised")[0].status == whips.of("possible")[0].status == "certified"


def test_received_is_the_physics_of_that_pose(whips: ResultTable) -> None:
    """What is received is what the physics makes of the promised pose with the antennas stated."""
    assert value_of(whips, "received") == min_sinr(whips.scenario, whips.of("promised")[0].pose)
    assert value_of(whips, "received") < value_of(whips, "with_null")
    assert value_of(whips, "possible") > 100.0 * value_of(whips, "received")


def test_each_cause_alone_leaves_the_other_out(whips: ResultTable) -> None:
    """With the null perfect the ground's antennas are left, and the other way round."""
    pose, data = whips.of("promised")[0].pose, whips.scenario.to_dict()
    perfect = {key: value for key, value in data.items() if key != "antenna"}
    assert value_of(whips, "with_ground") == min_sinr(Scenario.from_dict(perfect), pose)
    data["nodes"] = [
        {key: value for key, value in node.items() if "antenna" not in key} for node in data["nodes"]
    ]
    assert value_of(whips, "with_null") == min_sinr(Scenario.from_dict(data), pose)


def test_plain_data_have_every_value(whips: ResultTable) -> None:
    """A row for both solutions and for each evaluation of the first pose."""
    rows = {row["case"]: row["min_sinr"] for row in whips.to_dict()["rows"]}
    assert list(rows) == ["promised", "received", "with_ground", "with_null", "possible"]
    assert rows["received"] == value_of(whips, "received")


def test_the_papers_antennas_have_nothing_to_be_compared_with() -> None:
    """A scenario that states no other antenna is refused, with what to state."""
    with pytest.raises(UsageError, match="null_depth_db"):
        compare_antennas(load(EXAMPLES / "paper.toml"))
