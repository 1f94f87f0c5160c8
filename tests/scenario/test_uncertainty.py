"""Ground points that are known up to a set."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.physics import rotation_world_from_body
from nullpose.scenario import Eavesdropper, Jammer
from scenes import require_fault

KINDS = [
    lambda **values: Jammer(name="M", position_m=(1.0, 2.0, 3.0), power_w=1.0, **values),
    lambda **values: Eavesdropper(name="E", position_m=(1.0, 2.0, 3.0), **values),
]
ELLIPSOID = {"uncertainty_m": [1, 2, 3]}
angles = st.floats(-360.0, 360.0)
axes = st.floats(0.0, 100.0)


@pytest.mark.parametrize("kind", KINDS)
def test_without_uncertainty_the_set_is_a_point(kind: object) -> None:
    """Left out, or a radius of 0, the matrix is zero; it cannot be written to."""
    for point in (kind(), kind(uncertainty_m=0.0), kind(uncertainty_m=[0, 0, 0])):
        np.testing.assert_array_equal(point.uncertainty_matrix_m, np.zeros((3, 3)))
        assert point.uncertainty_reach_m == 0.0
        with pytest.raises(ValueError, match="read-only"):
            point.uncertainty_matrix_m[0, 0] = 1.0


@given(a=axes, b=axes, c=axes, roll=angles, pitch=angles, yaw=angles)
def test_an_ellipsoid_turns_as_a_body_does(
    a: float, b: float, c: float, roll: float, pitch: float, yaw: float
) -> None:
    """The matrix is the body's rotation by roll, pitch and yaw times the semi-axes."""
    jammer = KINDS[0](uncertainty_m=[a, b, c], uncertainty_attitude_deg=[roll, pitch, yaw])
    turn = rotation_world_from_body(*np.radians([roll, pitch, yaw]))
    np.testing.assert_allclose(jammer.uncertainty_matrix_m, turn @ np.diag([a, b, c]), atol=1e-12 * 100)
    reach = np.linalg.norm(jammer.uncertainty_matrix_m, ord=2)
    assert jammer.uncertainty_reach_m == pytest.approx(reach, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("values", "path", "words"),
    [
        ({"uncertainty_m": -1.0}, "uncertainty_m", "got -1.0, must be a radius in m"),
        ({"uncertainty_m": float("nan")}, "uncertainty_m", "got NaN"),
        ({"uncertainty_m": "3"}, "uncertainty_m", "a radius in m (or a list of three semi-axes"),
        ({"uncertainty_m": []}, "uncertainty_m", "got an empty list, must be a list of three semi-axes"),
        ({"uncertainty_m": [1.0, 2.0]}, "uncertainty_m", "got a list of 2 values"),
        ({"uncertainty_m": [1.0, -2.0, 3.0]}, "uncertainty_m[1]", "got -2.0"),
        ({"uncertainty_attitude_deg": [0, 0, 0]}, "uncertainty_attitude_deg", "without three semi-axes"),
        (ELLIPSOID | {"uncertainty_attitude_deg": [0, 400, 0]}, "uncertainty_attitude_deg[1]", "from -360"),
        (ELLIPSOID | {"uncertainty_attitude_deg": 30.0}, "uncertainty_attitude_deg", "[roll, pitch, yaw]"),
    ],
)
def test_faults(kind: object, values: dict[str, object], path: str, words: str) -> None:
    """Each fault is reported once, at its place, for jammers and eavesdroppers alike."""
    require_fault(lambda: kind(**values), path, words)
