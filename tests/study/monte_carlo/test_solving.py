"""Every kind of case becomes a row, and every failure one with a reason."""

from collections.abc import Callable
from typing import Any

import pytest

from nullpose import Scenario, evaluate, solve_robust
from nullpose.solve import solve, solve_array
from nullpose.study.monte_carlo import StudySpec
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.rows import Row
from nullpose.study.monte_carlo.solving import GIVEN_POSE, solved_row

Spec = Callable[..., StudySpec]


def _row(spec: StudySpec, place: int = 0) -> tuple[Row, Scenario]:
    scene = Draws(spec).at(0, 0)
    return solved_row(spec, scene, 0, 0, spec.cases[place]), scene


def test_a_robust_case_is_worth_what_it_guarantees(spec: Spec) -> None:
    """Value and bound are those of the robust pose."""
    study = spec(jammers__uncertainty_m=1.0, cases=[{"robust": True, "gap": 0.1}])
    row, scene = _row(study)
    found = solve_robust(scene, gap=0.1)
    assert (row["value"], row["bound"]) == (found.robust.guaranteed, found.upper_bound)
    assert row["binding_node"] == found.robust.binding_node


def test_an_array_takes_the_place_of_the_dipole(spec: Spec) -> None:
    """Elements, layout and combining of the case count."""
    array = {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5, "combining": "digital"}
    row, scene = _row(spec(cases=[{"array": array}]))
    found = solve_array(scene, "digital", elements=2, layout="linear", spacing_wavelengths=0.5, gap=1e-2)
    assert row["value"] == found.objective.value
    assert (row["roll_rad"], row["pitch_rad"]) == (0.0, 0.0)


def test_a_given_pose_is_evaluated(spec: Spec) -> None:
    """Nothing is proved of it, and the reason says so."""
    pose = {"position_m": [1.0, 25.0, 9.0], "roll_deg": 80.0, "yaw_deg": 20.0}
    study = spec(cases=[{"pose": pose, "airframe": {"tilt_max_deg": 90.0, "mount_deg": 10.0}}])
    row, scene = _row(study)
    links = evaluate(study.cases[0].on(scene), study.cases[0].pose.on(study.cases[0].on(scene)))  # type: ignore[union-attr]
    assert row["value"] == min(link.sinr for link in links)
    assert (row["status"], row["reason"], row["bound"], row["gap"]) == ("best-found", GIVEN_POSE, None, None)


@pytest.mark.parametrize(
    ("case", "options"),
    [
        ({"scheme": "vertical"}, {"scheme": "vertical"}),
        ({"certify": False}, {"certify": False}),
        ({"gap": 0.5}, {"gap": 0.5}),
        ({"scheme": "zero-interference"}, {"scheme": "zero-interference"}),
    ],
)
def test_a_case_is_a_solve(spec: Spec, case: dict[str, Any], options: dict[str, Any]) -> None:
    """Scheme, gap and proof are passed on."""
    row, scene = _row(spec(cases=[case]))
    found = solve(scene, **{"gap": 1e-2, **options})
    assert (row["status"], row["value"]) == (found.status.value, found.objective.value)
    assert (row["bound"], row["boxes"]) == (found.objective.upper_bound, found.stats.boxes)


def test_limits_of_the_study_end_a_proof(spec: Spec) -> None:
    """A proof that is cut short says why."""
    row, _ = _row(spec(node_limit=1, gap=1e-8, cases=[{"scheme": "vertical"}]))
    assert row["status"] == "gap-not-reached"
    assert "boxes" in row["reason"] or "limit" in row["reason"]


def test_a_secrecy_rate_is_no_ratio(spec: Spec) -> None:
    """Where the drone transmits the value is a rate in bits/s/Hz."""
    study = spec(
        scene__objective="secrecy-rate",
        scene__transmitter={"power_w": 1.0},
        nodes__power_w=None,
        eavesdroppers={"layout": "disc", "count": 1, "centre_m": [80, 80], "radius_m": 5.0},
    )
    row, scene = _row(study)
    assert row["value"] == pytest.approx(solve(scene, gap=1e-2).objective.value)


def test_what_goes_wrong_is_a_row(spec: Spec, monkeypatch: pytest.MonkeyPatch) -> None:
    """An error of the solver, of whatever kind, is the reason of a failure, on one line."""

    def broken(*_: Any, **__: Any) -> None:
        raise ArithmeticError("first line\n  second line")

    monkeypatch.setattr("nullpose.study.grid.solve", broken)
    row, _ = _row(spec())
    assert (row["status"], row["reason"]) == ("failed", "ArithmeticError: first line; second line")
    assert not {"value", "bound", "x_m"} & set(row)
