"""Airframes and arrays in words."""

import math

import pytest

from nullpose import Airframe
from nullpose.report.words import airframe_words, reach_words


def test_tilt_and_mount_are_told() -> None:
    """The limit, what is used of it, and how the dipole is mounted."""
    airframe = Airframe(tilt_max_deg=10.0, mount_deg=90.0)
    assert airframe_words(airframe) == "tilts at most 10 deg; dipole 90 deg from upright on the body"
    used = airframe_words(airframe, math.radians(7.5))
    assert used == "tilted by 7.500 deg, at most 10 deg; dipole 90 deg from upright on the body"
    slanted = airframe_words(Airframe(tilt_max_deg=20.0, mount_deg=45.0))
    assert slanted.endswith("dipole 45 deg from upright on the body")


@pytest.mark.parametrize(
    ("tilt_deg", "mount_deg", "words"),
    [
        (10.0, 90.0, "axes 80 to 90 deg from the vertical"),
        (20.0, 45.0, "axes 25 to 65 deg from the vertical"),
        (0.0, 0.0, "axes 0 to 0 deg from the vertical"),
        (90.0, 0.0, "any axis direction"),
    ],
)
def test_reach(tilt_deg: float, mount_deg: float, words: str) -> None:
    """The band of axes is mount less tilt to mount plus tilt."""
    assert reach_words(Airframe(tilt_max_deg=tilt_deg, mount_deg=mount_deg)) == words
