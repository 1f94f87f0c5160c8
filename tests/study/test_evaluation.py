"""A given pose is told with what it gives, and how far it is below what is proved."""

import math
from pathlib import Path

import numpy as np
import pytest

from nullpose.errors import ScenarioError, UsageError
from nullpose.physics import Pose, Poses, min_sinr
from nullpose.scenario import Airframe, Origin, Scenario, apply_overrides
from nullpose.solver import solve
from nullpose.study import evaluate_against, poses_from_csv, sweep


def test_distances_are_to_the_bound(paper: Scenario) -> None:
    """Each pose's value is that of the physics, and its distance is what is left to the proved bound."""
    best = solve(paper)
    rng = np.random.default_rng(5)
    poses = Poses(rng.uniform([-20, -20, 8], [60, 60, 30], (30, 3)), *rng.uniform(-3, 3, (2, 30)))
    bound_db = 10.0 * math.log10(best.objective.upper_bound)
    for pose, one in zip(poses, evaluate_against(best, poses).results, strict=True):
        assert one.objective.value == min_sinr(paper, pose)
        assert one.objective.upper_bound == best.objective.upper_bound
        assert one.details.below_bound == pytest.approx(bound_db - one.objective.value_db, abs=1e-9)
        assert one.details.below_bound > 0.0
        assert one.details.not_allowed == ()
    (same,) = evaluate_against(best, [best.pose]).results
    assert same.objective.value == pytest.approx(best.objective.value, rel=1e-12)
    assert 0.0 <= same.details.below_bound < 1e-5
    assert set(best.to_dict()) <= set(same.to_dict())


def test_a_pose_that_is_not_allowed_has_no_bound(paper: Scenario) -> None:
    """The bound is on poses that the vehicle may take; each reason against the others is told."""
    level = Airframe(tilt_max_deg=10.0, mount_deg=90.0)
    best = solve(paper.model_copy(update={"airframe": level}), certify=False)
    poses = [Pose([3.0, 24.0, 4.0], 0.0, 0.5, 0.0, level.mount_rad), Pose([0.0, 0.5, 0.0], 0.0, 0.1)]
    low, close = evaluate_against(best, poses).results
    assert low.objective.upper_bound is None
    assert low.details.below_bound is None
    assert low.details.not_allowed[0] == "the position is 4 m outside altitude_m"
    assert "more than the airframe's 10 deg" in low.details.not_allowed[1]
    assert "closer than keep_out_m" in close.details.not_allowed[1]


def test_a_pose_in_a_zone_names_it(paper: Scenario) -> None:
    """Each no-fly zone that a position is in is named, and the fence, with how far it is."""
    changes = [
        'airspace.no_fly=[{name="mast", centre_m=[10, 10], radius_m=5}, '
        '{name="wood", x_m=[8, 30], y_m=[0, 30]}]',
        "airspace.geofence_m=[[-40, -20], [12, -20], [12, 70], [-40, 70]]",
    ]
    best = solve(apply_overrides(paper, changes), certify=False)
    both, fence = evaluate_against(
        best, [Pose([11.0, 10.0, 9.0], 0.0, 0.1), Pose([15.0, 40.0, 9.0], 0.0, 0.1)]
    ).results
    assert both.details.not_allowed == (
        "the position is 4 m inside the no-fly zone mast",
        "the position is 3 m inside the no-fly zone wood",
    )
    assert fence.details.not_allowed == ("the position is 3 m outside the geofence",)


def test_a_ground_point_is_no_place(paper: Scenario) -> None:
    """Nor is there a value where a node is; and arrays have no axis to be given."""
    best = solve(paper, certify=False)
    with pytest.raises(UsageError, match="the position of S2"):
        evaluate_against(best, [Pose([0.0, 50.0, 0.0], 0.0, 0.0)])


def test_rates_are_held_against_their_bound(paper: Scenario) -> None:
    """A secrecy rate's distance is in bits/s/Hz."""
    changes = ["objective=secrecy-rate", "transmitter.power_w=2", "eavesdroppers=[{position_m=[-20,15,4]}]"]
    best = solve(apply_overrides(paper, changes))
    (one,) = evaluate_against(best, [Pose([3.0, 24.0, 9.0], 0.2, -1.1)]).results
    assert one.details.below_bound == pytest.approx(best.objective.upper_bound - one.objective.value)


