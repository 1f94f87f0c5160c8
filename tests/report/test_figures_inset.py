"""The antenna beside a plan: its axis and the directions are those of the pose, in the plan's colours."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D

from nullpose import Pose, Scenario, load
from nullpose.antenna import SHORT_DIPOLE
from nullpose.report.figures.inset import draw_inset
from nullpose.report.figures.pattern import pattern_surface
from nullpose.report.figures.plan import draw_plan
from nullpose.report.figures.stage import Stage

EXAMPLE = Path(__file__).parents[2] / "examples" / "eavesdropper.toml"
POSES = (
    Pose.from_axis([3.0, 22.0, 12.0], [0.8, -0.4, -0.3]),
    Pose.from_axis([3.0, 22.0, 12.0], [0.0, 0.8, -0.6]),  # in line with a camera in the south
    Pose.from_axis([-9.0, 40.0, 30.0], [0.0, 0.0, 1.0]),
)


def _stage(paper: Scenario, *poses: Pose) -> Stage:
    scene = load(EXAMPLE).to_dict() | {"jammers": paper.to_dict()["jammers"]}
    return Stage(scenario=Scenario.from_dict(scene), poses=poses)


def _drawn(stage: Stage, pose: Pose) -> Axes3D:
    axes = Figure().add_subplot(projection="3d")
    draw_inset(axes, stage, pose)
    return axes


def _lines(axes: Axes3D, label: str) -> list[np.ndarray]:
    return [np.array(line.get_data_3d()).T for line in axes.lines if line.get_label() == label]


@pytest.mark.parametrize("pose", POSES)
def test_the_axis_goes_through_the_drone_along_the_antenna(paper: Scenario, pose: Pose) -> None:
    """Both ways as far, and beyond the pattern, so that both ends are seen."""
    (ends,) = _lines(_drawn(_stage(paper, pose), pose), "antenna axis (null)")
    assert ends.mean(axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.linalg.norm(np.cross(ends[1] - ends[0], pose.antenna_axis)) == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.norm(ends, axis=1).min() > 1.0


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("kind", ["node", "jammer", "eavesdropper"])
def test_lines_run_towards_the_points(paper: Scenario, pose: Pose, kind: str) -> None:
    """From the drone in the direction of each point, with a mark at the end, in the plan's colour."""
    stage = _stage(paper, pose)
    axes, plan = _drawn(stage, pose), Figure().add_subplot()
    points = [np.array(point.position_m) for of_kind, point in stage.points if of_kind == kind]
    lines = _lines(axes, kind)
    assert len(lines) == len(points) > 0
    marks = np.hstack([dots._offsets3d for dots in axes.collections if hasattr(dots, "_offsets3d")]).T
    for (start, end), point_m in zip(lines, points, strict=True):
        away = point_m - pose.position_m
        assert start == pytest.approx(np.zeros(3), abs=1e-12)
        assert end / np.linalg.norm(end) == pytest.approx(away / np.linalg.norm(away))
        assert np.linalg.norm(marks - end, axis=1).min() == pytest.approx(0.0, abs=1e-9)
    draw_plan(plan, stage, pose)
    colours = {
        to_hex(line.get_color()) for each in (axes, plan) for line in each.lines if line.get_label() == kind
    }
    assert len(colours) == 1


@pytest.mark.parametrize("pose", POSES)
def test_the_null_is_seen(paper: Scenario, pose: Pose) -> None:
    """The pattern is open towards the camera, which looks at the axis from the side."""
    axes = _drawn(_stage(paper, pose), pose)
    camera = np.array(
        [
            np.cos(np.radians(axes.elev)) * np.cos(np.radians(axes.azim)),
            np.cos(np.radians(axes.elev)) * np.sin(np.radians(axes.azim)),
            np.sin(np.radians(axes.elev)),
        ]
    )
    assert np.linalg.norm(np.cross(pose.antenna_axis, camera)) > 0.4
    open_rad = np.radians(110.0)
    surface = pattern_surface(SHORT_DIPOLE, pose, camera, open_rad).reshape(3, -1).T
    across = surface - np.outer(surface @ pose.antenna_axis, pose.antenna_axis)
    towards = camera - (camera @ pose.antenna_axis) * pose.antenna_axis
    far = np.linalg.norm(across, axis=1) > 1e-6
    cosines = across[far] @ towards / np.linalg.norm(across[far], axis=1) / np.linalg.norm(towards)
    assert np.arccos(cosines.max()) == pytest.approx(0.5 * open_rad, abs=1e-6)


def test_all_poses_are_seen_from_one_side(paper: Scenario) -> None:
    """So that antennas side by side can be compared."""
    stage = _stage(paper, *POSES)
    views = {(axes.elev, axes.azim) for axes in (_drawn(stage, pose) for pose in POSES)}
    assert len(views) == 1
