"""The drone as it is drawn: body, rod and null have the pose's attitude."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, seed, strategies as st
from scipy.spatial.transform import Rotation

from nullpose import Pose, load, solve
from nullpose.physics import rotation_world_from_body
from nullpose.studio.answer import answer_of
from nullpose.studio.case import OPTIMUM
from nullpose.studio.drawing import Shape, Shapes
from nullpose.studio.drone import drone_shapes
from nullpose.studio.ground import ground_shapes
from nullpose.studio.look import LIGHT
from nullpose.studio.state import State

PAPER = load(Path(__file__).parents[2] / "examples" / "paper.toml")
RESULT = solve(PAPER, certify=False)
SIZE_M = 50.0
ANGLE = st.floats(-3.0, 3.0)


def _drawn(pose: Pose) -> Shapes:
    state = State(scenario=PAPER, has_pattern=False)
    state = state.with_event(answer_of(1, OPTIMUM, replace(RESULT, pose=pose)))
    return drone_shapes(state, 0, SIZE_M, [60.0, -40.0, 30.0], LIGHT)


def _rotation(shape: Shape) -> np.ndarray:
    return Rotation.from_quat(np.roll(shape.values["wxyz"], -1)).as_matrix()


@seed(0)
@given(roll=ANGLE, pitch=ANGLE, yaw=ANGLE, mount=st.floats(0.0, math.pi / 2))
def test_body_rod_and_null_have_the_attitude(roll: float, pitch: float, yaw: float, mount: float) -> None:
    """The body's rotation is that of the convention; with the mount's it puts rod and null onto the axis.

    The null's line ends on the ground, or after a while; its cone widens by the same angle all around.
    """
    pose = Pose(RESULT.pose.position_m, roll, pitch, yaw, mount)
    shapes, axis = _drawn(pose), pose.antenna_axis
    body, rod = (_rotation(shapes[f"/drone-a/{name}"]) for name in ("body", "body/antenna"))
    assert body == pytest.approx(rotation_world_from_body(roll, pitch, yaw), abs=1e-6)
    assert body @ rod @ [0.0, 0.0, 1.0] == pytest.approx(axis, abs=1e-6)
    assert shapes["/drone-a/body"].values["position"] == pytest.approx(pose.position_m)
    above, below = shapes["/drone-a/null"].values["points"][0] - pose.position_m
    for way in (above, below):
        assert np.cross(way, axis) == pytest.approx(np.zeros(3), abs=1e-4)
    assert np.linalg.norm(above) == pytest.approx(0.16 * SIZE_M, rel=1e-4)
    reach_m = np.linalg.norm(below)
    if reach_m < 1.5 * SIZE_M * (1.0 - 1e-6):
        assert pose.position_m[2] + below[2] == pytest.approx(0.0, abs=1e-4)
    else:
        assert reach_m == pytest.approx(1.5 * SIZE_M, rel=1e-4)
    ways = shapes["/drone-a/beam"].values["vertices"] - pose.position_m
    ways = ways[np.linalg.norm(ways, axis=1) > 1e-3]
    cosines = ways @ below / np.linalg.norm(ways, axis=1) / reach_m
    assert cosines == pytest.approx(np.full(len(ways), math.sqrt(0.99)), abs=1e-4)


def test_a_relay_has_a_link_to_its_destination() -> None:
    """A line runs from the drone to every node and to the destination, which has a mark with its name."""
    relay = load(Path(__file__).parents[2] / "examples" / "relay.toml")
    state = State(scenario=relay).with_event(answer_of(1, OPTIMUM, solve(relay, certify=False)))
    shapes = drone_shapes(state, 0, SIZE_M, [60.0, -40.0, 30.0], LIGHT)
    ends = [
        shape.values["points"] for name, shape in shapes.items() if "links-" in name and "out" not in name
    ]
    assert sum(map(len, ends)) == len(relay.nodes) + 1
    marks = ground_shapes(state, SIZE_M, LIGHT)
    assert marks["/points/destinations-0/label"].values["text"] == "command post"
