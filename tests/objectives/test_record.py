"""Every objective's record: its ratios are what the physics evaluates."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from benchmarks.soundness.check import check_scene
from benchmarks.soundness.features import make_feature_scene
from hypothesis import given, strategies as st
from sizes import and_slow

from nullpose.certificate import Certificate, verify
from nullpose.channel.elevation import AVERAGES, elevation_excess
from nullpose.channel.model import BY_DISTANCE, BY_ELEVATION, CONSTANT
from nullpose.channel.power_law import distance_excess
from nullpose.errors import UsageError
from nullpose.objectives import RECORDS, USUAL, Quantity
from nullpose.physics import Pose, evaluate, objective_of_links, objective_value
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario, load
from nullpose.solver import ErrorSizes, sensitivity, solve, solve_many
from nullpose.solver.certificate_from_proof import certificate_of

EXCESS = {CONSTANT: lambda *_: 1.0, BY_DISTANCE: distance_excess, BY_ELEVATION: elevation_excess}


def _scenario(name: str, rng: np.random.Generator) -> Scenario:
    def spot() -> list[float]:
        return [*map(float, rng.uniform(-80.0, 80.0, 2)), 0.0]

    record = RECORDS[name]
    data = {
        "objective": name,
        "airspace": {"altitude_m": [10.0, 60.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": float(rng.uniform(-3.0, 3.0))},
        "nodes": [{"position_m": spot(), "power_w": float(rng.uniform(0.5, 2.0))} for _ in range(3)],
        "jammers": [{"position_m": spot(), "power_w": float(rng.uniform(0.1, 9.0))} for _ in range(2)],
    }
    if "nodes.weight" not in record.unused:
        data["nodes"][0]["weight"] = 2.5
    if not {"nodes.weight", "nodes.min_sinr_db"} & set(record.unused):
        data["nodes"][1]["min_sinr_db"] = -4.0
    if "nodes.noise" not in record.unused:
        data["nodes"][0]["noise_dbm"], data["nodes"][1]["jamming_dbm"] = -5.0, -3.0
    more = {
        "transmitter": {"power_w": 1.0},
        "eavesdroppers": [{"position_m": spot()} for _ in range(2)],
        "destination": {"position_m": spot(), "noise_dbm": -2.0, "weight": 1.5},
    }
    if "sources" in record.needs:
        more["sources"] = [{"position_m": spot(), "power_w": float(rng.uniform(0.5, 2.0))} for _ in range(3)]
        for node in data["nodes"]:
            node["from"] = f"A{rng.integers(1, 4)}"
        data["airspace"] |= {"x_m": [-99.0, 99.0], "y_m": [-99.0, 99.0]}
    data |= {key: more[key] for key in record.needs if key in more}
    channels = [{"model": "power-law", "exponent": float(rng.uniform(1.6, 4.0))}]
    channels += [{"model": "elevation", "environment": "urban", "average": each} for each in AVERAGES]
    channels += [channels[1] | channels[0] | {"model": "elevation"}]
    data["channel"] = channels[rng.integers(len(channels))]
    data["nodes"][2]["channel"] = "free-space"
    if record.interferers in data:
        data[record.interferers][1]["channel"] = "free-space"
    return Scenario.from_dict(data)


@pytest.mark.parametrize("name", RECORDS)
@given(seed=st.integers(0, 2**32 - 1))
def test_smallest_or_mean_ratio_is_the_value_of_the_physics(name: str, seed: int) -> None:
    """Numerators over denominators, summed from the arrays, give the number that the physics evaluates."""
    rng = np.random.default_rng(seed)
    scenario = _scenario(name, rng)
    ratios = RECORDS[name].ratios(scenario)
    pose = Pose(rng.uniform([-90.0, -90.0, 20.0], [90.0, 90.0, 50.0]), *rng.uniform(-1.0, 1.0, 3))
    away = ratios.points_m - pose.position_m
    squared = np.sum(away**2, axis=1)
    link = 1.0 / squared - (away @ pose.antenna_axis) ** 2 / squared**2
    for j, row in enumerate(ratios.channels):
        seen_rad = np.arcsin(-away[j, 2] / np.sqrt(squared[j]))
        link[j] *= EXCESS[int(row[0])](row, np.sqrt(squared[j]), seen_rad, 0.0)
    leaks = ratios.denominator_weight * link[ratios.denominator_point]
    sums = np.append(0.0, np.cumsum(leaks))[ratios.denominator_start]
    below = ratios.denominator_isotropic + np.diff(sums)
    above = ratios.numerator_isotropic + ratios.numerator_weight * link[ratios.numerator_point]
    each = above / below[ratios.denominator_of]
    each = each[ratios.pairs[:, 0]] / each[ratios.pairs[:, 1]] if len(ratios.pairs) else each
    offset = RECORDS[name].mean_offset
    assert offset in (None, 0.0, 1.0), "the kernels know no other"
    ratio = float(np.min(each) if offset is None else np.prod((offset + each) ** scenario.node_shares))
    quantity = Quantity.of(scenario)
    value = float(objective_value(scenario, pose.position_m, pose.antenna_axis))
    assert quantity.of_ratio(ratio) == pytest.approx(value, rel=1e-9, abs=1e-12)
    assert objective_of_links(scenario, evaluate(scenario, pose)) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("name", RECORDS)
def test_a_proof_knows_all_points_and_a_mean_one_denominator(name: str) -> None:
    """The drone keeps clear of every point, of those in no ratio, too; no mean is proved with more."""
    scenario = _scenario(name, np.random.default_rng(7))
    ratios = RECORDS[name].ratios(scenario)
    assert {*map(tuple, ratios.points_m)} == {point.position_m for point in scenario.points}
    if RECORDS[name].mean_offset is not None:
        assert len(ratios.denominator_isotropic) == 1


def test_names_are_told_apart() -> None:
    """No two quantities share a name."""
    quantities = {one for record in RECORDS.values() for one in record.quantities}
    assert len({one.name for one in quantities}) == len(quantities)
    assert USUAL in RECORDS


@pytest.mark.parametrize("quantity", [one for record in RECORDS.values() for one in record.quantities])
@given(value=st.floats(1e-6, 1e6), more=st.floats(0.0, 10.0))
def test_gap_is_relative(quantity: Quantity, value: float, more: float) -> None:
    """The gap of a bound is its distance from the value over the value."""
    least = max(value, 1e-3)
    assert quantity.gap(least, least * (1.0 + more)) == pytest.approx(more, abs=1e-9)


MEANS = ("sum-rate", "proportional-fair")

F3 = {
    "nodes": [(12.5, 39.7, 0.0), (27.6, -27.5, 0.0), (-20.0, 37.4, 0.0)],
    "jammers": [((-49.5, 32.1, 0.0), 10.0)],
}

# found by a search of its own: mean rate in bits/s/Hz and mean dB, by the paper's P_M / P, or of the field F3
KNOWN = {
    0.01: (2.261992998, 3.955433734),
    1.0: (2.174098284, 3.174545360),
    100.0: (2.165113462, 2.986445392),
    "F3": (1.483265956, -1.128442383),
}


def paper(objective: str, power_w: float = 1.0, **tables: Any) -> Scenario:
    """Return the paper's scene under an objective, with other tables."""
    data = load("examples/paper.toml").to_dict() | {"objective": objective} | tables
    if data["jammers"]:
        data["jammers"] = [data["jammers"][0] | {"power_w": power_w}]
    return Scenario.from_dict(data)


