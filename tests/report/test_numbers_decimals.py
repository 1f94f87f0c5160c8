"""A printed pose, typed again, is worth the printed value, and is allowed if the pose is."""

import io
import math
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from rich.console import Console
from sizes import chosen

from nullpose import Pose, Result, Scenario, evaluate
from nullpose.objectives import Quantity
from nullpose.physics import objective_of_links
from nullpose.problem.schemes import Scheme
from nullpose.report.results import pose_cells, result_view
from nullpose.solver import Status
from nullpose.solver.objective import objective_of
from nullpose.solver.result import Stats
from nullpose.study.evaluation import pose_faults
from scenes import EXAMPLES, best_found

NAMES = [path.stem for path in sorted(EXAMPLES.glob("*.toml")) if "study" not in path.name]
NUMBER = r"(-?[\d.]+)"


def typed_poses(result: Result, text: str) -> Iterator[tuple[str, Pose]]:
    """Yield the poses that the printed numbers give, read off the text of a result."""
    scenario, mount = result.scenario, result.pose.mount_rad
    position = numbers(rf"x {NUMBER} m, y {NUMBER} m, z {NUMBER} m", text)
    attitude = np.radians(
        numbers(rf"attitude +roll {NUMBER} deg, pitch {NUMBER} deg, yaw {NUMBER} deg", text)
    )
    yield "attitude", Pose(position, *attitude, mount)
    if scenario.origin is not None:
        place = numbers(rf"lat {NUMBER} deg, lon {NUMBER} deg, alt {NUMBER} m", text)
        at_m = scenario.origin.position_m(dict(zip(("lat_deg", "lon_deg", "alt_m"), place, strict=True)))
        yield "place", Pose(at_m, *attitude, mount)
        north, east, down = numbers(rf"north {NUMBER} m, east {NUMBER} m, down {NUMBER} m", text)
        yield "NED", Pose([east, north, -down], *attitude, mount)
    if scenario.antenna_record.is_quadratic:
        yield "vector", Pose.from_axis(position, numbers(rf"\({NUMBER}, {NUMBER}, {NUMBER}\)", text))
        tilt, azimuth = np.radians([*numbers(rf"antenna axis +{NUMBER} deg", text), *azimuth_of(text)])
        axis = [math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth), math.cos(tilt)]
        yield "angles", Pose.from_axis(position, axis)


def text_of(result: Result) -> str:
    """Return what a wide terminal without colours shows."""
    console = Console(width=400, file=io.StringIO(), highlight=False)
    console.print(result_view(result))
    return console.file.getvalue()


def azimuth_of(text: str) -> np.ndarray:
    """Return the azimuth of an axis, 0 of an upright one."""
    return numbers(rf"azimuth {NUMBER} deg", text) if "azimuth" in text else np.zeros(1)


SLOW = {"town": pytest.mark.grid}  # whose buildings take seconds


def numbers(pattern: str, text: str) -> np.ndarray:
    """Return the numbers of the first match in a text."""
    found = re.search(pattern, text)
    assert found is not None, (pattern, text)
    return np.array([float(group) for group in found.groups()])


def require_same(result: Result) -> None:
    """Check each printed pose against the value of seven digits, and against what is allowed."""
    scenario, quantity, text = result.scenario, Quantity.of(result.scenario), text_of(result)
    found = re.search(r": [a-z A-Z]+ (\S+) (?:dB|bits)", text)
    assert found is not None
    printed = float(found[1])
    unit = 10.0 ** (math.floor(math.log10(max(abs(printed), 0.1))) - 6)
    for name, pose in typed_poses(result, text):
        value = quantity.in_unit(objective_of_links(scenario, evaluate(scenario, pose)))
        assert value == pytest.approx(printed, rel=0.0, abs=1.01 * unit), name
        if name == "attitude" and not any(pose_faults(scenario, result.pose)):
            assert not list(pose_faults(scenario, pose))


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=SLOW.get(name, ())) for name in NAMES if name != "array"],
)
def test_the_pose_of_each_example_typed_again_has_its_value(name: str) -> None:
    """Position, attitude, axis as angles and as a vector, NED and place on the Earth."""
    require_same(best_found(name))


