"""A sweep as asked for: checked in full before any work."""

import pytest

from nullpose import Scenario, ScenarioError, UsageError
from nullpose.study import SweepPlan, plan_sweep

POWER = "jammers.M.power_w"


def plan(scenario: Scenario, settings: list[str] | None = None, **options: object) -> SweepPlan:
    """Returns the plan of a short sweep."""
    return plan_sweep(scenario, settings or [POWER], **({"start": 1.0, "stop": 2.0, "points": 2} | options))


def test_fixed_settings_apply_to_every_value(paper: Scenario) -> None:
    """A path with a value is an override, the one without is varied."""
    made = plan(paper, ["receiver.noise_w=2e-3", POWER])
    assert (made.path, made.values) == (POWER, (1.0, 2.0))
    assert made.scenario.receiver.noise_power_w == 2e-3


def test_a_plan_runs(paper: Scenario) -> None:
    """Running the plan gives the table of its schemes and values."""
    table = plan(paper, schemes=["vertical"]).run()
    assert [(row.value, row.scheme) for row in table.rows] == [(1.0, "vertical"), (2.0, "vertical")]


def test_a_plan_has_limits(paper: Scenario) -> None:
    """The gap goes by the number of nodes unless given; without certifying there are no limits at all."""
    assert {row.objective.relative_gap <= 1e-6 for row in plan(paper).run().rows} == {True}
    given = plan(paper, gap=0.5, time_limit_s=7.0, node_limit=9000, schemes=["vertical"])
    assert given.options == {"gap": 0.5, "time_limit_s": 7.0, "node_limit": 9000}
    assert [row.objective.relative_gap <= 0.5 for row in given.run().rows] == [True, True]
    fast = plan(paper, certify=False, schemes=["vertical"])
    assert {row.status for row in fast.run().rows} == {"best-found"}


@pytest.mark.parametrize("settings", [["receiver.noise_w=1"], [POWER, "receiver.noise_w"]])
def test_exactly_one_path_is_varied(paper: Scenario, settings: list[str]) -> None:
    """None or two paths without a value are refused."""
    with pytest.raises(UsageError, match="exactly one path"):
        plan(paper, settings)


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"settings": ["jammers.Q.power_w"]}, ScenarioError),
        ({"settings": [POWER, "receiver.noise_w=-1"]}, ScenarioError),
        ({"points": 1}, UsageError),
        ({"start": -1.0}, ScenarioError),
        ({"gap": 0.0}, UsageError),
        ({"time_limit_s": -1.0}, UsageError),
        ({"node_limit": 0}, UsageError),
    ],
)
def test_a_faulty_plan_is_refused(
    paper: Scenario, options: dict[str, object], error: type[Exception]
) -> None:
    """Faults show before the first solve."""
    with pytest.raises(error):
        plan(paper, **options)
