"""The verbs: what they promise for any scene, and the words in which they refuse."""

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import minimize
from sizes import chosen

from nullpose.errors import SolveError, UsageError
from nullpose.physics import evaluate, min_sinr, sinr
from nullpose.scenario import Scenario, load
from nullpose.solver import (
    Result,
    Scheme,
    Status,
    best_axis,
    compare,
    default_gap,
    solve,
)
from scenes import EXAMPLES


def check(solution: Result) -> None:
    """Checks what every solution promises: the value is the pose's, the pose allowed, the status earned."""
    scene = solution.scenario
    assert evaluate(scene, solution.pose) == solution.links
    assert solution.objective.value == min(link.sinr for link in solution.links)
    assert solution.objective.value_db == pytest.approx(
        10.0 * math.log10(solution.objective.value), abs=1e-12
    )
    p = solution.pose.position_m
    assert np.all(p >= scene.airspace.lower_m)
    assert np.all(p <= scene.airspace.upper_m)
    ground = np.vstack([scene.node_positions_m, scene.jammer_positions_m])
    assert np.all(np.linalg.norm(ground - p, axis=1) >= scene.airspace.keep_out_m * (1.0 - 1e-15))
    assert abs(solution.pose.roll_rad) <= math.pi / 2
    assert abs(solution.pose.pitch_rad) <= math.pi / 2
    assert solution.pose.yaw_rad == 0.0
    objective = solution.objective
    if solution.status is Status.BEST_FOUND:
        assert (objective.upper_bound, objective.relative_gap) == (None, None)
        return
    assert objective.upper_bound >= objective.value
    assert objective.relative_gap == pytest.approx(objective.upper_bound / objective.value - 1.0, abs=1e-15)
    if solution.status is Status.CERTIFIED:
        assert objective.relative_gap <= solution.provenance["gap"]
        assert solution.reason == ""
    else:
        assert solution.reason


SCENES = {
    "one node": ([(0, 0, 0)], [(10, 0, 0)], {}),
    "two nodes, no jammer": ([(0, 0, 0), (0, 50, 0)], [], {}),
    "two nodes, two jammers": ([(0, 0, 0), (0, 50, 0)], [(17, 15, 4), (-10, 30, 1)], {}),
    "three nodes in line": ([(-10, 0, 0), (0, 0, 0), (10, 0, 0)], [(5, 0, 0)], {}),
    "five nodes": ([(0, 0, 0), (40, 0, 3), (40, 40, 0), (0, 40, 2), (20, 60, 0)], [(20, 20, 1)], {}),
    "a fixed altitude": ([(0, 0, 0), (0, 50, 0)], [(17, 15, 4)], {"altitude_m": (12.0, 12.0)}),
    "a small room": (
        [(0, 0, 0), (0, 50, 0)],
        [(17, 15, 4)],
        {"x_m": (5.0, 9.0), "y_m": (-3.0, 4.0), "altitude_m": (2.0, 6.0)},
    ),
    "a room far away": (
        [(0, 0, 0), (0, 50, 0)],
        [(17, 15, 4)],
        {"x_m": (100.0, 200.0), "y_m": (-90.0, -50.0)},
    ),
    "wide keep-outs": ([(0, 0, 0), (0, 50, 0)], [(17, 15, 4)], {"keep_out_m": 26.5}),
}
CASES = [
    (nodes, jammers, airspace, scheme)
    for (nodes, jammers, airspace), scheme in itertools.product(SCENES.values(), Scheme)
    if (jammers or scheme is not Scheme.ZERO_INTERFERENCE)
]


@pytest.mark.parametrize(("nodes", "jammers", "airspace", "scheme"), chosen(CASES, range(0, 35, 3)))
def test_a_solution_keeps_its_promises(
    nodes: list, jammers: list, airspace: dict, scheme: Scheme, scene: Callable
) -> None:
    """In every kind of scene value and pose are what they should be, and proved wherever that can be."""
    one = scene(nodes, jammers, **airspace)
    # a best position high on two keep-out balls takes more boxes than are kept for a gap of 1e-6
    hard = scheme is Scheme.ZERO_INTERFERENCE and "keep_out_m" in airspace
    gap = 1e-3 if hard else default_gap(len(nodes))
    solution = solve(one, scheme, gap=gap)
    check(solution)
    provable = scheme is not Scheme.MAXIMUM_GAIN or len(nodes) == 2
    assert (solution.status is Status.CERTIFIED) is provable
    assert solution.provenance["gap"] == gap
    assert solution.scheme is scheme
    assert solution.stats.starts > 0
    assert solution.stats.evaluations >= solution.stats.starts
    assert solve(one, scheme, gap=gap, seed=11).objective.value == pytest.approx(
        solution.objective.value, rel=1e-8
    )


