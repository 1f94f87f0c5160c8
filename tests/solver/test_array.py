"""Solving for an array: what it reports, what it must agree with, and what it refuses."""

import json
import math
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import differential_evolution

import nullpose
from nullpose.errors import SolveError, UsageError
from nullpose.physics.array import beam_sinr, digital_sinr, element_positions
from nullpose.scenario import Array, Scenario
from nullpose.solver import Result, Status, solve
from nullpose.solver.array_task import ArrayTask

EXAMPLES = Path(__file__).parents[2] / "examples"


def with_array(scenario: Scenario, elements: int, layout: str = "linear", spacing: float = 0.5) -> Scenario:
    """The scenario with an array, of half-wave spacing in a row unless stated otherwise."""
    array = Array(elements=elements, layout=layout, spacing_wavelengths=spacing)
    return scenario.model_copy(update={"array": array})


@pytest.fixture(scope="module")
def solution(random_scene: Callable) -> Result:
    """One scene solved."""
    scenario = random_scene(np.random.default_rng(11), 3, 2, 10.0)
    return solve(with_array(scenario, 4))


def test_the_links_are_those_of_pose_and_weights(solution: Result) -> None:
    """The SINRs follow from the reported position, yaw and weights by the plain equation."""
    places = element_positions(4, "linear", 0.5, solution.pose.yaw_rad)
    expected = beam_sinr(solution.scenario, solution.pose.position_m, places, solution.details.weights)
    np.testing.assert_allclose([link.sinr for link in solution.links], expected, rtol=1e-9)
    assert [link.node for link in solution.links] == list(solution.scenario.node_names)
    assert solution.objective.value == min(link.sinr for link in solution.links)
    assert solution.objective.value_db == pytest.approx(10.0 * math.log10(solution.objective.value))
    assert solution.objective.value <= solution.objective.upper_bound
    assert solution.objective.relative_gap == pytest.approx(
        solution.objective.upper_bound / solution.objective.value - 1.0, abs=1e-12
    )
    assert (solution.pose.roll_rad, solution.pose.pitch_rad) == (0.0, 0.0)
    assert -math.pi <= solution.pose.yaw_rad <= math.pi
    np.testing.assert_allclose(np.linalg.norm(solution.details.weights, axis=-1), 1.0, rtol=1e-12)


def test_solutions_are_plain_data(solution: Result) -> None:
    """A solution survives pickling, turns into JSON, and refuses to be written to."""
    assert (solution.scheme, solution.label) == ("array-digital", "array of 4, digital")
    data = json.loads(json.dumps(solution.to_dict(), allow_nan=False))
    assert (data["scheme"], data["array"]["combining"]) == ("array-digital", "digital")
    assert data["objective"]["value"] == solution.objective.value
    assert data["stats"]["searches"] >= data["stats"]["agreeing"] >= 1
    weights = np.array(data["array"]["weights"]) @ [1.0, 1.0j]
    np.testing.assert_array_equal(weights, solution.details.weights)
    assert Scenario.from_dict(data["scenario"]) == solution.scenario
    again = pickle.loads(pickle.dumps(solution))
    assert again.to_dict() == solution.to_dict()
    with pytest.raises(ValueError, match="read-only"):
        solution.details.weights[0] = 1.0


@pytest.mark.parametrize("ratio", [0.01, 100.0])
def test_one_element_is_the_vertical_case(ratio: float, paper: Callable) -> None:
    """One dipole gives what the certified vertical case gives, within its gap."""
    vertical = solve(paper(ratio), "vertical")
    alone = solve(with_array(paper(ratio), 1))
    assert alone.objective.value == pytest.approx(vertical.objective.value, rel=2e-6)
    assert alone.status is Status.CERTIFIED


def test_without_jammers_the_elements_add_up(paper: Callable) -> None:
    """K elements and no jammer give K times the vertical case, which is the bound."""
    silent = paper(1.0).model_copy(update={"jammers": ()})
    vertical = solve(silent, "vertical")
    array = solve(with_array(silent, 6, "circular", 0.4))
    assert array.objective.value == pytest.approx(6.0 * vertical.objective.value, rel=3e-6)
    assert array.status is Status.CERTIFIED


def test_more_elements_are_never_worse(random_scene: Callable) -> None:
    """A longer row holds the shorter ones, so nothing is lost by it."""
    scenario = random_scene(np.random.default_rng(12), 3, 2, 10.0)
    values = [solve(with_array(scenario, elements)).objective.value for elements in (1, 2, 4)]
    assert np.all(np.diff(values) >= -1e-6)
    assert values[-1] > 2.0 * values[0]


def test_without_proof_it_is_the_best_found(paper: Callable) -> None:
    """Without a proof there is no bound, several searches agree, and the value is the same."""
    proved, found = (solve(with_array(paper(1.0), 2), certify=certify) for certify in (True, False))
    assert found.status is Status.BEST_FOUND
    assert found.objective.upper_bound is found.objective.relative_gap is None
    assert (found.stats.boxes, found.reason) == (0, "")
    assert found.stats.agreeing == 3
    assert found.objective.value == pytest.approx(proved.objective.value, rel=1e-6)


@pytest.mark.parametrize("jamming_w", [1.0, 30.0])
@pytest.mark.parametrize("layout", ["linear", "circular"])
def test_digital_combining_is_certified(layout: str, jamming_w: float, random_scene: Callable) -> None:
    """In small scenes the gap asked for is reached, and a wider one takes no more boxes."""
    rng = np.random.default_rng(int(jamming_w))
    for _ in range(2):
        scenario = random_scene(rng, 3, 2, jamming_w)
        close, wide = (solve(with_array(scenario, 3, layout), gap=gap) for gap in (1e-6, 1e-2))
        assert close.status is wide.status is Status.CERTIFIED
        assert close.objective.relative_gap <= 1e-6
        assert wide.stats.boxes <= close.stats.boxes
        assert wide.objective.value <= close.objective.upper_bound


