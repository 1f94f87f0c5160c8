"""Solving for an array: what it reports, what it must agree with, and what it refuses."""

import json
import math
import pickle
from collections.abc import Callable

import numpy as np
import pytest
from array_beams import beam_sinr
from scipy.optimize import differential_evolution
from sizes import and_slow, diagonal

import nullpose
from nullpose.errors import SolveError, UsageError
from nullpose.physics.array import digital_sinr, element_positions
from nullpose.problem.build import build_family
from nullpose.scenario import Array, Scenario
from nullpose.solver import Result, Status, solve
from nullpose.solver.array import array_bound
from nullpose.solver.array_search import ArraySearch
from nullpose.solver.kernels.search.domain import walls
from scenes import EXAMPLES


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


@pytest.mark.parametrize("elements", [1, 2])
def test_the_null_above_a_strong_jammer_is_found(elements: int, scene: Callable) -> None:
    """Where the best place of a vertical dipole is a needle above a strong jammer, an array has no less."""
    field = scene(
        [(-18.8, -36.8, 0.0), (7.6, 24.8, 1.9)],
        [(-33.6, 17.0, 0.0), (28.8, -32.3, 4.7), (29.6, -48.9, 0.0)],
        node_powers_w=(0.6, 1.5),
        jammer_powers_w=(0.088, 27830.0, 20.8),
        altitude_m=(12.0, 21.0),
        noise_w=4.7e-4,
        keep_out_m=5.0,
    )
    vertical, array = solve(field, "vertical"), solve(with_array(field, elements))
    assert array.objective.value >= vertical.objective.value * (1.0 - 1e-9)
    assert elements > 1 or array.status is vertical.status is Status.CERTIFIED


def test_without_jammers_the_elements_add_up(paper: Callable) -> None:
    """K elements and no jammer give K times the vertical case, which is the bound."""
    silent = paper(1.0).model_copy(update={"jammers": ()})
    vertical = solve(silent, "vertical")
    array = solve(with_array(silent, 6, "circular", 0.4))
    assert array.objective.value == pytest.approx(6.0 * vertical.objective.value, rel=3e-6)
    assert array.status is Status.CERTIFIED
    assert array.sensitivity.jammers == pytest.approx(array.objective.value)


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


@pytest.mark.parametrize(
    ("layout", "jamming_w"),
    and_slow([("linear", 30.0)], [("linear", 1.0), ("circular", 1.0), ("circular", 30.0)]),
)
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
    search = ArraySearch(scenario, with_array(scenario, 3).array, 0)
    sides = list(zip(*search.box(math.log(solution.objective.value)), strict=True))

    def cost(state: np.ndarray) -> float:
        return min(-float(search.judge(state[None].copy())[0]), 1e3)

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


def search_of(scenario: Scenario, elements: int, layout: str = "linear", spacing: float = 0.5) -> ArraySearch:
    """The search of an array in a scenario."""
    array = Array(elements=elements, layout=layout, spacing_wavelengths=spacing)
    return ArraySearch(scenario, array, 0)


def test_turning_by_the_symmetry_changes_nothing(random_scene: Callable) -> None:
    """A row turned by half a turn, a circle by one of its elements: the ratios are the same."""
    rng = np.random.default_rng(9)
    for layout, elements in (("linear", 4), ("circular", 5), ("circular", 2), ("circular", 1)):
        search = search_of(random_scene(rng, 3, 2, 10.0), elements, layout)
        state = np.append(rng.uniform([0, 0, 9], [99, 99, 29]), rng.uniform(-3.0, 3.0))
        turned = state + np.array([0.0, 0.0, 0.0, 2.0 * math.pi / search.symmetry])
        assert search.judge(turned[None]) == pytest.approx(search.judge(state[None]), abs=1e-9)


def test_nothing_out_of_reach_is_as_good(random_scene: Callable) -> None:
    """Every state with a value has its position in the box that is said to hold all such positions."""
    rng = np.random.default_rng(1)
    for _ in range(10):
        search = search_of(random_scene(rng, 3, 1, jamming_w=1e-3), 4)
        states = rng.uniform([-200, -200, 8, 0], [300, 300, 30, 6], (30, 4))
        for state, value in zip(states, search.judge(states), strict=True):
            low_m, high_m = search.box(value)
            assert np.all((low_m <= state[:3]) & (state[:3] <= high_m))