@pytest.mark.parametrize("scheme", Scheme)
def test_equal_seeds_give_equal_answers(scheme: Scheme, paper: Callable) -> None:
    """The same seed gives the same pose to the last bit, and the provenance names it."""
    first, second = (solve(paper(3.0), scheme, seed=5) for _ in range(2))
    assert first.pose == second.pose
    assert first.objective == second.objective
    assert (first.stats.starts, first.stats.evaluations) == (second.stats.starts, second.stats.evaluations)
    assert first.provenance["seed"] == 5


@pytest.mark.parametrize("ratio", chosen([1e-3, 0.1, 1.0, 10.0, 1e3, 1e6], [0, 2, 5]))
def test_no_scheme_beats_the_optimum(ratio: float, paper: Callable) -> None:
    """The optimum is at least as good as every other scheme, which all restrict its axis."""
    optimum, *others = compare(paper(ratio))
    for other in others:
        assert other.objective.value <= optimum.objective.value * (1.0 + 1e-9)


def test_a_jammer_more_never_helps(random_scene: Callable) -> None:
    """Adding jammers one by one, and raising their power, never raises the optimum."""
    rng = np.random.default_rng(31)
    for _ in range(5):
        full = random_scene(rng, 3, 3, 30.0)
        values = [
            solve(full.model_copy(update={"jammers": full.jammers[:count]})).objective.value
            for count in range(4)
        ]
        assert all(b <= a * (1.0 + 1e-9) for a, b in itertools.pairwise(values))


def test_turning_the_scene_turns_the_pose(random_scene: Callable, scene: Callable) -> None:
    """Turned about the vertical and shifted, the scene has the same value at the pose turned alike."""
    rng = np.random.default_rng(41)
    angle, shift = 1.1, np.array([1000.0, -400.0, 0.0])
    turn = np.array(
        [
            [math.cos(angle), -math.sin(angle), 0.0],
            [math.sin(angle), math.cos(angle), 0.0],
            [0.0, 0.0, 1.0],
        ]
    )
    for _ in range(5):
        one = random_scene(rng, 3, 2, 10.0)
        turned = scene(
            one.node_positions_m @ turn.T + shift,
            one.jammer_positions_m @ turn.T + shift,
            node_powers_w=one.node_powers_w,
            jammer_powers_w=one.jammer_powers_w,
        )
        before, after = solve(one), solve(turned)
        assert after.objective.value == pytest.approx(before.objective.value, rel=1e-9)
        np.testing.assert_allclose(
            after.pose.position_m, turn @ before.pose.position_m + shift, atol=1e-5, rtol=0.0
        )
        parallel = after.pose.antenna_axis @ turn @ before.pose.antenna_axis
        assert abs(parallel) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("length", [1e-2, 1e3])
def test_stretching_the_scene_stretches_the_pose(length: float, scene: Callable) -> None:
    """A scene in centimetres or in kilometres, its powers scaled with the square, has the same value."""
    nodes, jammers = np.array([[0, 0, 0], [0, 50, 0], [30, 10, 1]]), np.array([[17, 15, 4]])
    plain = solve(scene(nodes, jammers, jammer_powers_w=10.0))
    stretched = solve(
        scene(
            length * nodes,
            length * jammers,
            node_powers_w=length**2,
            jammer_powers_w=10.0 * length**2,
            altitude_m=(8.0 * length, 30.0 * length),
            keep_out_m=length,
        )
    )
    assert stretched.objective.value == pytest.approx(plain.objective.value, rel=1e-9)
    np.testing.assert_allclose(stretched.pose.position_m, length * plain.pose.position_m, atol=1e-4 * length)


def test_powers_over_six_decades(scene: Callable) -> None:
    """Nodes from 1 mW to 1 kW: the weak one decides, and the strong ones do not disturb."""
    nodes = [(0, 0, 0), (30, 40, 0), (10, 60, 2)]
    jammers = [(40, 10, 3), (5, 30, 1)]
    solution = solve(
        scene(nodes, jammers, node_powers_w=[1e3, 1.0, 1e-3], jammer_powers_w=[100.0, 1e-4], noise_w=1e-9)
    )
    check(solution)
    assert solution.binding_node == "S3"
    assert solve(
        scene(nodes, jammers, node_powers_w=[1e3, 1.0, 1e-3], jammer_powers_w=[100.0, 1e-4], noise_w=1e-9),
        seed=3,
    ).objective.value == pytest.approx(solution.objective.value, rel=1e-9)