@pytest.mark.parametrize("seed", chosen(range(30), range(12)))  # every kind of each feature
def test_poses_in_deep_nulls_and_at_the_edge_of_shadows_typed_again_have_their_value(seed: int) -> None:
    """Jammers to 1e6 times the nodes' power, dipoles on the ground, bands, zones, and whatever the place.

    The axis points at a jammer, from anywhere and from a hair beside the edge of a shadow.
    """
    scenario, rng = scene(seed), np.random.default_rng(seed)
    places = rng.uniform([0.0, 0.0, 8.0], [60.0, 60.0, 30.0], (40, 3))
    gain = np.ones((len(places), 1))
    if scenario.prisms is not None:
        gain = scenario.source_channels.blocked_gain(places, scenario.source_positions_m)
    place, other = places[0], places[int(np.argmax(np.any(gain != gain[0], axis=1)))]
    for _ in range(25 if scenario.prisms is not None else 0):
        middle = 0.5 * (place + other)
        left = scenario.source_channels.blocked_gain(middle, scenario.source_positions_m)
        place, other = (middle, other) if np.array_equal(left, gain[0]) else (place, middle)
    for at in (place, places[-1]):
        pose = Pose.of_airframe(scenario, at, reached(scenario, at))
        require_same(given(scenario, pose))


def reached(scenario: Scenario, at: np.ndarray) -> np.ndarray:
    """Return the axis towards the first jammer, turned into the band that the airframe reaches."""
    away = scenario.jammer_positions_m[0] - at
    level, up = float(np.hypot(*away[:2])), abs(float(away[2]))
    low, high = scenario.axis_band
    up = float(np.sqrt(np.clip(up * up / (up * up + level * level), low, high)))
    return np.array([*(np.sqrt(1.0 - up * up) * away[:2] / level), -up])


def given(scenario: Scenario, pose: Pose) -> Result:
    """Return a pose as a result."""
    links = evaluate(scenario, pose)
    return Result(
        scenario=scenario,
        scheme=Scheme.OPTIMUM,
        status=Status.BEST_FOUND,
        reason="",
        objective=objective_of(scenario, objective_of_links(scenario, links), None),
        pose=pose,
        links=links,
        stats=Stats(starts=0, evaluations=0, boxes=0),
        provenance={},
        error_sizes=None,
    )


def test_a_deep_null_has_more_decimals_than_an_open_field() -> None:
    """So many as the null needs."""
    at = np.array([3.0, 40.0, 12.0])
    weak, strong = (
        Scenario.from_arrays(
            [[0, 0, 0], [0, 50, 0]], [[17, 15, 4]], jammer_power_w=power_w, noise_w=1e-3, altitude_m=(8, 30)
        )
        for power_w in (1e-6, 1e12)
    )
    pose = Pose.of_airframe(weak, at, np.array([17.0, 15.0, 4.0]) - at)
    decimals = [len(pose_cells(each, pose)["pitch (deg)"].split(".")[1]) for each in (weak, strong)]
    assert decimals[0] < decimals[1]


def scene(seed: int) -> Scenario:
    """Return a random scene with what makes a pose hard to type."""
    rng = np.random.default_rng([7, seed])
    nodes = rng.uniform(0.0, [60.0, 60.0, 3.0], (int(rng.integers(2, 5)), 3))
    jammers = rng.uniform(0.0, [60.0, 60.0, 3.0], (int(rng.integers(1, 3)), 3))
    power_w = float(10.0 ** rng.uniform(0.0, 6.0))
    table: dict[str, Any] = {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [{"position_m": p, "power_w": 1.0} for p in nodes.tolist()],
        "jammers": [{"position_m": p, "power_w": power_w} for p in jammers.tolist()],
    }
    if seed % 3 == 0:
        table["buildings"] = blocks(rng, np.vstack([nodes, jammers]))
        table["channel"] = {"shadow_margin_m": float(rng.choice([0.0, 0.5]))}
    if seed % 4 == 1:
        table["airframe"] = {
            "tilt_max_deg": float(rng.uniform(0.0, 60.0)),
            "mount_deg": float(rng.uniform(0.0, 90.0)),
        }
    if seed % 4 == 2:
        table["nodes"][0]["antenna"] = "dipole"
    if seed % 4 == 3:
        corners = rng.uniform(10.0, 50.0) + 15.0 * np.array([[-1.0, -0.7], [1.1, -0.6], [0.3, 1.2]])
        table["airspace"]["no_fly"] = [{"polygon_m": corners.tolist()}]
    return Scenario.from_dict(table)


def blocks(rng: np.random.Generator, points: np.ndarray) -> list[dict[str, Any]]:
    """Return up to four turned blocks that stand on no point."""
    found = []
    for _ in range(4):
        middle, angle = rng.uniform(0.0, 60.0, 2), rng.uniform(0.0, math.pi)
        if np.linalg.norm(points[:, :2] - middle, axis=1).min() > 9.0:
            turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
            square = np.array([[-6.0, -4.0], [6.0, -4.0], [6.0, 4.0], [-6.0, 4.0]])
            found.append(
                {"polygon_m": (middle + square @ turn).tolist(), "height_m": float(rng.uniform(5.0, 15.0))}
            )
    return found