def test_another_optimiser_finds_nothing_better(random_scene: Callable) -> None:
    """Differential evolution over position and yaw does not exceed it, and comes close."""
    scenario = random_scene(np.random.default_rng(13), 3, 1, 10.0)
    solution = solve(with_array(scenario, 3))
    task = ArrayTask.of(scenario, with_array(scenario, 3).array)
    sides = list(zip(*task.reach(math.log(solution.objective.value)), strict=True))

    def cost(state: np.ndarray) -> float:
        position_m = np.ascontiguousarray(state[:3])
        if np.any(task.walls(position_m)[0] < 0.0):
            return 1e3
        return min(-task.value(np.ascontiguousarray(state)), 1e3)

    other = differential_evolution(
        cost, [*sides, (-math.pi, math.pi)], seed=0, maxiter=150, popsize=12, tol=1e-8
    )
    assert -other.fun <= math.log(solution.objective.value) + 1e-7
    assert -other.fun >= math.log(solution.objective.value) - 0.3


def test_seeds_repeat_and_agree(random_scene: Callable) -> None:
    """A seed repeats to the last bit; another seed comes to the same value."""
    scenario = random_scene(np.random.default_rng(14), 3, 2, 10.0)
    first, again, other = (solve(with_array(scenario, 3), seed=seed) for seed in (0, 0, 1))
    np.testing.assert_array_equal(first.pose.position_m, again.pose.position_m)
    np.testing.assert_array_equal(first.details.weights, again.details.weights)
    assert first.objective == again.objective
    assert other.objective.value == pytest.approx(first.objective.value, rel=1e-4)


def test_the_airspace_is_kept(paper: Callable) -> None:
    """Bounds, zones, fence and keep-out balls hold, and a zone on the optimum costs something."""
    free = solve(with_array(paper(10.0), 3))
    drum = {"centre_m": tuple(free.pose.position_m[:2]), "radius_m": 9.0}
    fence = [(-30.0, -10.0), (40.0, -10.0), (40.0, 60.0), (-30.0, 60.0)]
    tight = paper(10.0, no_fly=(drum,), geofence_m=fence, keep_out_m=15.0, altitude_m=(8.0, 20.0))
    solution = solve(with_array(tight, 3))
    points_m = np.vstack([tight.node_positions_m, tight.jammer_positions_m])
    assert tight.airspace.allows(solution.pose.position_m)
    assert np.min(np.linalg.norm(points_m - solution.pose.position_m, axis=1)) >= 15.0
    assert solution.objective.value < free.objective.value


def test_requirements_are_margins(paper: Callable) -> None:
    """The smallest margin is maximised: asking all for twice as much halves it, asking one moves the pose."""
    plain = solve(with_array(paper(1.0), 2))

    def asking(first: float, second: float) -> Scenario:
        nodes = [
            node.model_copy(update={"weight": weight})
            for node, weight in zip(paper(1.0).nodes, (first, second), strict=True)
        ]
        return paper(1.0).model_copy(update={"nodes": tuple(nodes)})

    both = solve(with_array(asking(2.0, 2.0), 2))
    assert both.objective.name == "min_margin"
    assert both.objective.value == pytest.approx(0.5 * plain.objective.value, rel=1e-6)
    assert both.objective.upper_bound == pytest.approx(0.5 * plain.objective.upper_bound, rel=1e-4)
    one = solve(with_array(asking(1.0, 5.0), 2))
    assert one.links[1].sinr > plain.links[1].sinr > one.links[0].sinr
    assert one.objective.value == min(one.links[0].sinr, one.links[1].sinr / 5.0)
    assert one.binding_node in one.scenario.node_names


def test_layout_and_spacing_are_the_scenarios(paper: Callable) -> None:
    """The SINRs are those of the elements where the scenario has them."""
    solution = solve(with_array(paper(1.0), 2, "circular", 0.3))
    places = element_positions(2, "circular", 0.3, solution.pose.yaw_rad)
    expected = digital_sinr(solution.scenario, solution.pose.position_m, places)
    np.testing.assert_allclose([link.sinr for link in solution.links], expected, rtol=1e-9)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"seed": -1}, "seed: given -1"),
        ({"gap": 0.0}, "gap: given 0.0"),
        ({"scheme": "vertical"}, r"scheme vertical for a scenario with an \[array\]"),
        ({"null_jammer": "M"}, r"null jammer 'M' for a scenario with an \[array\]"),
        ({"robust": True}, "array: guarantees are for one dipole"),
    ],
)
def test_bad_requests_are_refused(options: dict, message: str, paper: Callable) -> None:
    """Options that are wrong, or that arrays do not have."""
    with pytest.raises(UsageError, match=message):
        solve(with_array(paper(1.0), 2), **options)


def test_other_objectives_are_refused() -> None:
    """An array listens; a scenario that asks for a secrecy rate is told so."""
    secret = nullpose.load(EXAMPLES / "eavesdropper.toml")
    with pytest.raises(UsageError, match="secrecy-rate"):
        solve(with_array(secret, 2))


def test_a_scene_without_an_answer_is_said(scene: Callable) -> None:
    """Where the only position has the node in every dipole's null, that is said."""
    point = scene([(0, 0, 0)], x_m=(0.0, 0.0), y_m=(0.0, 0.0), altitude_m=(8.0, 8.0))
    with pytest.raises(SolveError, match="widen the airspace"):
        solve(with_array(point, 2))
