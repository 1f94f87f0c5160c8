"""Files of poses: metres and degrees in, poses out, every fault with its line."""

import math
from pathlib import Path

import pytest

from nullpose.errors import ScenarioError
from nullpose.physics import Pose
from nullpose.scenario import Origin, Scenario
from nullpose.study import poses_from_csv, sweep

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