def field(objective: str) -> Scenario:
    """Return F3: three nodes and a jammer in a field."""
    return Scenario.from_dict(
        {
            "objective": objective,
            "airspace": {"altitude_m": [8.0, 30.0], "x_m": [-150.0, 150.0], "y_m": [-150.0, 150.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [{"position_m": p, "power_w": 1.0} for p in F3["nodes"]],
            "jammers": [{"position_m": p, "power_w": w} for p, w in F3["jammers"]],
        }
    )


@pytest.mark.parametrize("case", and_slow([1.0, "F3"], [0.01, 100.0]))
@pytest.mark.parametrize("objective", MEANS)
def test_known_answers(objective: str, case: float | str) -> None:
    """The values of a search of its own are reached to 1e-8, certified and verified."""
    scenario = field(objective) if isinstance(case, str) else paper(objective, case)
    solution = solve(scenario, gap=1e-4)
    rate, mean_db = KNOWN[case]
    best = solve(scenario, gap=1e-6).objective  # of which the search alone is sure of 1e-8
    known = rate * len(scenario.nodes) if objective == "sum-rate" else 10.0 ** (0.1 * mean_db)
    assert max(best.value, solution.objective.value) == pytest.approx(known, rel=1e-8)
    assert solution.status == "certified"
    assert solution.objective.upper_bound is not None
    assert solution.objective.upper_bound >= known * (1.0 - 1e-8)
    assert verify(certificate_of(solution)).proved


def test_one_node_has_the_rate_of_its_best_sinr() -> None:
    """With one node the sum is the rate of the largest SINR, and the mean is that SINR."""
    one = load("examples/paper.toml").to_dict()["nodes"][:1]
    least = solve(paper("min-sinr", nodes=one)).objective
    rate, mean = (solve(paper(objective, nodes=one)).objective for objective in MEANS)
    assert rate.value == pytest.approx(np.log2(1.0 + least.value), rel=2e-6)
    assert mean.value == pytest.approx(least.value, rel=2e-6)


def test_nodes_that_are_alike_by_symmetry_have_one_value() -> None:
    """Where the best pose gives all nodes one SINR, the mean is the smallest and the sum so many rates."""
    nodes = [{"position_m": [east, 0.0, 0.0], "power_w": 1.0} for east in (-2.0, 2.0)]
    least, rate, mean = (
        solve(paper(objective, nodes=nodes, jammers=[])).objective.value for objective in ("min-sinr", *MEANS)
    )
    assert mean == pytest.approx(least, rel=2e-6)
    assert rate == pytest.approx(2.0 * np.log2(1.0 + least), rel=2e-6)


@pytest.mark.parametrize("factor", and_slow([1e-6], [0.2, 1e6]))
@pytest.mark.parametrize("objective", MEANS)
def test_weights_count_by_their_shares(objective: str, factor: float) -> None:
    """All weights times one factor leave pose and mean as they are, and multiply a sum."""
    nodes = load("examples/paper.toml").to_dict()["nodes"]
    first, second = (
        solve(paper(objective, nodes=[nodes[0] | {"weight": 2.0 * each}, nodes[1] | {"weight": each}]))
        for each in (1.0, factor)
    )
    np.testing.assert_allclose(second.pose.position_m, first.pose.position_m, atol=1e-6)
    np.testing.assert_allclose(second.pose.antenna_axis, first.pose.antenna_axis, atol=1e-6)
    scale = factor if objective == "sum-rate" else 1.0
    assert second.objective.value == pytest.approx(scale * first.objective.value, rel=1e-9)
    assert second.status == "certified"


def test_no_optimum_is_beaten_at_its_own_objective() -> None:
    """At the pose that is best for one objective no other has more than at its own."""
    scenes = [field(objective) for objective in ("min-sinr", *MEANS)]
    solutions = [solve(scenario) for scenario in scenes]
    for scenario, solution in zip(scenes, solutions, strict=True):
        for other in solutions:
            value = objective_value(scenario, other.pose.position_m, other.pose.antenna_axis)
            assert value <= solution.objective.upper_bound


@pytest.mark.parametrize("number", [1, 4])
@pytest.mark.parametrize("objective", MEANS)
def test_value_is_that_of_the_pose(objective: str, number: int) -> None:
    """The value is what the equation gives for the links of the reported pose."""
    scenario = make_feature_scene(objective, number).scenario
    solution = solve(scenario, certify=False)
    sinr = np.array([link.sinr for link in evaluate(scenario, solution.pose)])
    weights = np.array([node.weight or 1.0 for node in scenario.nodes])
    value = objective_value(scenario, solution.pose.position_m, solution.pose.antenna_axis)
    assert solution.objective.value == value
    expected = weights @ np.log2(1.0 + sinr)
    if objective == "proportional-fair":
        expected = 10.0 ** (0.1 * np.average(10.0 * np.log10(sinr), weights=weights))
    assert value == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("number", and_slow([0], range(1, 6)))
@pytest.mark.parametrize("objective", MEANS)
def test_random_scenes_withstand_a_search(objective: str, number: int) -> None:
    """No independent search finds more than the bound, the pose has its value, the verifier agrees."""
    assert check_scene(make_feature_scene(objective, number), starts=60).faults == ()


@pytest.fixture(scope="module", params=MEANS)
def certificate(request: pytest.FixtureRequest) -> Certificate:
    """A certificate of F3 with one weight, near which no other claim is true."""
    scenario = field(request.param)
    nodes = (scenario.nodes[0].model_copy(update={"weight": 1.5}), *scenario.nodes[1:])
    return certificate_of(solve(scenario.model_copy(update={"nodes": nodes}), gap=1e-3))


def _leaves(certificate: Certificate, **columns: Any) -> Certificate:
    tree = certificate.trees[0]
    changed = replace(tree, leaves=replace(tree.leaves, **columns))
    return replace(certificate, trees=(changed, *certificate.trees[1:]))


def test_other_claims_are_rejected(certificate: Certificate) -> None:
    """A certificate proves neither another objective nor other weights, nor a lower bound."""
    assert verify(certificate).proved
    others = {"min-sinr", *MEANS} - {certificate.scenario.objective}
    changes: list[dict[str, Any]] = [{"objective": other} for other in sorted(others)]
    nodes = certificate.scenario.nodes
    for index, weight in ((0, 1.51), (1, 0.9), (2, 30.0)):
        heavier = nodes[index].model_copy(update={"weight": weight})
        changes.append({"nodes": (*nodes[:index], heavier, *nodes[index + 1 :])})
    for change in changes:
        changed = certificate.scenario.model_copy(update=change)
        assert not verify(replace(certificate, scenario=changed)).proved, change
    between = certificate.value + np.array([0.0, 0.5, 0.99]) * (certificate.upper_bound - certificate.value)
    for bound in between:
        assert not verify(replace(certificate, upper_bound=float(bound))).proved


def test_lower_levels_and_other_multipliers_are_rejected(certificate: Certificate) -> None:
    """Leaves near the optimum hold at their level with their multipliers, and not below it or with others."""
    leaves = certificate.trees[0].leaves
    assert not verify(_leaves(certificate, level=leaves.level * 0.999)).proved
    used = [index for index, mix in enumerate(leaves.mixes) if mix]
    for ratio, factor in ((1, 2.0), (2, 0.0)):
        mixes = list(leaves.mixes)
        for index in used:
            mixes[index] = {k: q * (factor if k == ratio else 1.0) for k, q in mixes[index].items()}
        assert not verify(_leaves(certificate, mixes=tuple(mixes))).proved


@pytest.mark.parametrize("objective", MEANS)
def test_errors_are_searched_on_the_sum_or_mean(objective: str) -> None:
    """If nothing is off nothing is lost; what is lost is found at a pose that gives the value."""
    scenario, pose = paper(objective), Pose([0.0, 20.0, 9.0], 0.4, -1.2)
    value = float(objective_value(scenario, pose.position_m, pose.antenna_axis))
    found = sensitivity(scenario, pose, ErrorSizes(attitude_deg=0.0, position_m=0.5, jammers_m=0.0))
    assert [found.nominal, found.attitude, found.jammers] == pytest.approx([value] * 3, rel=1e-12)
    assert found.all < value
    rng = np.random.default_rng(1)
    offsets = rng.normal(size=(500, 3))
    offsets *= 0.5 / np.linalg.norm(offsets, axis=1, keepdims=True)
    moved = objective_value(scenario, pose.position_m + offsets, pose.antenna_axis)
    assert found.position <= np.min(moved) * (1.0 + 1e-9)
    assert found.position == pytest.approx(np.min(moved), rel=1e-2)


@pytest.mark.parametrize("objective", MEANS)
def test_what_does_not_know_them_says_so(objective: str) -> None:
    """Robust poses and solve_many refuse a sum or a mean by its path; no node of a result binds."""
    scenario = paper(objective)
    with pytest.raises(UsageError, match=f'^objective: given "{objective}"'):
        solve(scenario, robust=True)
    with pytest.raises(UsageError, match=r"^scenarios\[0\]: asks for the (sum rate|mean SINR)"):
        solve_many([scenario])
    with pytest.raises(UsageError, match=f'^objective: given "{objective}"'):
        build_family(scenario)
    assert solve(scenario, certify=False).binding_node is None
