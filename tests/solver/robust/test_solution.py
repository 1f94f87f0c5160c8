"""What a robust solve hands back."""

import json
import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullpose.physics.error_case import ErrorCase
from nullpose.solver import Result
from nullpose.solver.robust.solution import in_words


def test_as_plain_data(solved: Result) -> None:
    """The solution is plain data with both poses, their values and errors, and what is proved."""
    data = json.loads(json.dumps(solved.to_dict(), allow_nan=False))
    assert data["status"] == "certified"
    assert data["upper_bound"] == solved.objective.upper_bound
    assert data["relative_gap"] == solved.objective.relative_gap
    assert data["error_cases"] == solved.details.cases
    assert data["stats"]["boxes"] == solved.stats.boxes
    for key, held in (("robust", solved.details.robust), ("nominal", solved.details.nominal)):
        one = data[key]
        assert one["guaranteed"] == held.guaranteed == min(node["guaranteed"] for node in one["nodes"])
        assert one["worst_found"] == held.worst == min(node["worst_found"] for node in one["nodes"])
        assert one["nominal"] == held.nominal == pytest.approx(min(node["nominal"] for node in one["nodes"]))
        assert one["position_m"] == [float(x) for x in held.pose.position_m]
        assert one["worst_case_errors"]["axis_error_deg"] == pytest.approx(2.0, rel=1e-9)
        assert one["worst_case"].startswith("axis 2 deg off")
        assert [node["node"] for node in one["nodes"]] == ["S1", "S2"]


def test_gap_and_gain(solved: Result) -> None:
    """The gap is the bound over the guaranteed value less one; the gain compares both poses' guarantees."""
    assert solved.objective.upper_bound is not None
    assert solved.objective.relative_gap == pytest.approx(
        solved.objective.upper_bound / solved.details.robust.guaranteed - 1.0
    )
    assert solved.label == solved.scheme == "robust"
    assert solved.details.gain == pytest.approx(
        solved.details.robust.guaranteed / solved.details.nominal.guaranteed
    )
    assert replace(solved.details, nominal=solved.details.robust).gain == 1.0


def test_the_answer_cannot_be_changed(solved: Result) -> None:
    """Provenance and arrays are read-only."""
    with pytest.raises(TypeError):
        solved.provenance["seed"] = 1  # type: ignore[index]
    with pytest.raises(ValueError, match="read-only"):
        solved.details.robust.guarantee.position_m[0] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        solved.details.robust.guarantee.case.jammer_offsets_m[0] = 0.0


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
