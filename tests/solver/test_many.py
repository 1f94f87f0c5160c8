"""Many scenes in one call: what one call for each gives."""

import math
from importlib import import_module

import numpy as np
import pytest

from nullpose.errors import UsageError
from nullpose.physics import Pose, min_margin
from nullpose.scenario import Airframe, Scenario
from nullpose.solver import Status, solve, solve_many
from nullpose.solver.many import NOWHERE

GAP = 1e-3
VEHICLES = (
    Airframe(tilt_max_deg=0.0, mount_deg=0.0),
    Airframe(tilt_max_deg=10.0, mount_deg=90.0),
    None,
    Airframe(tilt_max_deg=30.0, mount_deg=90.0),
)


def scene(
    rng: np.random.Generator, nodes: int = 2, jammers: int = 1, top: dict[str, object] | None = None
) -> Scenario:
    """Returns a random scene, with other tables in place of its own if they are given."""
    ground = [0.0, 0.0, 0.0], [60.0, 60.0, 4.0]
    return Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [
                {"position_m": rng.uniform(*ground).tolist(), "power_w": rng.uniform(0.3, 2.0)}
                for _ in range(nodes)
            ],
            "jammers": [
                {"position_m": rng.uniform(*ground).tolist(), "power_w": 10.0 ** rng.uniform(-1.0, 2.0)}
                for _ in range(jammers)
            ],
        }
        | (top or {})
    )


def test_the_answers_are_those_of_single_solves() -> None:
    """Of scenes of several shapes, in their order, for each vehicle; the values are those of the poses."""
    rng = np.random.default_rng(3)
    scenes = [scene(rng, nodes, jammers) for nodes, jammers in ((2, 1), (3, 2), (2, 1), (1, 0), (2, 0))]
    many = solve_many(scenes, airframes=VEHICLES, gap=GAP)
    assert many.value.shape == many.upper_bound.shape == (5, 4)
    assert np.all(many.status == Status.CERTIFIED)
    assert np.all(many.reason == "")
    assert np.all(many.relative_gap <= GAP)
    for row, one in enumerate(scenes):
        for column, airframe in enumerate(VEHICLES):
            here = one.model_copy(update={"airframe": airframe})
            alone = solve(here, gap=GAP)
            assert alone.objective.upper_bound is not None
            assert many.value[row, column] <= alone.objective.upper_bound
            assert alone.objective.value <= many.upper_bound[row, column]
            mount_rad = 0.0 if airframe is None else airframe.mount_rad
            angles = (many.roll_rad, many.pitch_rad, many.yaw_rad)
            attitude = [float(angle[row, column]) for angle in angles]
            pose = Pose(many.position_m[row, column], *attitude, mount_rad)
            assert min_margin(here, pose) == many.value[row, column]
            assert airframe is None or pose.tilt_rad <= airframe.tilt_max_rad
            assert one.airspace.allows(pose.position_m)


def test_more_freedom_is_never_worse() -> None:
    """A vehicle that reaches more axes has no smaller bound, and what it proved is not proved again."""
    rng = np.random.default_rng(4)
    many = solve_many([scene(rng) for _ in range(12)], airframes=VEHICLES, gap=GAP)
    order = [1, 3, 2]  # 10 degrees, 30 degrees, all axes
    assert np.all(np.diff(many.upper_bound[:, order], axis=1) >= 0.0)
    assert np.all(np.diff(many.value[:, order], axis=1) >= -GAP * many.value[:, :1])
    shared = many.value[:, 3] == many.value[:, 2]
    assert np.any(shared)
    assert np.all(many.boxes[shared, 3] == 0)


def test_neither_company_nor_order_matters() -> None:
    """Each scene's numbers are the same alone, among others and in any order."""
    rng = np.random.default_rng(5)
    scenes = [scene(rng, nodes) for nodes in (2, 3, 2, 2, 3)]
    many = solve_many(scenes, airframes=VEHICLES[:2], gap=GAP, threads=1)
    back = solve_many(scenes[::-1], airframes=VEHICLES[:2], gap=GAP, threads=1)
    for name in ("value", "upper_bound", "position_m", "yaw_rad", "boxes", "binding_node"):
        np.testing.assert_array_equal(getattr(many, name), getattr(back, name)[::-1])
    alone = solve_many(scenes[3:4], airframes=VEHICLES[:2], gap=GAP, threads=1)
    np.testing.assert_array_equal(alone.value[0], many.value[3])


