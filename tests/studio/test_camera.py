"""Where the camera stands, and how far it sees."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.chromium import pixels

from nullpose import load, solve
from nullpose.scenario import Scenario
from nullpose.studio.camera import CARD_PX, NARROW_PX, PHONE_CARD_PX, aim, frame_m
from nullpose.studio.ground import grid_m, scene_size_m


@pytest.mark.parametrize("scale", [0.1, 1.0, 20.0, 400.0])
def test_nothing_of_a_scene_is_cut_away(paper: Scenario, scale: float) -> None:
    """From ten metres to tens of kilometres the whole scene lies between the near and the far plane."""
    nodes = tuple(
        one.model_copy(update={"position_m": tuple(scale * np.array(one.position_m))}) for one in paper.nodes
    )
    scenario = paper.model_copy(update={"nodes": nodes})
    camera = SimpleNamespace(position=np.ones(3), look_at=np.zeros(3), fov=1.3)
    aim(camera, scenario)
    middle, reach_m = np.mean(grid_m(scenario)[:2], axis=0), scene_size_m(scenario)
    middle = np.append(middle, 0.0)
    forward = (camera.look_at - camera.position) / np.linalg.norm(camera.look_at - camera.position)
    for offset in np.ndindex(2, 2, 2):
        corner = middle + reach_m * (np.array(offset) - [0.5, 0.5, 0.0]) * [1.0, 1.0, 0.1]
        assert camera.near < (corner - camera.position) @ forward < camera.far
    assert np.linalg.norm(camera.position - camera.look_at) < 0.1 * camera.far
    assert camera.look_at[2] == pytest.approx(0.0, abs=1e-9 * reach_m)


@pytest.mark.parametrize("canvas", [(1280, 800), (890, 800), (390, 844)])
@pytest.mark.parametrize("name", ["paper", "field", "no-fly", "eavesdropper"])
def test_all_that_matters_is_seen(name: str, canvas: tuple[int, int]) -> None:
    """At any aspect every point, the drone and its pattern are on the canvas; fence, grid and numbers too."""
    scenario = load(Path(__file__).parents[2] / "examples" / f"{name}.toml")
    pose = solve(scenario, certify=False).pose
    camera = SimpleNamespace(
        position=np.ones(3), look_at=np.zeros(3), fov=1.3, image_width=canvas[0], image_height=canvas[1]
    )
    aim(camera, scenario, pose)
    points = [one.position_m for one in (*scenario.nodes, *scenario.jammers, *scenario.eavesdroppers)]
    reach_m = 0.12 * scene_size_m(scenario) * np.vstack([np.eye(3), -np.eye(3)])
    seen = pixels(camera, np.vstack([points, pose.position_m + reach_m]))
    assert np.all(seen[:, 2] > camera.near)
    assert np.all((seen[:, :2] > 0.0) & (seen[:, :2] < canvas))
    around = pixels(camera, frame_m(scenario))[:, :2]
    assert np.all((around > 10.0) & (around < np.array(canvas) - 10.0))
    card_px = PHONE_CARD_PX if canvas[0] < NARROW_PX else CARD_PX
    assert not np.any(np.all(seen[: len(points), :2] < card_px, axis=1)), "the card covers a point"


@pytest.mark.parametrize(("canvas", "card_px"), [((1280, 800), (352, 572)), ((390, 844), (352, 432))])
def test_the_card_of_two_cases_covers_no_drone(canvas: tuple[int, int], card_px: tuple[int, int]) -> None:
    """It is higher, and the scene stands beside it or below it."""
    scenario = load(Path(__file__).parents[2] / "examples" / "robust.toml")
    pose = solve(scenario, certify=False).pose
    camera = SimpleNamespace(
        position=np.ones(3), look_at=np.zeros(3), fov=1.3, image_width=canvas[0], image_height=canvas[1]
    )
    aim(camera, scenario, pose, cases=2)
    reach_m = 0.12 * scene_size_m(scenario) * np.vstack([np.eye(3), -np.eye(3)])
    seen = pixels(camera, pose.position_m + reach_m)[:, :2]
    assert not np.any(np.all(seen < card_px, axis=1))


@pytest.mark.parametrize("name", ["paper", "field"])
def test_on_a_phone_the_scene_stands_between_card_and_hints(name: str) -> None:
    """Points and drone are below the card, and above the hints of a first visit."""
    scenario = load(Path(__file__).parents[2] / "examples" / f"{name}.toml")
    pose = solve(scenario, certify=False).pose
    camera = SimpleNamespace(position=np.ones(3), image_width=390, image_height=844)
    aim(camera, scenario, pose)
    seen = pixels(camera, [*(point.position_m for point in scenario.points), pose.position_m])[:, 1]
    assert np.all((seen > PHONE_CARD_PX[1]) & (seen < 844 - 229))
