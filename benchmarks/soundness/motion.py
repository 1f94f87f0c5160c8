"""Random scenes in motion, each made from its number alone, with a vehicle that flies through them."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.soundness.features import FEATURES
from nullpose.errors import ScenarioError
from nullpose.problem.build import build_family
from nullpose.problem.family import still_scenes
from nullpose.scenario import Scenario

Table = dict[str, Any]

_OPEN = (
    *["channels"] * 5,
    *("airframe", "margins", "antennas", "depths", "secrecy", "downlink", "relay", "sum-rate"),
)
_ZONED = ("no-fly", "no-fly", "fence", "together", "touching")
_POINTS = ("nodes", "jammers", "eavesdroppers", "sources")
_MOST = {"nodes": 6, "jammers": 3}
_MANY, _FEW = 8, 6  # steps of a flight at most
_MAST_M = 0.5  # from its middle to each side


def make_motion_scene(number: int) -> Scenario:
    """Return the scene of a number, with every kind of channel, antenna and objective, a third with zones."""
    rng = np.random.default_rng([20263, number])
    kinds = _ZONED if number % 3 == 2 else _OPEN
    return _first_allowed(rng, kinds, f"flights {number}")


def make_zoned_scene(number: int) -> Scenario:
    """Return the scene of a number in which something is in the way: zones, a fence, points nearby."""
    rng = np.random.default_rng([20264, number])
    return _first_allowed(rng, _ZONED, f"zones {number}", is_crowded=True)


def with_mast(scenario: Scenario, positions_m: np.ndarray) -> Scenario:
    """Return the scene with a mast 1 m wide in the middle of the longest step of a flight, (t, 3)."""
    steps_m = np.linalg.norm(np.diff(positions_m[:, :2], axis=0), axis=1)
    t = int(np.argmax(steps_m))
    sides = 0.5 * (positions_m[t, :2] + positions_m[t + 1, :2])[:, None] + [-_MAST_M, _MAST_M]
    mast = dict(zip(("x_m", "y_m"), sides.tolist(), strict=True))
    table = scenario.to_dict()
    table["airspace"]["no_fly"] = [*table["airspace"].get("no_fly", []), mast]
    return Scenario.from_dict(table)


def _first_allowed(
    rng: np.random.Generator, kinds: tuple[str, ...], name: str, is_crowded: bool = False
) -> Scenario:
    while True:
        table = FEATURES[str(rng.choice(kinds))](rng) | {"name": name}
        table.pop("scheme", None)
        _fill(rng, table)
        if is_crowded:
            _crowd(rng, table)
        _move(rng, table, _FEW if is_crowded else _MANY)
        try:
            scenario = Scenario.from_dict(table)
            for still in still_scenes(scenario):
                build_family(still, any_channel=True, any_objective=True)
        except ScenarioError:  # a start in a zone, a point that drives into a building
            continue
        return scenario


def _fill(rng: np.random.Generator, table: Table) -> None:
    """Cut a scene down to six nodes and three jammers, or fill it up; put up buildings in some."""
    for kind, most in _MOST.items():
        del table[kind][most:]
        while len(table[kind]) < most and rng.uniform() < 0.5:
            alike = table[kind][0] if table[kind] else {"power_w": float(10.0 ** rng.uniform(-1.0, 2.0))}
            place = rng.uniform(0.0, [60.0, 60.0, 5.0]).tolist()
            table[kind].append({**alike, "position_m": place})
    if rng.uniform() < 0.2 and table.get("channel", {}).get("model") != "power-law":
        corners = rng.uniform(0.0, 50.0, (int(rng.integers(1, 4)), 2))
        sides = rng.uniform(3.0, 15.0, corners.shape)
        table["buildings"] = [
            {
                "polygon_m": [[x, y], [x + a, y], [x + a, y + b], [x, y + b]],
                "height_m": float(rng.uniform(3.0, 20.0)),
            }
            for (x, y), (a, b) in zip(corners.tolist(), sides.tolist(), strict=True)
        ]


def _crowd(rng: np.random.Generator, table: Table) -> None:
    """Lift points to the altitude of flights, with large balls around all; keep off zones by a margin."""
    airspace = table["airspace"]
    if rng.uniform() < 0.3:
        airspace["margin_m"] = float(rng.uniform(0.1, 2.0))
    if rng.uniform() < 0.5:
        airspace["keep_out_m"] = float(rng.uniform(1.0, 6.0))
        for point in [*table["nodes"], *table["jammers"]]:
            if rng.uniform() < 0.5:
                point["position_m"][2] = float(rng.uniform(6.0, 12.0))


def _move(rng: np.random.Generator, table: Table, most_steps: int) -> None:
    """Let points move at a velocity or along a track, and the vehicle fly, from and to somewhere in some."""
    step_s, steps = float(rng.choice([0.5, 1.0, 2.0])), int(rng.integers(5, most_steps + 1))
    duration_s = step_s * (steps - (0.5 if rng.uniform() < 0.2 else 0.0))
    table["time"] = {"duration_s": duration_s, "step_s": step_s}
    points = [point for kind in _POINTS for point in table.get(kind, [])]
    points += [table["destination"]] if "destination" in table else []
    always = int(rng.integers(len(points)))
    for i, point in enumerate(points):
        if i != always and rng.uniform() < 0.5:
            continue
        along_m_s = rng.normal(0.0, float(rng.choice([1.0, 5.0, 15.0])), 3) * [1.0, 1.0, 0.0]
        if rng.uniform() < 0.6:
            point["velocity_m_s"] = along_m_s.tolist()
            continue
        times_s = np.append(np.sort(rng.uniform(0.0, duration_s, int(rng.integers(1, 4)))), duration_s)
        bends_m = rng.normal(0.0, 5.0, (len(times_s), 3)) * [1.0, 1.0, 0.0]
        places_m = point["position_m"] + times_s[:, None] * along_m_s + bends_m
        point["track"] = np.column_stack([times_s, places_m]).tolist()
    speed_m_s = float(rng.choice([0.5, 2.0, 5.0, 10.0, 20.0]))
    airframe = table.get("airframe", {"preset": "omnidirectional"}) | {"speed_max_m_s": speed_m_s}
    start_m = rng.uniform([0.0, 0.0, 8.0], [60.0, 60.0, 15.0])
    way_m = rng.uniform(0.1, 0.8) * speed_m_s * duration_s * _direction(rng)
    if rng.uniform() < 0.3:
        airframe["start_m"] = start_m.tolist()
    if rng.uniform() < 0.3:
        airframe["end_m"] = np.clip(start_m + way_m, [-100.0, -100.0, 8.0], [200.0, 200.0, 30.0]).tolist()
    table["airframe"] = airframe


def _direction(rng: np.random.Generator) -> np.ndarray:
    level = rng.normal(size=3) * [1.0, 1.0, 0.2]
    return level / np.linalg.norm(level)
