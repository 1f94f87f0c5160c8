"""Every kind of case becomes a row, and every failure one with a reason."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from nullpose import Array, Pose, Scenario, evaluate
from nullpose.solver import solve
from nullpose.study.evaluation import pose_faults
from nullpose.study.least_tilt import least_tilt
from nullpose.study.monte_carlo import StudySpec
from nullpose.study.monte_carlo.chunk import rows_of
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.rows import Row, schema_of
from nullpose.study.monte_carlo.solving import solved_row

Spec = Callable[..., StudySpec]


def _row(spec: StudySpec, place: int = 0) -> tuple[Row, Scenario]:
    scene = Draws(spec).at(0, 0)
    return solved_row(spec, scene, 0, 0, spec.cases[place]), scene


def test_a_robust_case_is_worth_what_it_guarantees(spec: Spec) -> None:
    """Value and bound are those of the robust pose."""
    study = spec(jammers__uncertainty_m=1.0, cases=[{"robust": True, "gap": 0.1}])
    row, scene = _row(study)
    found = solve(scene, robust=True, gap=0.1)
    assert (row["value"], row["bound"]) == (found.details.robust.guaranteed, found.objective.upper_bound)
    assert row["binding_node"] == found.details.robust.binding_node


def test_an_array_takes_the_place_of_the_dipole(spec: Spec) -> None:
    """Elements and layout of the case count, and digital combining may be stated."""
    array = {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5, "combining": "digital"}
    row, scene = _row(spec(cases=[{"array": array}]))
    array = Array(elements=2, layout="linear", spacing_wavelengths=0.5)
    found = solve(scene.model_copy(update={"array": array}), gap=1e-2)
    assert row["value"] == found.objective.value
    assert (row["roll_rad"], row["pitch_rad"]) == (0.0, 0.0)


def test_a_least_tilt_has_two_sides(spec: Spec) -> None:
    """Those of least_tilt, in columns that other studies do not have; the pose keeps to the tilt."""
    study = spec(cases=[{"airframe": {"tilt_max_deg": "least", "mount_deg": 90}, "reach": 0.95}])
    row, scene = _row(study)
    (mount,) = least_tilt(scene, share=0.95, mounts_deg=[90.0], threads=1).mounts
    assert (row["least_tilt_deg"], row["too_little_deg"]) == (mount.suffices_deg, mount.fails_deg)
    assert (row["status"], row["value"]) == ("certified", mount.value)
    assert 0.95 * row["bound"] <= row["value"]
    assert StudySpec.from_dict(study.to_dict()).digest == study.digest
    assert "least_tilt_deg" in schema_of(study).names
    assert "least_tilt_deg" not in schema_of(spec(cases=[{"robust": True}])).names


def test_the_least_tilt_is_found_at_each_point_of_a_grid(spec: Spec) -> None:
    """Of the first scene with each swept power, as by least_tilt."""
    case = {"airframe": {"tilt_max_deg": "least", "mount_deg": 0}, "reach": 0.9}
    study = spec(scenes=1, cases=[case], sweep={"jammers.*.power_w": [0.1, 10.0]})
    rows = rows_of(study, 0, 0)
    assert [row["status"] for row in rows] == ["certified"] * 2
    for point, row in enumerate(rows):
        scene = Draws(study).at(0, point)
        (mount,) = least_tilt(scene, share=0.9, mounts_deg=[0.0], threads=1).mounts
        assert (row["least_tilt_deg"], row["too_little_deg"]) == (mount.suffices_deg, mount.fails_deg)


def test_a_given_pose_is_evaluated(spec: Spec) -> None:
    """Nothing is proved of it, and the status says so."""
    pose = {"position_m": [1.0, 25.0, 9.0], "roll_deg": 80.0, "yaw_deg": 20.0}
    study = spec(cases=[{"pose": pose, "airframe": {"tilt_max_deg": 90.0, "mount_deg": 10.0}}])
    row, scene = _row(study)
    links = evaluate(study.cases[0].on(scene), study.cases[0].pose.on(study.cases[0].on(scene)))  # type: ignore[union-attr]
    assert row["value"] == min(link.sinr for link in links)
    assert (row["status"], row["reason"], row["bound"], row["gap"]) == ("given", "", None, None)


@pytest.mark.parametrize("away_m", [0.0, 0.1, 1.0, 10.0])
def test_the_gain_towards_the_nearest_null_is_a_column(spec: Spec, away_m: float) -> None:
    """Above a jammer an upright dipole has the squared sine of the angle; with a whip there, its square."""
    pose = {"position_m": [away_m, 25.0, 14.0]}
    scene = {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "jammers": [{"position_m": [90.0, 0.0, 4.0], "power_w": 1.0}],
    }
    above = {"position_m": [0.0, 25.0, 4.0], "power_w": 1.0, "gain_dbi": 2.15}
    sine_squared = away_m**2 / (away_m**2 + 10.0**2)
    for antenna, expected in (
        ("isotropic", sine_squared),
        ("circular", sine_squared),
        ("dipole", sine_squared**2),
    ):
        scene["jammers"][1:] = [above | {"antenna": antenna}]
        row, _ = _row(spec(scene=scene, jammers=None, cases=[{"pose": pose}]))
        assert row["null_gain"] == pytest.approx(expected)


def test_without_a_jammer_there_is_no_null(spec: Spec) -> None:
    """Nor with an array, whose weights make its nulls."""
    row, _ = _row(spec(jammers=None, cases=[{"pose": {"position_m": [1.0, 25.0, 9.0]}}]))
    assert row["null_gain"] is None
    array = {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5}
    row, _ = _row(spec(cases=[{"array": array, "certify": False}]))
    assert row["null_gain"] is None


def test_a_given_pose_that_is_not_allowed_says_so(spec: Spec) -> None:
    """A tilt that the vehicle does not reach is the reason of the row, as in an evaluation."""
    pose = {"position_m": [1.0, 25.0, 9.0], "roll_deg": 80.0}
    row, _ = _row(spec(cases=[{"pose": pose, "airframe": "tilt-10-horizontal"}]))
    assert row["status"] == "given"
    assert row["reason"] == "not allowed: tilted by 80.000 deg, more than the airframe's 10 deg"


BOX = {"x_m": [-90.0, 90.0], "y_m": [-90.0, 90.0]}


@pytest.mark.parametrize(
    ("airspace", "altitude_m"),
    [
        ({}, 8.0),
        ({"no_fly": [BOX | {"altitude_m": [0.0, 12.0]}]}, 12.0),
        ({"no_fly": [BOX | {"altitude_m": [0.0, 12.0]}, BOX | {"altitude_m": [11.0, 15.0]}]}, 15.0),
        ({"no_fly": [BOX | {"altitude_m": [9.0, 15.0]}]}, 8.0),
        ({"no_fly": [BOX | {"altitude_m": [9.0, 15.0]}], "margin_m": 3.0}, 18.0),
        ({"keep_out_m": 26.0, "altitude_m": [5.0, 60.0]}, None),
    ],
)
def test_over_the_centroid(spec: Spec, airspace: dict[str, Any], altitude_m: float | None) -> None:
    """The drone hovers level over the nodes' centroid, at the lowest altitude that is allowed there."""
    study = spec(scene__airspace={"altitude_m": [8.0, 30.0], **airspace}, cases=[{"pose": "centroid"}])
    scene = Draws(study).at(0, 0)
    pose = study.cases[0].pose.on(scene)  # type: ignore[union-attr]
    assert not list(pose_faults(scene, pose))
    assert pose.position_m[:2] == pytest.approx(scene.node_positions_m[:, :2].mean(axis=0))
    assert (pose.roll_rad, pose.pitch_rad, pose.yaw_rad) == (0.0, 0.0, 0.0)
    for lower_m in np.arange(scene.airspace.altitude_m[0], pose.position_m[2] - 1e-6, 0.05):
        below = Pose([*pose.position_m[:2], lower_m], 0.0, 0.0)
        assert list(pose_faults(scene, below))
    assert altitude_m in (None, pose.position_m[2])
    row, _ = _row(study)
    assert (row["status"], row["value"]) == ("given", min(link.sinr for link in evaluate(scene, pose)))


def test_nowhere_over_the_centroid(spec: Spec) -> None:
    """Where every altitude over the centroid is forbidden, the row says so, at the lowest altitude."""
    airspace = {"altitude_m": [8.0, 30.0], "no_fly": [BOX]}
    row, _ = _row(spec(scene__airspace=airspace, cases=[{"pose": "centroid"}]))
    assert (row["status"], row["z_m"]) == ("given", 8.0)
    assert row["reason"].startswith("not allowed: the position is")
    assert "no-fly zone Z1" in row["reason"]


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

    monkeypatch.setattr("nullpose.study.monte_carlo.solving.solve", broken)
    row, _ = _row(spec())
    assert (row["status"], row["reason"]) == ("failed", "ArithmeticError: first line; second line")
    assert not {"value", "bound", "x_m"} & set(row)
