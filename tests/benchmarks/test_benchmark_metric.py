"""Metrics: limits, tolerances, the gate and the baseline file."""

import math
from pathlib import Path

import pytest
from benchmarks.baseline import BASELINE, judge, load_baseline, write_baseline
from benchmarks.cli import WORKLOAD_NAMES
from benchmarks.metric import EXACT, Direction, Metric, Tolerance


def metric(
    value: float,
    *,
    key: str = "fields.hits",
    direction: Direction = Direction.LOWER,
    tolerance: Tolerance = EXACT,
    limit: float | None = None,
) -> Metric:
    """Return a metric of that value."""
    return Metric(
        key=key,
        value=value,
        unit="1",
        direction=direction,
        tolerance=tolerance,
        limit=limit,
        about="of a test",
    )


@pytest.mark.parametrize(
    ("direction", "value", "regressed"),
    [
        (Direction.LOWER, 12.2, False),
        (Direction.LOWER, 12.3, True),
        (Direction.LOWER, 1.0, False),
        (Direction.HIGHER, 7.8, False),
        (Direction.HIGHER, 7.7, True),
        (Direction.HIGHER, 99.0, False),
        (Direction.LOWER, math.nan, True),
        (Direction.HIGHER, math.nan, True),
    ],
)
def test_regression_is_worse_by_more_than_the_tolerance(
    direction: Direction, value: float, regressed: bool
) -> None:
    """A value regresses when it is worse than the baseline, 10, by more than 20 % and 0.25 together."""
    tolerance = Tolerance(relative=0.2, absolute=0.25)
    assert metric(value, direction=direction, tolerance=tolerance).regressed_from(10.0) is regressed


def test_limit_holds_whatever_the_baseline_says() -> None:
    """A promise missed is a fault even at the baseline's own value."""
    missed = metric(0.9, direction=Direction.HIGHER, limit=0.995)
    assert not missed.meets_limit
    assert judge([missed], {missed.key: 0.9}, ["fields"]) == ["fields.hits: 0.9 1 misses the promised 0.995"]


def test_gate_asks_for_what_ran() -> None:
    """A metric that is gone is a fault if its workload ran, and none if it did not."""
    baseline = {"fields.hits": 1.0, "fields.gone": 2.0, "startup.help_s": 0.3}
    assert judge([metric(1.0)], baseline, ["fields"]) == ["fields.gone: in the baseline, but not measured"]


def test_gate_refuses_what_it_cannot_compare() -> None:
    """A metric that the baseline does not have is a fault, and says how to add it."""
    assert "--update-baseline" in judge([metric(1.0)], {}, ["fields"])[0]


def test_baseline_comes_back_and_keeps_what_did_not_run(tmp_path: Path) -> None:
    """Writing a workload's metrics replaces those of that workload and leaves the others."""
    path = tmp_path / "baseline.json"
    write_baseline([metric(1.0), metric(2.0, key="startup.help_s")], {}, ["fields", "startup"], path)
    write_baseline([metric(3.0, key="fields.time")], {}, ["fields"], path)
    assert load_baseline(path) == {"fields.time": 3.0, "startup.help_s": 2.0}


def test_committed_baseline_can_be_read() -> None:
    """The committed baseline has finite values for every workload."""
    values = load_baseline(BASELINE)
    assert {key.split(".")[0] for key in values} == set(WORKLOAD_NAMES)
    assert all(math.isfinite(value) for value in values.values())
