"""What is solved together is what is solved alone, and one at fault takes no other with it."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from nullpose.physics import Pose, antenna_gain
from nullpose.scenario import Scenario
from nullpose.solver import solve_many
from nullpose.study.monte_carlo import StudySpec, solving
from nullpose.study.monte_carlo.chunk import rows_of
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.solving import solved_row

Spec = Callable[..., StudySpec]

CASES = [
    {"name": "free"},
    {"name": "tilt", "airframe": "tilt-10-horizontal"},
    {"scheme": "vertical"},
    {"gap": 0.1},
]
MOUNTS = {"free": 0.0, "tilt": math.pi / 2.0}
SWEEP = {"jammers.M.power_w": [0.1, 10.0]}


def _without_time(rows: Any) -> list[dict[str, Any]]:
    return [{name: value for name, value in row.items() if name != "seconds"} for row in rows]


def test_a_row_is_the_same_whatever_is_solved_beside_it(spec: Spec) -> None:
    """All scenes in one go, or one by one: the same rows, to the last digit."""
    study = spec(cases=CASES, sweep=SWEEP)
    alone = [row for index in range(12) for row in rows_of(study, index, index)]
    assert _without_time(rows_of(study, 0, 11)) == _without_time(alone)


def test_together_or_by_solve(spec: Spec) -> None:
    """The values are those of a solve within the gap, and the bounds hold for both."""
    study = spec(cases=CASES[:2], sweep=SWEEP)
    draws = Draws(study)
    for row in rows_of(study, 0, 5):
        at, case = (row["scene"], row["point"]), study.cases[study.case_names.index(row["case"])]
        single = solved_row(study, draws.at(*at), *at, case)
        assert row["value"] == pytest.approx(single["value"], rel=1e-2)
        assert single["value"] <= row["bound"] * (1.0 + 1e-9)
        assert row["status"] == single["status"] == "certified"
        pose = Pose(
            [row["x_m"], row["y_m"], row["z_m"]],
            row["roll_rad"],
            row["pitch_rad"],
            row["yaw_rad"],
            MOUNTS[row["case"]],
        )
        scene = draws.at(*at)
        gains = antenna_gain(pose.position_m, pose.antenna_axis, scene.jammer_positions_m)
        assert row["null_gain"] == pytest.approx(gains.min(), abs=1e-12)


def test_one_at_fault(spec: Spec, monkeypatch: pytest.MonkeyPatch) -> None:
    """The rows of the others stay what they are; that one is solved by itself."""
    study = spec(cases=CASES[:2])
    whole = _without_time(rows_of(study, 0, 7))
    bad = Draws(study).base(3)

    def broken(scenarios: list[Scenario], **options: Any) -> Any:
        if any(scenario == bad for scenario in scenarios):
            raise RuntimeError("broken here")
        return solve_many(scenarios, **options)

    monkeypatch.setattr(solving, "solve_many", broken)
    monkeypatch.setattr(solving, "solve", lambda *_, **__: 1 / 0)
    rows = _without_time(rows_of(study, 0, 7))
    for before, after in zip(whole, rows, strict=True):
        if after["scene"] == 3:
            assert (after["status"], after["reason"]) == ("failed", "ZeroDivisionError: division by zero")
        else:
            assert after == before
