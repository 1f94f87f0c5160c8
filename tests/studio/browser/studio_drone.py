"""The drone as it is drawn: body and rod have the pose's attitude."""

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, seed, strategies as st
from viser.transforms import SO3

from nullpose import Pose, load, solve
from nullpose.physics import rotation_world_from_body
from nullpose.solver import Result
from nullpose.studio.answer import answer_of
from nullpose.studio.case import OPTIMUM
from nullpose.studio.drone import Drone
from nullpose.studio.opening import LOOPBACK, open_server

PAPER = load(Path(__file__).parents[3] / "examples" / "paper.toml")
ANGLE = st.floats(-3.0, 3.0)


@pytest.fixture(scope="module")
def drone() -> Iterator[Drone]:
    """A drone in a scene that no browser shows."""
    server, _ = open_server(LOOPBACK, 0)
    yield Drone(server.scene, 0)
    server.stop()


@pytest.fixture(scope="module")
def result() -> Result:
    """Any result, whose pose is replaced."""
    return solve(PAPER, certify=False)


@seed(0)
@given(roll=ANGLE, pitch=ANGLE, yaw=ANGLE, mount=st.floats(0.0, math.pi / 2))
def test_body_and_rod_have_the_attitude(
    drone: Drone, result: Result, roll: float, pitch: float, yaw: float, mount: float
) -> None:
    """The body's rotation is that of the convention; with the mount's it puts the rod onto the axis."""
    pose = Pose(result.pose.position_m, roll, pitch, yaw, mount)
    drone.render(
        answer_of(1, OPTIMUM, replace(result, pose=pose)),
        "",
        50.0,
        (0.0, 1.0),
        [60.0, -40.0, 30.0],
        has_pattern=True,
    )
    body, rod = (SO3(drone._parts[name].wxyz).as_matrix() for name in ("body", "antenna"))
    assert body == pytest.approx(rotation_world_from_body(roll, pitch, yaw), abs=1e-6)
    assert body @ rod @ [0.0, 0.0, 1.0] == pytest.approx(pose.antenna_axis, abs=1e-6)
    assert drone._parts["body"].position == pytest.approx(pose.position_m)