def test_the_field_in_dbm_and_hertz() -> None:
    """The ten-node example, in dBm and Hz, and the same scene in watts and dB have the same solutions."""
    field = load(EXAMPLES / "field.toml")
    data = field.to_dict()
    for points, powers_w in (("nodes", field.node_powers_w), ("jammers", field.jammer_powers_w)):
        for point, power_w in zip(data[points], powers_w, strict=True):
            point.pop("power_dbm")
            point["power_w"] = float(power_w)
    data["receiver"] = {
        "noise_w": field.receiver.noise_power_w,
        "reference_gain_db": 10.0 * math.log10(field.receiver.reference_gain),
    }
    watts = Scenario.from_dict(data)
    for scheme in (Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE, Scheme.VERTICAL):
        one, other = solve(field, scheme), solve(watts, scheme, seed=1)
        check(one)
        assert other.objective.value == pytest.approx(one.objective.value, rel=1e-9)


def peer(one: Scenario, rng: np.random.Generator, starts: int) -> float:
    """Returns the best that SLSQP finds on position, axis and level, from the best of random poses."""
    ground = np.vstack([one.node_positions_m, one.jammer_positions_m])
    low_z, high_z = one.airspace.altitude_m
    keep_out = one.airspace.keep_out_m

    def logs(x: np.ndarray) -> np.ndarray:
        axis = x[..., 3:6] / np.linalg.norm(x[..., 3:6], axis=-1, keepdims=True)
        return np.log(np.maximum(sinr(one, x[..., :3], axis), 1e-300))

    def slopes(x: np.ndarray) -> np.ndarray:
        steps = 1e-6 * np.eye(7)[:6]
        ends = logs(x + np.vstack([steps, -steps]))
        return np.column_stack([(ends[:6] - ends[6:]).T / 2e-6, -np.ones(ends.shape[1])])

    best = 0.0
    for _ in range(starts):
        drawn = np.column_stack(
            [rng.uniform([-30.0, -30.0, low_z], [130.0, 130.0, high_z], (300, 3)), rng.normal(size=(300, 3))]
        )
        values = np.min(logs(np.column_stack([drawn, np.zeros(300)])), axis=1)
        start = int(np.argmax(values))
        axis = drawn[start, 3:] / np.linalg.norm(drawn[start, 3:])
        result = minimize(
            lambda x: -x[6],
            [*drawn[start, :3], *axis, values[start]],
            jac=lambda x: -np.eye(7)[6],
            method="SLSQP",
            bounds=[(-200.0, 300.0), (-200.0, 300.0), (low_z, high_z), *[(-2.0, 2.0)] * 3, (None, None)],
            constraints=[
                {"type": "ineq", "fun": lambda x: logs(x) - x[6], "jac": slopes},
                {
                    "type": "eq",
                    "fun": lambda x: x[3:6] @ x[3:6] - 1.0,
                    "jac": lambda x: np.array([0.0, 0.0, 0.0, *(2.0 * x[3:6]), 0.0]),
                },
            ],
            options={"maxiter": 200, "ftol": 1e-12},
        )
        outside = np.linalg.norm(ground - result.x[:3], axis=1).min() >= keep_out
        if outside and low_z <= result.x[2] <= high_z:
            best = max(best, float(np.exp(np.min(logs(result.x)))))
    return best


@pytest.mark.parametrize(
    ("nodes", "jammers", "jamming_w"),
    chosen([(1, 1, 100.0), (2, 1, 3.0), (3, 2, 10.0), (4, 1, 0.3), (5, 3, 50.0)], [1, 2]),
)
def test_a_peer_finds_nothing_better(
    nodes: int, jammers: int, jamming_w: float, random_scene: Callable
) -> None:
    """SLSQP from many starts, on the physics alone, comes close to the optimum and never above it."""
    rng = np.random.default_rng(100 * nodes + jammers)
    one = random_scene(rng, nodes, jammers, jamming_w)
    solution = solve(one)
    value = solution.objective.value
    found = peer(one, rng, 20)
    assert found <= solution.objective.upper_bound
    assert solution.objective.upper_bound <= value * (1.0 + default_gap(nodes))
    assert found >= value * (1.0 - 1e-2)


