"""The verbs' proofs: bounds that hold, limits that are told, and an interrupt that keeps what was found."""

import math
import sys
from collections.abc import Callable

import numpy as np
import pytest
from sizes import and_slow

from nullpose.physics import sinr
from nullpose.scenario import Scenario, apply_overrides
from nullpose.solver import Result, Scheme, Status, best_axis, compare, default_gap, solve


def refuse(*_: object) -> None:
    """Stands for Ctrl-C at the first sign of progress."""
    raise KeyboardInterrupt


@pytest.fixture
def twelve(random_scene: Callable) -> Scenario:
    """Returns a scene whose proof takes longer than the limits of these tests."""
    return random_scene(np.random.default_rng(6), 12, 3, 30.0)


def best_of_random_positions(one: Scenario, scheme: Scheme, count: int) -> float:
    """Returns the best value at random positions near the floor, by the physics alone."""
    rng = np.random.default_rng(9)
    low_z = one.airspace.altitude_m[0]
    p = rng.uniform([-20.0, -20.0, low_z], [120.0, 120.0, low_z + 8.0], (count, 3))
    if scheme is Scheme.OPTIMUM:
        axes = np.array([best_axis(one, at).antenna_axis for at in p[: count // 10]])
        return float(np.max(np.min(sinr(one, p[: count // 10], axes), axis=-1)))
    if scheme is Scheme.VERTICAL:
        return float(np.max(np.min(sinr(one, p, np.array([0.0, 0.0, 1.0])), axis=-1)))
    towards = [jammer - p for jammer in one.jammer_positions_m]
    return max(
        float(np.max(np.min(sinr(one, p, v / np.linalg.norm(v, axis=1, keepdims=True)), axis=-1)))
        for v in towards
    )


@pytest.mark.parametrize("scheme", [Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE, Scheme.VERTICAL])
@pytest.mark.parametrize(("nodes", "jammers"), and_slow([(1, 1), (3, 1)], [(2, 2), (5, 2), (8, 1)]))
def test_random_scenes_are_certified(
    nodes: int, jammers: int, scheme: Scheme, random_scene: Callable
) -> None:
    """The gap asked for is reached, and no position drawn beats the bound."""
    one = random_scene(np.random.default_rng(10 * nodes + jammers), nodes, jammers, 10.0)
    solution = solve(one, scheme)
    assert (solution.status, solution.reason) == (Status.CERTIFIED, "")
    assert 0.0 <= solution.objective.relative_gap <= default_gap(nodes)
    assert best_of_random_positions(one, scheme, 2000) <= solution.objective.upper_bound


@pytest.mark.parametrize("gap", [1e-8, 1e-7, 1e-3, 0.3, 10.0])
def test_the_gap_is_the_one_asked_for(gap: float, paper: Callable) -> None:
    """A gap from the finest to the widest is met, and bounds of different gaps do not contradict."""
    solution = solve(paper(1.0), gap=gap)
    assert solution.status is Status.CERTIFIED
    assert solution.objective.relative_gap <= gap
    assert solution.provenance["gap"] == gap
    assert solution.objective.value <= solve(paper(1.0)).objective.upper_bound
    assert solve(paper(1.0)).objective.value <= solution.objective.upper_bound


@pytest.mark.parametrize("scheme", Scheme)
def test_without_a_proof_the_search_is_harder(scheme: Scheme, paper: Callable) -> None:
    """Left alone the search starts more often, claims nothing, and finds no better than what is proved."""
    proved, fast = solve(paper(2.0), scheme), solve(paper(2.0), scheme, certify=False)
    assert (fast.status, fast.reason, fast.stats.boxes) == (Status.BEST_FOUND, "", 0)
    assert (fast.objective.upper_bound, fast.objective.relative_gap) == (None, None)
    assert fast.stats.starts > proved.stats.starts
    assert fast.objective.value <= proved.objective.upper_bound


@pytest.mark.parametrize(
    ("limits", "reason"),
    [
        ({"node_limit": 300}, "the node limit of 300"),
        ({"time_limit_s": 1e-6}, "the time limit of 1e-06 s"),
    ],
)
@pytest.mark.parametrize("scheme", [Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE])
def test_a_limit_is_told_and_leaves_a_valid_bound(
    limits: dict, reason: str, scheme: Scheme, twelve: Scenario
) -> None:
    """A proof that is stopped says by what, keeps its pose, and its bound is none that a pose exceeds."""
    solution = solve(twelve, scheme, **limits)
    assert (solution.status, solution.reason) == (Status.GAP_NOT_REACHED, reason)
    assert not solution.interrupted
    full = solve(twelve, scheme, gap=0.1)
    assert full.status is Status.CERTIFIED
    assert solution.objective.upper_bound >= max(full.objective.value, solution.objective.value)
    assert solution.objective.relative_gap > default_gap(12)


def test_an_interrupt_keeps_what_was_found(twelve: Scenario) -> None:
    """Ctrl-C during a proof ends it with the pose and a valid bound."""
    solution = solve(twelve, on_progress=refuse)
    assert solution.status is Status.GAP_NOT_REACHED
    assert solution.interrupted
    assert math.isfinite(solution.objective.upper_bound)
    assert solution.objective.upper_bound >= solve(twelve, certify=False).objective.value


def test_after_an_interrupt_nothing_more_is_proved(twelve: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupted in its first proof, a comparison still has a pose for each scheme, the others by search."""
    api = sys.modules["nullpose.solver.api"]

    def interrupted(*arguments: object, **options: object) -> Result:
        return solve(*arguments, **options, on_progress=refuse)

    monkeypatch.setattr(api, "solve", interrupted)
    first, *others = compare(twelve)
    assert first.interrupted
    assert [solution.status for solution in others] == [Status.BEST_FOUND] * 3
    assert all(solution.stats.boxes == 0 for solution in others)


def test_progress_is_told(twelve: Scenario) -> None:
    """Gap and boxes are reported on the way; the gap never widens."""
    seen: list[tuple[float, int]] = []
    solution = solve(twelve, gap=0.01, on_progress=lambda gap, boxes: seen.append((gap, boxes)))
    gaps, boxes = (list(column) for column in zip(*seen, strict=True))
    assert boxes == sorted(boxes)
    assert boxes[-1] <= solution.stats.boxes  # the end is told by the solution itself
    assert gaps == sorted(gaps, reverse=True) or max(np.diff(gaps)) < 1e-9


def test_no_time_limit_is_a_time_limit(paper: Callable) -> None:
    """Infinity is allowed: the proof takes as long as it takes."""
    assert solve(paper(1.0), time_limit_s=math.inf).status is Status.CERTIFIED


def test_tilt_limits_among_strong_jammers() -> None:
    """Where the airframe's limit binds, axes that are cut early never come to an end, and late ones do."""
    rng = np.random.default_rng(6)
    nodes, jammers = rng.uniform(0.0, 100.0, (12, 2)), rng.uniform(20.0, 80.0, (2, 2))
    scenario = Scenario.from_arrays(
        nodes_m=np.column_stack([nodes, np.zeros(12)]),
        jammers_m=np.column_stack([jammers, np.ones(2)]),
        jammer_power_w=200.0,
        noise_w=1e-3,
        altitude_m=(8.0, 60.0),
    )
    tilted = apply_overrides(scenario, ["airframe.tilt_max_deg=45"])
    assert solve(tilted, node_limit=400_000, time_limit_s=math.inf, threads=1).status is Status.CERTIFIED
