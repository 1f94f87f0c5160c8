"""What an airframe reaches, requirements met or missed, and channels, in words."""

import pytest

from nullpose import Airframe, Scenario, load, solve
from nullpose.report.words import reach_words, requirement_words
from scenes import EXAMPLES


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


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    """A camera that requires 3 dB, and a thermometer that requires -6 dB."""
    return load(EXAMPLES / "requirements.toml")


def test_a_weight_proves_nothing_about_requirements(scenario: Scenario) -> None:
    """Where a node has a weight instead, the bound is on margins, not on requirements alone."""
    data = scenario.to_dict()
    data["nodes"][0]["min_sinr_db"] = 30.0
    del data["nodes"][1]["min_sinr_db"]
    data["nodes"][1]["weight"] = 100.0
    words = requirement_words(solve(Scenario.from_dict(data)))
    assert "missed: node camera" in words
    assert "thermometer" not in words
    assert "proved" not in words
