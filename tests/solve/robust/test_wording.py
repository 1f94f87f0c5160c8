"""Error cases in words."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullpose.physics.error_case import ErrorCase
from nullpose.solve.robust.wording import in_words

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
    ("offset", "words"),
    [
        ([3.0, 0.0, 0.0], "east"),
        ([2.0, 2.0, 0.1], "north-east"),
        ([0.0, -1.0, 0.1], "south"),
        ([-1.0, 0.0, 1.0], "west and up"),
        ([0.0, 1.0, -1.0], "north and down"),
        ([-1.0, -1.0, 0.0], "south-west"),
        ([0.1, 0.0, 1.0], "top"),
        ([0.0, 0.0, -1.0], "bottom"),
    ],
)
def test_directions(offset: list[float], words: str, paper: Callable) -> None:
    """Offsets are told by their length and by the nearest compass point, with up or down where it matters."""
    length = float(np.linalg.norm(offset))
    told = in_words(paper(1.0), UP, a_case(jammer_offsets_m=np.array([offset])))
    assert told == f"M1 {length:.3g} m off, to the {words}"


def test_every_part_is_told(paper: Callable) -> None:
    """Axis, drone and jammer are told in that order; the axis by its end that points up."""
    case = a_case(
        position_offset_m=np.array([0.0, 0.5, 0.0]),
        rotation_world=Rotation.from_rotvec([0.0, math.radians(2.0), 0.0]).as_matrix(),
        jammer_offsets_m=np.array([[0.0, 0.0, 3.0]]),
    )
    for axis in (UP, -UP):
        assert in_words(paper(1.0), axis, case) == (
            "axis 2 deg off, to the east; drone 0.5 m off, to the north; M1 3 m off, to the top"
        )


def test_no_error_is_said(paper: Callable) -> None:
    """A case without errors is not an empty phrase."""
    assert in_words(paper(1.0), UP, a_case()) == "everything as stated"
