"""Scenes whose points move on: the same as scenes that are made anew, and as strict."""

import math
from typing import Any

import numpy as np
import pytest

import nullpose
from nullpose.errors import ScenarioError
from nullpose.physics import Pose, evaluate
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario
from nullpose.scenario.motion import move_points
from scenes import EXAMPLES

FILES = (
    "paper",
    "field",
    "eavesdropper",
    "friendly-jamming",
    "relay",
    "urban",
    "town",
    "whips",
    "geodetic",
    "robust",
)
LISTS = ("nodes", "jammers", "eavesdroppers", "sources")


def places_of(scene: Scenario, step_m: float) -> dict[str, Any]:
    """Return the places of all points of a scene, each a step further, none in the direction of another."""
    lists = {
        kind: np.array([p.position_m for p in getattr(scene, kind)]) for kind in LISTS if getattr(scene, kind)
    }
    if scene.destination is not None:
        lists["destination"] = np.array([scene.destination.position_m])
    return {
        kind: at_m + step_m * np.column_stack([np.cos(k := np.arange(len(at_m))), np.sin(k), 0.0 * k])
        for kind, at_m in lists.items()
    }


@pytest.mark.parametrize("name", FILES)
def test_a_moved_scene_is_one_that_is_made_anew(name: str) -> None:
    """All that search, proof and physics take from it is what a scene that is read as it stands has."""
    scene = nullpose.load(EXAMPLES / f"{name}.toml")
    pose = Pose([3.0, 20.0, 30.0], roll_rad=0.3, pitch_rad=-0.4)
    evaluate(scene, pose), build_family(scene, any_channel=True, any_objective=True)  # fill what it keeps
    for _ in range(2):
        places = places_of(scene, 0.2)
        scene = move_points(scene, places)
        anew = Scenario.from_dict(scene.to_dict())
        np.testing.assert_array_equal(scene.nodes[-1].position_m, places["nodes"][-1])
        families = [build_family(each, any_channel=True, any_objective=True) for each in (scene, anew)]
        assert families[0].digest == families[1].digest
        assert evaluate(scene, pose) == evaluate(anew, pose)
        assert scene == anew


@pytest.mark.parametrize(
    ("place_m", "words"),
    [
        ([math.nan, 0.0, 0.0], r"jammers\[0\].position_m\[0\]: got NaN"),
        ([0.0, 50.0, 0.0], r"jammers\[0\].position_m: .*the place of nodes\[1\] already"),
        ([0.0, 1e8, 0.0], r"jammers\[0\].position_m\[1\]: got 100000000.0"),
    ],
    ids=["nan", "two at one place", "far"],
)
def test_places_that_are_none_are_refused(place_m: list[float], words: str) -> None:
    """As a file with them is, by their place in it."""
    with pytest.raises(ScenarioError, match=words):
        move_points(nullpose.load(EXAMPLES / "paper.toml"), {"jammers": np.array([place_m])})


def test_nobody_walks_into_a_building() -> None:
    """A jammer that comes to stand in one is refused, and one beside it is not."""
    town = nullpose.load(EXAMPLES / "town.toml")
    inside_m = np.mean(town.buildings[0].polygon_m, axis=0)
    with pytest.raises(ScenarioError, match=r"jammers\[0\] at .* stands in it"):
        move_points(town, {"jammers": np.array([[*inside_m, 1.0]])})
    assert move_points(town, {"jammers": town.jammer_positions_m + 0.1}).jammers != town.jammers
