"""Ground points that are known up to a ball."""

import pytest

from nullpose.scenario import Eavesdropper, Jammer
from scenes import require_fault

KINDS = [
    lambda **values: Jammer(name="M", position_m=(1.0, 2.0, 3.0), power_w=1.0, **values),
    lambda **values: Eavesdropper(name="E", position_m=(1.0, 2.0, 3.0), **values),
]


@pytest.mark.parametrize("kind", KINDS)
def test_the_reach_is_the_radius(kind: object) -> None:
    """Left out, or a radius of 0, the set is a point."""
    for radius_m in (None, 0.0, 3.0):
        assert kind(uncertainty_m=radius_m).uncertainty_reach_m == (radius_m or 0.0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("values", "path", "words"),
    [
        ({"uncertainty_m": -1.0}, "uncertainty_m", "got -1.0, must be a radius in m"),
        ({"uncertainty_m": float("nan")}, "uncertainty_m", "got NaN"),
        ({"uncertainty_m": "3"}, "uncertainty_m", "must be a number: a radius in m"),
        ({"uncertainty_m": []}, "uncertainty_m", "got an empty list, must be a number: a radius in m"),
        ({"uncertainty_m": [1.0, 2.0]}, "uncertainty_m", "got a list of 2 values"),
        ({"uncertainty_m": [1.0, -2.0, 3.0]}, "uncertainty_m", "got a list of 3 values"),
        (
            {"uncertainty_m": [1, 2.5, 0.1]},
            "uncertainty_m",
            "write 2.5, the radius of the ball that contains",
        ),
        (
            {"uncertainty_attitude_deg": [0, 0, 9]},
            "uncertainty_attitude_deg",
            "a ball, which has no attitude",
        ),
    ],
)
def test_faults(kind: object, values: dict[str, object], path: str, words: str) -> None:
    """Each fault is reported once, at its place, for jammers and eavesdroppers alike."""
    require_fault(lambda: kind(**values), path, words)
