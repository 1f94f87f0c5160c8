from collections.abc import Callable
from importlib import import_module
from itertools import pairwise

import numpy as np
import pytest
from sizes import diagonal

from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.scenario import Airframe, Scenario, apply_overrides, load
from nullpose.solver import solve
from nullpose.solver.kernels.bounds import node
from nullpose.solver.kernels.linear_algebra.axis import best_axis
from nullpose.solver.kernels.linear_algebra.links import log_objective
from nullpose.solver.multistart import multistart
from nullpose.solver.options import SolveOptions
from nullpose.solver.proof import Proof, prove

PAPER = "examples/paper.toml"


def proof_of(family: Family, axis_field: AxisField, **limits: float) -> Proof:
    """Return a proof from a multistart's incumbent."""
    found = multistart(family, axis_field, seed=1)
    return prove(family, axis_field, found, SolveOptions(**limits))


def boxes(proof: Proof) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and highest corners of a proof's leaves."""
    centre, half = proof.leaves[:, node.CENTRE : node.HALF], proof.leaves[:, node.HALF : node.LEVEL]
    return centre - half, centre + half


def value_at(family: Family, p: np.ndarray) -> float:
    """Return the smallest ratio at a position with its best axis."""
    axis = np.empty(3)
    return float(np.exp(best_axis(family.ratios, p, axis)))


@pytest.mark.parametrize("power_w", [1e-3, 1.0, 1e6])
def test_the_papers_optimum_is_closed(power_w: float) -> None:
    """The bound is within the gap above the value, and the leaves cover the box of the distance cut."""
    family = build_family(apply_overrides(load(PAPER), [f"jammers.M.power_w={power_w!r}"]))
    proof = proof_of(family, AxisField.free(), gap=1e-6)
    value = np.exp(proof.incumbent.log_value)
    assert proof.reason == ""
    assert value <= proof.upper_bound <= value * (1.0 + 1.001e-6)
    low, high = boxes(proof)
    whole = np.prod(high.max(axis=0) - low.min(axis=0))
    assert np.sum(np.prod(high - low, axis=1)) == pytest.approx(whole, rel=1e-9)


@pytest.mark.parametrize(("moved_m", "altitude_m"), diagonal([0.05, 3.0, 1e3], ["[8, 30]", "[9, 9]"]))
def test_leaves_of_another_proof_are_cut_and_added_to_until_they_cover(
    moved_m: float, altitude_m: str
) -> None:
    """A proof that begins with one of a scene near by or far away is about every position, and none twice."""
    family = build_family(apply_overrides(load(PAPER), [f"airspace.altitude_m={altitude_m}"]))
    points_m = family.ratios.points_m + moved_m * np.array(
        [[0.6, 0.8, 0.0], [0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]]
    )
    field, options = AxisField.free(), SolveOptions(gap=1e-4)
    moved = family.changed(points_m=points_m)
    last, found = proof_of(family, field, gap=1e-4), multistart(moved, field, seed=1)
    proof, alone = prove(moved, field, found, options, last=last), prove(moved, field, found, options)
    np.testing.assert_array_equal(proof.root, alone.root)
    assert proof.upper_bound == alone.upper_bound
    assert proof.reason == ""
    (low, high), sides = boxes(proof), np.ptp(proof.root, axis=0)
    solid = sides > 0.0
    assert np.sum(np.prod((high - low)[:, solid], axis=1)) == pytest.approx(np.prod(sides[solid]), rel=1e-6)
    rng = np.random.default_rng(6)
    for row in proof.leaves[rng.integers(len(proof.leaves), size=200)]:
        p = row[node.CENTRE : node.HALF] + rng.uniform(-1, 1, size=3) * row[node.HALF : node.LEVEL]
        assert value_at(moved, p) <= row[node.LEVEL] * (1.0 + 1e-12)


