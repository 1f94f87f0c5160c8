"""What nodes require under a sum or a mean: every pose meets it, and the bound is of those that do."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from benchmarks.soundness.check import check_scene
from benchmarks.soundness.features import make_feature_scene
from sizes import and_slow

from nullpose.certificate import verify
from nullpose.errors import RequirementError, ScenarioError, SolveError
from nullpose.physics import allowed_value, objective_value
from nullpose.problem.schemes import RECORDS
from nullpose.scenario import Scenario, apply_overrides, load
from nullpose.solver import compare, solve
from nullpose.solver.certificate_from_proof import certificate_of
from nullpose.study import compare_schemes

MEANS = ("sum-rate", "proportional-fair")


def demanding(
    objective: str, *required_db: float | None, weights: tuple[float, ...] = (1.0, 1.0)
) -> Scenario:
    """Return the paper's scene in which nodes require so much."""
    table = load("examples/paper.toml").to_dict() | {"objective": objective}
    for node, weight, least_db in zip(table["nodes"], weights, required_db, strict=True):
        node |= {} if least_db is None else {"min_sinr_db": least_db}
        node |= {} if weight == 1.0 else {"weight": weight}
    return Scenario.from_dict(table)


@pytest.mark.parametrize("required_db", [(0.0, 0.0), (-1.0, 0.5), (None, 0.0), (2.0, -6.0)])
@pytest.mark.parametrize("objective", MEANS)
def test_requirements_are_met_and_bound_only_what_meets_them(
    objective: str, required_db: tuple[float | None, float | None]
) -> None:
    """The answer meets them, and no pose of a fine grid that does has more than the bound."""
    scenario = demanding(objective, *required_db)
    solution = solve(scenario, gap=1e-3)
    assert solution.status == "certified"
    assert verify(certificate_of(solution)).proved
    for link, least_db in zip(solution.links, required_db, strict=True):
        assert least_db is None or link.sinr_db >= least_db - 1e-9
    x, y, z = np.meshgrid(np.arange(-6.0, 14.0, 0.5), np.arange(-4.0, 54.0, 0.5), [8.0, 9.0])
    places = np.stack([x, y, z], axis=-1).reshape(-1, 1, 3)
    rng = np.random.default_rng(1)
    axes = rng.normal(size=(200, 3))
    axes = np.vstack([axes / np.linalg.norm(axes, axis=1, keepdims=True), solution.pose.antenna_axis])
    assert np.max(allowed_value(scenario, places, axes)) <= solution.objective.upper_bound


@pytest.mark.parametrize("objective", MEANS)
def test_requirements_that_do_not_bind_change_nothing(objective: str) -> None:
    """Far below what the nodes have at the optimum, they leave the value as it is."""
    free, bound = (solve(demanding(objective, *each), gap=1e-4) for each in ((None, None), (-30.0, -25.0)))
    assert bound.objective.value == pytest.approx(free.objective.value, rel=1e-9)


@pytest.mark.parametrize("objective", MEANS)
def test_what_the_worst_node_can_have_is_never_refused(objective: str) -> None:
    """Up to the largest smallest SINR, less its gap, a requirement of all nodes is met; above it is not."""
    least_db = 10.0 * np.log10(solve(load("examples/paper.toml"), gap=1e-6).objective.value)
    for short_db in (1e-3, 0.1, 1.0):
        solution = solve(demanding(objective, *[least_db - short_db] * 2), certify=False)
        assert min(link.sinr_db for link in solution.links) >= least_db - short_db - 1e-9
    words = r"^nodes.min_sinr_db: no pose .*misses one by 0.(09|1)\d* dB, and proved: .* by 0.09"
    with pytest.raises(SolveError, match=words):
        solve(demanding(objective, *[least_db + 0.1] * 2), gap=1e-4)


@pytest.mark.parametrize("objective", MEANS)
def test_a_stricter_requirement_never_gives_more(objective: str) -> None:
    """The value falls as the requirement of one node rises."""
    values = [solve(demanding(objective, None, each), gap=1e-4).objective for each in (-20.0, -5.0, 0.0, 1.0)]
    for weak, strict in pairwise(values):
        assert strict.value <= weak.upper_bound