HEADER = "x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n"


def _file(folder: Path, text: str) -> Path:
    path = folder / "poses.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_metres_and_degrees(tmp_path: Path) -> None:
    """Without the yaw's column it is zero; columns of other names are passed over."""
    poses = poses_from_csv(_file(tmp_path, HEADER + "1,2,9,10,-20,30\n4,5,8,0,0,0\n"), 0.3)
    assert poses[0] == Pose([1.0, 2.0, 9.0], *map(math.radians, (10.0, -20.0, 30.0)), 0.3)
    assert len(poses) == 2
    without = _file(tmp_path, "note,x_m,y_m,z_m,roll_deg,pitch_deg\nfirst,1,2,9,10,-20\n")
    assert poses_from_csv(without)[0] == Pose([1.0, 2.0, 9.0], *map(math.radians, (10.0, -20.0)))


def test_the_table_of_a_sweep_is_a_file_of_poses(paper: Scenario, tmp_path: Path) -> None:
    """What `sweep` writes can be evaluated."""
    table = sweep(paper, "jammers.M.power_w", [0.5, 2.0], schemes=["optimum"], certify=False)
    poses = poses_from_csv(table.write_csv(tmp_path / "sweep.csv"))
    for row, pose in zip(table.rows, poses, strict=True):
        assert pose.position_m.tolist() == row.pose.position_m.tolist()
        assert pose.pitch_rad == pytest.approx(row.pose.pitch_rad, abs=1e-12)


@pytest.mark.parametrize(
    ("altitude", "height_m"), [("alt_m", 250.0), ("alt_msl_m", 205.0), ("alt_agl_m", 20.0)]
)
def test_latitudes_and_longitudes(altitude: str, height_m: float, tmp_path: Path) -> None:
    """Places on the Earth are put into the frame of the origin, whatever their altitude is over."""
    origin = Origin(lat_deg=50.0, lon_deg=14.5, alt_m=230.0, alt_msl_m=185.0)
    header = f"lat_deg,lon_deg,{altitude},roll_deg,pitch_deg\n"
    (pose,) = poses_from_csv(_file(tmp_path, f"{header}50.001,14.5,{height_m},0,80\n"), origin=origin)
    assert pose.position_m == pytest.approx([0.0, 111.23, 20.0], abs=0.01)
    assert origin.place(pose.position_m)["lat_deg"] == pytest.approx(50.001, abs=1e-9)
    far = _file(tmp_path, f"{header}14.5,50.001,{height_m},0,80\n")
    with pytest.raises(ScenarioError, match=r"line 2: lat_deg, lon_deg: given 14\.5.*exchanged"):
        poses_from_csv(far, origin=origin)
    with pytest.raises(ScenarioError, match=r"line 1: lat_deg and lon_deg need the \[origin\]"):
        poses_from_csv(far)


def test_an_altitude_that_the_origin_does_not_state(tmp_path: Path) -> None:
    """Over the sea beside an origin over the ellipsoid: refused, not guessed."""
    file = _file(tmp_path, "lat_deg,lon_deg,alt_msl_m,roll_deg,pitch_deg\n50.001,14.5,205,0,80\n")
    with pytest.raises(ScenarioError, match="line 2: alt_msl_m: given, but"):
        poses_from_csv(file, origin=Origin(lat_deg=50.0, lon_deg=14.5, alt_m=230.0))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("x_m,y_m\n1,2\n", "line 1: there is no column z_m"),
        (HEADER + "1,2,9,ten,0,0\n", 'line 2, column roll_deg: got the text "ten", must be a number'),
        (HEADER + "1,2,9,0,0\n", "line 2, column yaw_deg: got nothing"),
        (HEADER + "1,2,inf,0,0,0\n", "line 2, column z_m"),
        (HEADER, "no line below the header"),
        ("", "line 1: there is no column x_m"),
    ],
)
def test_faults_have_their_place(text: str, told: str, tmp_path: Path) -> None:
    """With the file's name above them."""
    with pytest.raises(ScenarioError, match=r"poses\.csv: ") as caught:
        poses_from_csv(_file(tmp_path, text))
    assert told in str(caught.value)