def test_no_pose_of_a_leaf_reaches_its_level(random_scene: Callable) -> None:
    """Positions drawn from the leaves, each with its exact best axis, stay below the level excluded there."""
    rng = np.random.default_rng(4)
    for n_nodes, n_jammers in ((1, 1), (2, 0), (3, 1), (5, 2), (8, 3)):
        family = build_family(random_scene(rng, n_nodes, n_jammers, 10.0))
        proof = proof_of(family, AxisField.free(), gap=1e-2)
        assert proof.reason == ""
        whole_sphere = proof.leaves[proof.leaves[:, node.FACE] < 0.0]
        chosen = whole_sphere[rng.integers(len(whole_sphere), size=200)]
        for row in chosen:
            p = row[node.CENTRE : node.HALF] + rng.uniform(-1, 1, size=3) * row[node.HALF : node.LEVEL]
            assert value_at(family, p) <= row[node.LEVEL] * (1.0 + 1e-12)


def test_no_search_beats_the_bound(random_scene: Callable) -> None:
    """An independent search from many starts never exceeds the bound."""
    rng = np.random.default_rng(5)
    for n_nodes in (2, 3, 5, 7):
        for n_jammers in (1, 3):
            family = build_family(random_scene(rng, n_nodes, n_jammers, 30.0))
            proof = proof_of(family, AxisField.free(), gap=1e-3)
            assert proof.reason == ""
            for seed in range(5):
                other = multistart(family, AxisField.free(), seed=100 + seed)
                assert np.exp(other.log_value) <= proof.upper_bound


def test_fixed_axes_are_closed() -> None:
    """Zero interference and the needle above the jammer are closed too, the needle at any strength."""
    for power_w in (0.1, 1e4):
        scenario = apply_overrides(load(PAPER), [f"jammers.M.power_w={power_w!r}"])
        family = build_family(scenario)
        fields = (
            AxisField.towards(scenario.jammer_positions_m[0]),
            AxisField.vertical(),
        )
        for axis_field in fields:
            proof = proof_of(family, axis_field, gap=1e-6)
            value = np.exp(proof.incumbent.log_value)
            assert proof.reason == ""
            assert proof.upper_bound <= value * (1.0 + 1.001e-6)


def test_a_limit_leaves_a_valid_bound(random_scene: Callable) -> None:
    """Stopped by a limit, the run says why and its bound still holds."""
    rng = np.random.default_rng(6)
    scenario: Scenario = random_scene(rng, 12, 3, 30.0)
    family = build_family(scenario)
    full = proof_of(family, AxisField.free(), gap=1e-2)
    short = proof_of(family, AxisField.free(), gap=1e-6, node_limit=300)
    assert "node limit" in short.reason
    assert short.upper_bound >= np.exp(full.incumbent.log_value)
    hasty = proof_of(family, AxisField.free(), gap=1e-8, time_limit_s=1e-3)
    assert "time limit" in hasty.reason
    assert hasty.upper_bound >= np.exp(full.incumbent.log_value)


def test_a_poor_incumbent_is_improved() -> None:
    """Started from a poor pose, the run finds the optimum on its own."""
    family = build_family(load(PAPER))
    best = multistart(family, AxisField.free(), seed=0)
    p, axis = np.array([20.0, 40.0, 20.0]), np.array([0.0, 0.0, 1.0])
    poor_value = log_objective(family.ratios, p, axis, np.empty(1), np.empty(2))
    poor = type(best)(
        position_m=p, axis=axis, log_value=poor_value, multipliers=np.full(2, 0.5), starts=0, evaluations=0
    )
    proof = prove(family, AxisField.free(), poor, SolveOptions(gap=1e-6))
    assert proof.reason == ""
    assert proof.incumbent.log_value == pytest.approx(best.log_value, rel=1e-6)


def test_progress_is_told(random_scene: Callable) -> None:
    """The gap proved never grows from one report to the next, and nodes only add up."""
    seen: list[tuple[float, int]] = []
    family = build_family(random_scene(np.random.default_rng(7), 6, 2, 30.0))
    found = multistart(family, AxisField.free(), seed=1)
    prove(
        family,
        AxisField.free(),
        found,
        SolveOptions(gap=1e-3, on_progress=lambda gap, n: seen.append((gap, n))),
    )
    gaps, nodes = zip(*seen, strict=True)
    assert list(nodes) == sorted(nodes)
    assert all(later <= earlier * (1 + 1e-9) for earlier, later in pairwise(gaps))


