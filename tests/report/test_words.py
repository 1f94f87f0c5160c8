"""What an airframe reaches, requirements met or missed, and channels, in words."""

from pathlib import Path

import pytest

from nullpose import Airframe, Scenario, load, solve
from nullpose.report.words import channel_words, reach_words, requirement_words
from nullpose.scenario import apply_overrides

EXAMPLES = Path(__file__).parents[2] / "examples"


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


def test_met_requirements_say_what_is_to_spare(scenario: Scenario) -> None:
    """The node with least to spare is named with its margin, which is the value itself."""
    solution = solve(scenario)
    words = requirement_words(solution)
    assert words.startswith("every requirement is met; node ")
    assert f"{solution.objective.value_db:.2f} dB above what it requires" in words


def test_missed_requirements_are_named(scenario: Scenario) -> None:
    """Asked for 15 dB more, both fall short, by so much; the bound proves that no pose does better."""
    more = apply_overrides(scenario, ["nodes.camera.min_sinr_db=18", "nodes.thermometer.min_sinr_db=9"])
    solution = solve(more)
    words = requirement_words(solution)
    assert words.startswith("missed: node ")
    assert words.count(f"{-solution.objective.value_db:.2f} dB below what it requires") == 2
    assert words.endswith("proved: no pose of this case meets every requirement")
    assert "proved" not in requirement_words(solve(more, certify=False))
    assert requirement_words(solve(more, "vertical")).endswith("no pose of this case meets every requirement")


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


def test_among_buildings_no_average_is_named() -> None:
    """Buildings decide on line of sight there; by elevation a probability does, and the average is named."""
    town, numbers = load(EXAMPLES / "town.toml"), "channel.average=db"
    assert channel_words(town) == "elevation, environment urban, line of sight by buildings"
    assert channel_words(apply_overrides(town, [numbers])) == channel_words(town)
    open_ground = town.model_copy(update={"buildings": ()})
    assert channel_words(open_ground) == "elevation, environment urban, average power"
