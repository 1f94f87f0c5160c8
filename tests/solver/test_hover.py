"""The pose to hold for a scene in motion: its value is the least of all, and no pose beats its bound."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nullpose
from nullpose.errors import UsageError
from nullpose.physics import Pose, evaluate, objective_of_links
from nullpose.scenario import Scenario
from nullpose.solver.hover import HoverDetails

ROOT = Path(__file__).parents[2]
LEVEL = {"tilt_max_deg": 0.0, "mount_deg": 0.0}


def circling(steps: int = 8, **keys: Any) -> Scenario:
    """Return two nodes, and a jammer that goes round between them."""
    turn = [(t, 2.0 * math.pi * t / steps) for t in range(steps + 1)]
    track = [[float(t), 20.0 * math.cos(a), 25.0 + 15.0 * math.sin(a), 4.0] for t, a in turn]
    data = {
        "time": {"duration_s": float(steps), "step_s": 1.0},
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [{"position_m": place, "power_w": 1.0} for place in ([0.0, 0.0, 0.0], [0.0, 50.0, 0.0])],
        "jammers": [{"track": track, "power_w": 1.0}],
    }
    return Scenario.from_dict(data | keys)


def values_of(scene: Scenario, pose: Pose) -> list[float]:
    """Return the objective of a pose at every instant."""
    stills = [scene.at(float(t_s)) for t_s in scene.instants_s]
    return [objective_of_links(still, evaluate(still, pose)) for still in stills]


@pytest.mark.parametrize(
    "keys",
    [
        {},
        {"airframe": LEVEL},
        {"antenna": {"null_depth_db": 20.0}, "airframe": {"tilt_max_deg": 20.0}},
        {"channel": {"model": "elevation", "environment": "urban", "average": "power"}, "airframe": LEVEL},
        {"airspace": {"altitude_m": [8.0, 30.0], "no_fly": [{"x_m": [-9.0, 9.0], "y_m": [10.0, 40.0]}]}},
    ],
    ids=["free", "level", "leak", "channel", "zone"],
)
def test_the_value_is_the_least_and_no_pose_beats_the_bound(keys: dict[str, Any]) -> None:
    """By the physics at every instant, for the pose itself and for thousands of others."""
    scene = circling(**keys)
    found = nullpose.solve(scene, hover=True, gap=1e-2)
    values = values_of(scene, found.pose)
    assert found.objective.value == min(values)
    assert isinstance(found.details, HoverDetails)
    np.testing.assert_array_equal(found.details.values, values)
    assert found.scenario.at_s == found.details.worst_s == np.argmin(values)
    assert found.status == "certified"
    bound, airspace, rng = found.objective.upper_bound, scene.airspace, np.random.default_rng(3)
    assert bound is not None
    assert found.objective.value <= bound <= found.objective.value * 1.0101
    for _ in range(50):
        place = found.pose.position_m + rng.normal(0.0, 5.0, 3)
        place[2] = np.clip(place[2], 8.0, 30.0)
        axis = np.array([0.0, 0.0, 1.0]) if "airframe" in keys else rng.normal(size=3)
        if not airspace.allows(place):
            continue
        assert min(values_of(scene, Pose.of_airframe(found.scenario, place, axis))) <= bound


def test_no_instant_alone_gives_less() -> None:
    """Each instant has a pose of its own that is no worse, and a scene that hardly moves has the same one."""
    scene = circling(6, airframe=LEVEL)
    found = nullpose.solve(scene, hover=True)
    for t_s in scene.instants_s:
        bound = nullpose.solve(scene.at(float(t_s))).objective.upper_bound
        assert bound is not None
        assert found.objective.value <= bound
    data = nullpose.load(ROOT / "examples" / "paper.toml").to_dict()
    data["jammers"][0]["velocity_m_s"] = [1e-9, 0.0, 0.0]
    still = Scenario.from_dict(data | {"time": {"duration_s": 2.0, "step_s": 1.0}})
    held, alone = nullpose.solve(still, hover=True), nullpose.solve(still.at(0.0))
    assert held.objective.value == pytest.approx(alone.objective.value, rel=1e-4)


def test_a_search_alone_proves_nothing() -> None:
    """Without a proof there is a pose and no bound."""
    found = nullpose.solve(circling(6), hover=True, certify=False)
    assert found.objective.upper_bound is None
    assert found.rigour == "none"
    assert found.objective.value == min(values_of(circling(6), found.pose))


@pytest.mark.parametrize(
    ("scene", "options", "words"),
    [
        (nullpose.load(ROOT / "examples" / "paper.toml"), {}, "has no [time]"),
        (circling(4, antenna={"kind": "half-wave"}), {}, "a dipole"),
        (circling(4), {"robust": True}, "robust with hover"),
        (circling(4), {"scheme": "vertical"}, "scheme vertical for a hover"),
        (circling(4, objective="sum-rate"), {}, "smallest ratio"),
    ],
    ids=["still", "antenna", "robust", "scheme", "mean"],
)
def test_what_is_no_hover_is_refused(scene: Scenario, options: dict[str, Any], words: str) -> None:
    """In words, and not solved for one instant instead."""
    with pytest.raises(UsageError, match=words.replace("[", r"\[")):
        nullpose.solve(scene, hover=True, **options)