def test_weights_and_requirements_go_together_under_a_mean_alone() -> None:
    """A node may have both where a sum is maximised, and one of them where the smallest is."""
    both = demanding("sum-rate", 0.0, None, weights=(1.0, 3.0))
    both = apply_overrides(both, ["nodes.S1.weight=2"])
    assert (both.nodes[0].weight, both.nodes[0].min_sinr_db) == (2.0, 0.0)
    with pytest.raises(ScenarioError, match=r"nodes\[0\]: both weight and min_sinr_db are given"):
        apply_overrides(both, ["objective=min-sinr"])


@pytest.mark.parametrize("scheme", ["vertical", "zero-interference", "maximum-gain"])
@pytest.mark.parametrize("objective", MEANS)
def test_axes_that_a_position_gives_meet_requirements(objective: str, scheme: str) -> None:
    """Where the scheme can meet them it does, and the certificate verifies."""
    free = solve(demanding(objective, None, None), scheme)
    weakest = min(free.links, key=lambda link: link.sinr_db)
    required_db = [weakest.sinr_db + 1.0 if link.node == weakest.node else None for link in free.links]
    solution = solve(demanding(objective, *required_db), scheme, gap=1e-2)
    assert solution.objective.value <= free.objective.value * (1.0 + 1e-9)
    for link, least_db in zip(solution.links, required_db, strict=True):
        assert least_db is None or link.sinr_db >= least_db - 1e-9
    assert verify(certificate_of(solution)).proved


def test_a_comparison_leaves_out_schemes_that_miss_a_requirement() -> None:
    """The schemes that meet it are compared, and of the others it is said by how much they miss it."""
    scenario = demanding("sum-rate", 0.0, 0.0)
    table, results = compare_schemes(scenario, gap=1e-3), compare(scenario, gap=1e-3)
    assert {row.name for row in table.rows} | table.left_out.keys() == set(RECORDS)
    assert [row.name for row in table.rows] == [result.scheme for result in results]
    assert "optimum" in {row.name for row in table.rows}
    assert "misses one by 0.69" in table.left_out["maximum-gain"]
    for called in (compare, compare_schemes):
        with pytest.raises(RequirementError):
            called(demanding("sum-rate", 5.0, 5.0), gap=1e-3)


@pytest.mark.parametrize("number", and_slow([0], range(1, 8)))
@pytest.mark.parametrize("objective", MEANS)
def test_random_scenes_withstand_a_search(objective: str, number: int) -> None:
    """No independent search among the poses that meet them finds more than the bound."""
    scenes = (make_feature_scene(objective, each) for each in range(200))
    some = [scene for scene in scenes if any(node.min_sinr_db is not None for node in scene.scenario.nodes)]
    assert check_scene(some[number], starts=60).faults == ()


def test_other_requirements_are_rejected() -> None:
    """A certificate proves nothing about weaker requirements, and nothing with a multiplier left out."""
    certificate = certificate_of(solve(demanding("sum-rate", 0.0, 0.0), gap=1e-3))
    assert verify(certificate).proved
    for least_db in (None, -0.01):
        nodes = certificate.scenario.nodes
        weaker = (nodes[0], nodes[1].model_copy(update={"min_sinr_db": least_db}))
        changed = certificate.scenario.model_copy(update={"nodes": weaker})
        assert not verify(replace(certificate, scenario=changed)).proved
    tree = certificate.trees[0]
    for factor in (0.0, 2.0):
        mixes = tuple(
            {k: w * (factor if k >= 2 else 1.0) for k, w in mix.items()} for mix in tree.leaves.mixes
        )
        other = replace(tree, leaves=replace(tree.leaves, mixes=mixes))
        assert not verify(replace(certificate, trees=(other,))).proved
    mixes = tuple({**mix, 3: -0.1} for mix in tree.leaves.mixes)
    assert (
        "negative"
        in verify(
            replace(certificate, trees=(replace(tree, leaves=replace(tree.leaves, mixes=mixes)),))
        ).message
    )
    value = objective_value(certificate.scenario, certificate.position_m, [0.0, 0.0, 1.0])
    assert value != certificate.value