@pytest.mark.parametrize(("jamming_w", "layout"), diagonal([0.01, 10.0, 1e5], ["linear", "circular"]))
def test_no_state_exceeds_the_bound(
    layout: str, jamming_w: float, random_scene: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of many random states of all yaws none is above the bound, wherever the boxes run out."""
    monkeypatch.setitem(array_bound.__globals__, "_MOST_BOXES", 20_000)
    rng = np.random.default_rng(1)
    search = search_of(random_scene(rng, 2, 2, jamming_w), 3, layout, 0.7)
    states = rng.uniform([0.0, 0.0, 8.0, -math.pi], [100.0, 100.0, 12.0, math.pi], (3000, 4))
    search.best = float(np.max(search.judge(states)))
    assert search.best <= math.log(array_bound(search, gap=1e-2).value)


def test_a_bound_reaches_the_gap(random_scene: Callable) -> None:
    """For the level that it found itself, it stops at the gap; for a lower one, it says more."""
    search = search_of(random_scene(np.random.default_rng(2), 2, 1, 10.0), 3, "circular", 0.7)
    search.best = math.log(1e-3)
    first = array_bound(search, gap=1e-2)
    assert search.climb(first.state) > math.log(1e-3)
    search.best = math.log(first.value)
    again = array_bound(search, gap=1e-2)
    assert first.value <= again.value <= first.value * 1.0101


def test_a_climb_ends_at_a_local_optimum(random_scene: Callable) -> None:
    """Around the end no state of the domain is better, and the value is that of the state."""
    rng = np.random.default_rng(1)
    for _ in range(5):
        search = search_of(random_scene(rng, 3, 1), 4, "circular")
        start = rng.uniform([0.0, 0.0, 9.0, 0.0], [99.0, 99.0, 29.0, 6.0])
        value = search.climb(start)
        assert value == search.judge(search.state[None])[0] >= search.judge(start[None])[0]
        near = 10.0 ** rng.uniform(-6.0, -3.0, (300, 1)) * rng.normal(size=(300, 4))
        assert np.max(search.judge(search.state + near)) <= value + 1e-7


def test_a_climb_ends_inside(random_scene: Callable) -> None:
    """Among zones, balls and tight bounds it ends where the airspace allows, outside every ball."""
    rng = np.random.default_rng(2)
    zone = {"polygon_m": [(30.0, 30.0), (70.0, 30.0), (50.0, 70.0)]}
    drum = {"centre_m": (20.0, 60.0), "radius_m": 12.0, "altitude_m": (0.0, 20.0)}
    for _ in range(6):
        scene = random_scene(rng, 2, 1, 10.0, x_m=(5.0, 80.0), no_fly=(zone, drum), keep_out_m=12.0)
        search = search_of(scene, 4, "circular")
        inside_the_polygon = np.array([50.0, 45.0, 9.0, rng.uniform(0.0, 6.0)])
        assert np.isfinite(search.climb(inside_the_polygon))
        assert scene.airspace.allows(search.state[:3])
        points_m = np.vstack([scene.node_positions_m, scene.jammer_positions_m])
        assert np.min(np.linalg.norm(points_m - search.state[:3], axis=1)) >= 12.0


def test_a_fixed_position_stays(paper: Callable) -> None:
    """Where the airspace is one point only the yaw moves."""
    search = search_of(paper(1.0, x_m=(3.0, 3.0), y_m=(20.0, 20.0), altitude_m=(9.0, 9.0)), 4, "circular")
    start = np.array([3.0, 20.0, 9.0, 2.0])
    assert search.climb(start) > search.judge(start[None])[0]
    np.testing.assert_array_equal(search.state[:3], [3.0, 20.0, 9.0])


def test_a_wall_between_zones_is_found(paper: Callable) -> None:
    """Where the airspace leaves a wall of no width, a position on it is found."""
    zones = [{"x_m": side, "y_m": (-5.0, 45.0)} for side in ((-5.0, 5.0), (5.0, 15.0))]
    walled = paper(1.0, x_m=(0.0, 10.0), y_m=(0.0, 40.0), no_fly=zones)
    solution = solve(with_array(walled, 2), certify=False)
    assert walled.airspace.allows(solution.pose.position_m)
    assert solution.pose.position_m[0] == pytest.approx(5.0, abs=1e-9)


def test_walls_are_distances(paper: Callable) -> None:
    """Balls, planes and cylinders: the distances to them, and the ways out as unit vectors."""
    drum = {"centre_m": (0.0, 30.0), "radius_m": 5.0}
    box = {"x_m": (20.0, 40.0), "y_m": (20.0, 40.0), "altitude_m": (0.0, 15.0)}
    domain = build_family(paper(1.0, altitude_m=(0.0, 30.0), keep_out_m=3.0, no_fly=(drum, box))).domain
    position_m = np.array([8.0, 30.0, 12.0])
    distance_m, ways = walls(domain, position_m)
    balls = np.linalg.norm(position_m - domain.keep_out_points_m, axis=1) - 3.0
    np.testing.assert_allclose(distance_m, [*balls, 3.0, 12.0], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(ways, axis=1), 1.0, rtol=1e-12)
    for i in range(3):
        further = walls(domain, position_m + 1e-6 * np.eye(3)[i])[0]
        np.testing.assert_allclose((further - distance_m) / 1e-6, ways[:, i], atol=1e-5)