def test_each_scene_has_its_own_airframe_unless_others_are_named() -> None:
    """Without airframes the scenes' own count, each its own."""
    rng = np.random.default_rng(6)
    level, free = Airframe(preset="level"), Airframe(preset="omnidirectional")
    one = scene(rng)
    both = [one.model_copy(update={"airframe": airframe}) for airframe in (level, free, None)]
    many = solve_many(both, gap=GAP)
    assert many.value.shape == (3, 1)
    assert many.value[0, 0] < many.value[1, 0]
    assert many.value[1, 0] == pytest.approx(many.value[2, 0], rel=GAP)
    assert many.pitch_rad[0, 0] == 0.0


def test_a_long_proof_gets_its_stages(monkeypatch: pytest.MonkeyPatch) -> None:
    """What needs more than the first try is proved in stages, to the same gap."""
    scenes = [scene(np.random.default_rng(seed)) for seed in range(4)]
    straight = solve_many(scenes, gap=GAP)
    monkeypatch.setattr(import_module("nullpose.solver.proof"), "_TRIES", ((0.0, 5),))
    staged = solve_many(scenes, gap=GAP, threads=1)
    assert np.all(staged.status == Status.CERTIFIED)
    assert np.all(np.abs(staged.value / straight.value - 1.0) <= GAP)
    short = solve_many(scenes, gap=1e-6, node_limit=20)
    assert np.all(short.status == Status.GAP_NOT_REACHED)
    assert np.all(short.upper_bound >= straight.value)
    assert {reason for (reason,) in short.reason.tolist()} == {"the node limit of 20"}


def test_margins_and_zones_are_kept() -> None:
    """What is maximised is the smallest margin, and poses stay out of zones."""
    rng = np.random.default_rng(7)
    data = scene(rng, 3).to_dict()
    data["nodes"][0]["weight"] = 4.0
    data["airspace"]["no_fly"] = [{"centre_m": [30.0, 30.0], "radius_m": 20.0}]
    one = Scenario.from_dict(data)
    many, alone = solve_many([one], gap=GAP), solve(one, gap=GAP)
    assert one.airspace.allows(many.position_m[0, 0])
    assert many.value[0, 0] == pytest.approx(alone.objective.value, rel=GAP)
    assert one.node_names[many.binding_node[0, 0]] in one.node_names


def test_without_a_proof_there_is_no_bound() -> None:
    """The search alone: the best found, with an infinite bound."""
    many = solve_many([scene(np.random.default_rng(8))], certify=False)
    assert many.status[0, 0] is Status.BEST_FOUND
    assert many.upper_bound[0, 0] == math.inf


def test_a_scene_without_a_pose_has_a_reason() -> None:
    """A node that no vehicle hears, being straight below where a level one must be, costs no other scene."""
    deaf = scene(
        np.random.default_rng(9),
        jammers=0,
        top={
            "nodes": [{"position_m": [5.0, 5.0, 0.0], "power_w": 1.0}],
            "airspace": {"altitude_m": [8.0, 8.0], "x_m": [5.0, 5.0], "y_m": [5.0, 5.0]},
        },
    )
    heard = scene(np.random.default_rng(10))
    many = solve_many([deaf, heard], airframes=[VEHICLES[0]], gap=GAP)
    assert many.reason[0, 0] == NOWHERE
    assert many.status[0, 0] is None
    assert math.isnan(many.value[0, 0])
    assert many.status[1, 0] is Status.CERTIFIED


def test_progress_is_told() -> None:
    """How many scenes are done, and of how many."""
    told: list[tuple[int, int]] = []
    solve_many(
        [scene(np.random.default_rng(seed)) for seed in range(3)],
        gap=GAP,
        on_progress=lambda done, total: told.append((done, total)),
    )
    assert told[-1] == (3, 3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"scenarios": []}, "scenarios: given none"),
        ({"airframes": []}, "airframes: given none"),
        ({"threads": 0}, "threads: given 0"),
    ],
)
def test_faults(change: dict, message: str) -> None:
    """Each says what was given and what is allowed."""
    arguments: dict = {"scenarios": [scene(np.random.default_rng(1))]} | change
    with pytest.raises(UsageError, match=message):
        solve_many(arguments.pop("scenarios"), **arguments)


def test_arrays_and_rates_are_for_other_verbs() -> None:
    """The message names the scenario and the verb."""
    plain = scene(np.random.default_rng(1))
    array = Scenario.from_dict(
        plain.to_dict() | {"array": {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5}}
    )
    with pytest.raises(UsageError, match=r"scenarios\[1\]: asks for an array.*use solve"):
        solve_many([plain, array])