def test_compare_solves_the_schemes_in_order(paper: Callable) -> None:
    """Comparing gives the paper's four cases in order, each as solve gives it, and reports its progress."""
    calls: list[tuple[int, int]] = []
    solutions = compare(paper(1.0), seed=2, on_progress=lambda done, total: calls.append((done, total)))
    assert tuple(solution.scheme for solution in solutions) == tuple(Scheme)
    assert calls == [(1, 4), (2, 4), (3, 4), (4, 4)]
    for solution in solutions:
        alone = solve(paper(1.0), solution.scheme, seed=2)
        assert alone.pose == solution.pose
        assert alone.objective == solution.objective


def test_compare_leaves_out_what_does_not_apply(scene: Callable) -> None:
    """Schemes without meaning here are left out, and progress counts those that are solved."""
    calls: list[tuple[int, int]] = []
    quiet = scene([(0, 0, 0), (0, 50, 0), (30, 20, 0)])
    solutions = compare(
        quiet, schemes=list(Scheme), on_progress=lambda done, total: calls.append((done, total))
    )
    expected = [scheme for scheme in Scheme if scheme.not_applicable(quiet) is None]
    assert [solution.scheme for solution in solutions] == expected
    assert expected == [Scheme.OPTIMUM, Scheme.MAXIMUM_GAIN, Scheme.VERTICAL]
    assert calls == [(1, 3), (2, 3), (3, 3)]


def test_compare_takes_names(paper: Callable) -> None:
    """Schemes may be given by name; an unknown one is refused before anything is solved."""
    (solution,) = compare(paper(1.0), schemes=["vertical"])
    assert solution.scheme is Scheme.VERTICAL
    with pytest.raises(UsageError, match="'fastest'"):
        compare(paper(1.0), schemes=["vertical", "fastest"])


@pytest.mark.parametrize(
    ("scheme", "options", "words"),
    [
        ("best", {}, ["scheme", "'best'", "allowed", "optimum", "vertical"]),
        ("optimum", {"seed": -1}, ["seed", "-1", "allowed", "at least 0"]),
        ("optimum", {"null_jammer": "M"}, ["null jammer", "'M'", "optimum", "zero-interference only"]),
        ("zero-interference", {"null_jammer": "X"}, ["null jammer", "'X'", "the scenario's jammers are M1"]),
    ],
)
def test_what_cannot_be_asked_is_said(scheme: str, options: dict, words: list[str], paper: Callable) -> None:
    """A request that does not fit is refused with what was given and what is allowed."""
    with pytest.raises(UsageError) as raised:
        solve(paper(1.0), scheme, **options)
    for word in words:
        assert word in str(raised.value)


def test_a_room_without_a_pose_is_said(scene: Callable) -> None:
    """Where the only position has the node in the vertical null, there is no answer, and that is said."""
    needle = scene([(0, 0, 0)], x_m=(0.0, 0.0), y_m=(0.0, 0.0), altitude_m=(8.0, 8.0))
    with pytest.raises(SolveError, match="no position was found at which every node is received"):
        solve(needle, Scheme.VERTICAL)


def test_best_axis_at_a_position(paper: Callable) -> None:
    """The best axis at a position beats a dense grid of axes there, and the position is the one given."""
    one = paper(10.0)
    rng = np.random.default_rng(51)
    axes = rng.normal(size=(50_000, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    for position in ([-2.6, 23.3, 8.0], [30.0, -5.0, 20.0], [17.0, 15.0, 6.0]):
        pose = best_axis(one, position)
        np.testing.assert_array_equal(pose.position_m, position)
        grid = np.min(sinr(one, np.array(position), axes), axis=1)
        assert grid.max() <= min_sinr(one, pose)
        assert grid.max() > 0.8 * min_sinr(one, pose)  # a grid misses the null's last digits


def test_best_axis_does_not_consult_the_airspace(paper: Callable) -> None:
    """A position outside the airspace has a best axis all the same."""
    assert best_axis(paper(1.0), [0.0, 25.0, 200.0]).position_m[2] == 200.0


@pytest.mark.parametrize(
    ("position", "words"),
    [
        ([0.0, 25.0], "allowed: three finite numbers, metres"),
        ([0.0, 25.0, math.nan], "allowed: three finite numbers, metres"),
        ([[0.0, 25.0, 8.0]], "allowed: three finite numbers, metres"),
        ([0.0, 0.0, 0.5], r"0\.5 m from a ground point; allowed: at least keep_out_m = 1 m"),
    ],
)
def test_best_axis_of_a_bad_position(position: list, words: str, paper: Callable) -> None:
    """A position that is none, or that is too close to a ground point, is refused."""
    with pytest.raises(UsageError, match=words):
        best_axis(paper(1.0), position)