def test_stages_keep_the_multipliers(random_scene: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    """A leaf of one stage that distances exclude begins the next with multipliers of different ratios."""
    monkeypatch.setattr(import_module("nullpose.solver.proof"), "_TRIES", ((0.0, 10),))
    for seed in range(4):
        family = build_family(random_scene(np.random.default_rng(seed), 6, 2, 30.0))
        proof = proof_of(family, AxisField.free(), gap=1e-2)
        assert proof.reason == ""
        assert np.any(proof.leaves[:, node.KIND] == node.FAR)
        for row in proof.leaves:
            ratios = row[node.INDEX : node.INDEX + int(row[node.COUNT])]
            assert len(set(ratios)) == len(ratios)


@pytest.mark.parametrize("stages", [False, True])
def test_threads_change_nothing(
    random_scene: Callable, monkeypatch: pytest.MonkeyPatch, stages: bool
) -> None:
    """However many threads share the boxes of a try or a stage, these are the same, and so are the leaves."""
    family = build_family(random_scene(np.random.default_rng(3), 9, 2, 30.0))
    if stages:
        monkeypatch.setattr(import_module("nullpose.solver.proof"), "_TRIES", ((0.0, 50),))
    one, *others = (
        proof_of(family, AxisField.free(), gap=1e-5, node_limit=30_000, threads=threads)
        for threads in (1, 2, 7)
    )
    assert one.nodes > 5_000
    for other in others:
        assert (other.nodes, other.reason, other.upper_bound) == (one.nodes, one.reason, one.upper_bound)
        np.testing.assert_array_equal(other.incumbent.position_m, one.incumbent.position_m)
        np.testing.assert_array_equal(other.leaves, one.leaves)


def _scene_of_seed(seed: list[int]) -> dict[str, object]:
    rng = np.random.default_rng(seed)
    n_nodes, n_jammers = int(rng.integers(2, 7)), int(rng.integers(0, 4))
    nodes, jammers = (
        rng.uniform(0.0, [60.0, 60.0, 5.0], (count, 3)).tolist() for count in (n_nodes, n_jammers)
    )
    power_w = 10.0 ** rng.uniform(-2.0, 2.0) / n_jammers
    return {
        "nodes": [{"position_m": p, "power_w": float(10.0 ** rng.uniform(-0.5, 0.5))} for p in nodes],
        "jammers": [{"position_m": p, "power_w": power_w} for p in jammers],
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    }


@pytest.mark.parametrize(
    ("seed", "tilt_max_deg", "mount_deg"),
    [((2236, 29), 180.0, 0.0), ((3780, 18), 30.0, 90.0), ((3780, 15), 0.0, 45.0)],
)
def test_scenes_in_which_one_way_to_split_axes_has_no_end_are_closed(
    seed: tuple[int, int], tilt_max_deg: float, mount_deg: float
) -> None:
    """Two of these need axes split early, one late; the other way alone takes a million boxes or more."""
    airframe = {"tilt_max_deg": tilt_max_deg, "mount_deg": mount_deg}
    scenario = Scenario.from_dict(_scene_of_seed([777, *seed]) | {"airframe": airframe})
    result = solve(scenario, gap=1e-3, node_limit=150_000)
    assert result.status == "certified"


@pytest.mark.parametrize("gap", [3e-2, pytest.param(4e-3, marks=pytest.mark.slow)])
@pytest.mark.parametrize("tilt_max_deg", [0.0, 3.0])
def test_vehicles_that_tilt_little_are_certified(scene: Callable, tilt_max_deg: float, gap: float) -> None:
    """Their axes are a cone or a narrow band, of which many cells hold no more than a tip."""
    places_m = np.column_stack([np.random.default_rng(7).uniform(0.0, 100.0, (13, 2)), np.zeros(13)])
    scenario = scene(places_m[:10], places_m[10:], jammer_powers_w=3.0)
    airframe = Airframe(tilt_max_deg=tilt_max_deg, mount_deg=45.0)
    result = solve(scenario.model_copy(update={"airframe": airframe}), gap=gap, node_limit=400_000)
    assert result.status == "certified"
