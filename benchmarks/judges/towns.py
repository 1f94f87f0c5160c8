"""Scenes with buildings for the ray tracer: the town of the examples, and blocks of every shape."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.judges.cases import table_of
from nullpose import Pose, Scenario, load

_TOWN = Path(__file__).parents[2] / "examples" / "town.toml"
_NODES, _JAMMERS, _POSES = 15, 10, 40  # 1,000 links of a scene
_FIELD_M = 100.0  # from the middle to each side
_PITCH_M = 40.0
_SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_CORNER = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [-1.0, 1.0]])


def towns(seed: int = 2) -> Iterator[tuple[str, Scenario, list[Pose]]]:
    """Yield the name of a scene with buildings, the scene with random ground points, and random poses.

    A blocked link carries next to nothing, as with the ray tracer.
    """
    rng = np.random.default_rng(seed)
    for name, bare in (("a town", load(_TOWN)), ("blocks", Scenario.from_dict(blocks(rng)))):
        places_m = _on_the_ground(rng, bare, _NODES + _JAMMERS)
        channel = {"model": "free-space", "blocked_loss_db": 200.0, "shadow_margin_m": 0.0}
        points = {
            "nodes": table_of(rng, places_m[:_NODES], dict),
            "jammers": table_of(rng, places_m[_NODES:], dict),
        }
        receiver = {"noise_w": 1e-3, "reference_gain_db": 0.0}
        scenario = Scenario.from_dict(bare.to_dict() | points | {"channel": channel, "receiver": receiver})
        yield name, scenario, _poses(rng, scenario)


def blocks(rng: np.random.Generator) -> dict[str, Any]:
    """Draw a grid of blocks: squares, corners, blocks around a courtyard and blocks over a passage.

    Each is turned; every other roof is known as an interval only.
    """
    middles_m = np.arange(-2, 3) * _PITCH_M
    buildings = []
    for number, middle_m in enumerate(np.stack(np.meshgrid(middles_m, middles_m), axis=-1).reshape(-1, 2)):
        c, s = np.cos(angle := rng.uniform(0.0, np.pi)), np.sin(angle)
        half_m, turn = rng.uniform(10.0, 13.0), np.array([[c, s], [-s, c]])
        low_m = float(rng.uniform(6.0, 30.0))
        outline = _CORNER if number % 4 == 1 else _SQUARE
        building = {
            "polygon_m": (middle_m + half_m * outline @ turn).tolist(),
            "height_m": [low_m, low_m + 5.0 * (number % 2)],
        }
        if number % 4 == 2:
            building["courtyards_m"] = [(middle_m + 0.8 * half_m * _SQUARE @ turn).tolist()]
        if number % 4 == 3:
            building["base_m"] = 4.0
        buildings.append(building)
    return {
        "airspace": {"altitude_m": [4.0, 120.0], "x_m": [-_FIELD_M, _FIELD_M], "y_m": [-_FIELD_M, _FIELD_M]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [{"position_m": [0.5 * _PITCH_M, 0.0, 1.0], "power_w": 1.0}],
        "buildings": buildings,
    }


def _on_the_ground(rng: np.random.Generator, scenario: Scenario, count: int) -> np.ndarray:
    """Draw places up to 3 m above the ground, in the open and in courtyards."""
    places_m = rng.uniform([-_FIELD_M, -_FIELD_M, 0.0], [_FIELD_M, _FIELD_M, 3.0], (20 * count, 3))
    is_open = [not any(building.holds(place_m) for building in scenario.buildings) for place_m in places_m]
    return places_m[is_open][:count]


def _poses(rng: np.random.Generator, scenario: Scenario) -> list[Pose]:
    low_m, high_m = scenario.airspace.altitude_m
    places_m = rng.uniform([-_FIELD_M, -_FIELD_M, low_m], [_FIELD_M, _FIELD_M, high_m], (20 * _POSES, 3))
    places_m = places_m[scenario.open_airspace.allows(places_m)][:_POSES]
    return [Pose(place_m, *rng.uniform(-np.pi, np.pi, 3)) for place_m in places_m]
