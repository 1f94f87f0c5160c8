"""Error cases in words."""

import math
import re
from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullpose.physics.error_case import ErrorCase
from nullpose.solver.robust.solution import in_words

UP = np.array([0.0, 0.0, 1.0])


def a_case(**parts: object) -> ErrorCase:
    """Returns a case of a scene with one jammer, without errors but for what is given."""
    plain = {
        "position_offset_m": np.zeros(3),
        "rotation_world": np.eye(3),
        "jammer_offsets_m": np.zeros((1, 3)),
        "eavesdropper_offsets_m": np.zeros((0, 3)),
    }
    return ErrorCase(**(plain | parts))


@pytest.mark.parametrize(
    ("offset", "azimuth_deg", "elevation_deg"),
    [
        ([3.0, 0.0, 0.0], 0, 0),
        ([2.0, 2.0, 0.0], 45, 0),
        ([0.0, -1.0, 0.1], 270, 6),
        ([-1.0, 0.0, 1.0], 180, 45),
        ([0.0, 1.0, -1.0], 90, -45),
        ([1.0, -0.001, 0.0], 0, 0),
        ([0.0, 0.0, -1.0], 0, -90),
    ],
)
def test_directions(offset: list[float], azimuth_deg: int, elevation_deg: int, paper: Callable) -> None:
    """Offsets are told by their length, their azimuth from east and their elevation."""
    length = float(np.linalg.norm(offset))
    told = in_words(paper(1.0), UP, a_case(jammer_offsets_m=np.array([offset])))
    name, *numbers = re.split(r" m off, towards azimuth | deg, elevation | deg$| (?=[\d.]+ m off)", told)
    assert name == "M1"
    assert [float(number) for number in numbers if number] == [
        pytest.approx(length, rel=1e-2),
        azimuth_deg,
        elevation_deg,
    ]


def test_every_part_is_told(paper: Callable) -> None:
    """Axis, drone and jammer are told in that order; the axis by its end that points up."""
    case = a_case(
        position_offset_m=np.array([0.0, 0.5, 0.0]),
        rotation_world=Rotation.from_rotvec([0.0, math.radians(2.0), 0.0]).as_matrix(),
        jammer_offsets_m=np.array([[0.0, 0.0, 3.0]]),
    )
    for axis in (UP, -UP):
        axis_told, drone_told, jammer_told = in_words(paper(1.0), axis, case).split("; ")
        assert axis_told.startswith("axis 2 deg off, towards azimuth 0 deg")
        assert drone_told.startswith("drone 0.5 m off, towards azimuth 90 deg")
        assert jammer_told.startswith("M1 3 m off")
        assert jammer_told.endswith("elevation 90 deg")
