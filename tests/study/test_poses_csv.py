"""Files of poses: metres and degrees in, poses out, every fault with its line."""

import math
from pathlib import Path

import pytest

from nullpose.errors import ScenarioError
from nullpose.physics import Pose
from nullpose.scenario import Scenario
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


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    """Is told with its name."""
    with pytest.raises(ScenarioError, match=r"none\.csv: 1 fault\n +there is no such file"):
        poses_from_csv(tmp_path / "none.csv")
