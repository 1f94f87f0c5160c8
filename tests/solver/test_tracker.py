"""The pose at every step of a stream: proved, as good as a solve's, and never the last one that was best."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.reference.sizes import few_examples

import nullpose
from nullpose.errors import NullposeError, ScenarioError, UsageError
from nullpose.physics import evaluate, objective_of_links
from nullpose.scenario import Scenario
from nullpose.solver import Result, Status, Tracker, solve, tracker as module
from nullpose.solver.solve_and_prove import Outcome
from scenes import EXAMPLES

NODES_M = np.array([[0.0, 0.0, 0.0], [0.0, 50.0, 0.0]])
GAP = 1e-3


def paper_like(power_w: float = 1.0, **keys: Any) -> Scenario:
    """Return two nodes and a jammer of some power."""
    jammer_m = [[17.0, 15.0, 4.0]]
    return Scenario.from_arrays(
        NODES_M, jammer_m, jammer_power_w=power_w, noise_w=1e-3, altitude_m=(8, 30), **keys
    )


def agree(tracked: Result, gap: float = GAP) -> bool:
    """Check by the physics and by a solve of the same scene that neither bound is below the other's value."""
    there = objective_of_links(tracked.scenario, evaluate(tracked.scenario, tracked.pose))
    alone = solve(tracked.scenario, gap=gap)
    bounds = tracked.objective.upper_bound, alone.objective.upper_bound
    assert bounds[0] is not None
    assert bounds[1] is not None
    return (
        there == tracked.objective.value
        and bounds[0] >= alone.objective.value * (1.0 - 1e-9)
        and bounds[1] >= tracked.objective.value * (1.0 - 1e-9)
    )


@given(
    steps_m=st.lists(st.tuples(*3 * [st.floats(-8.0, 8.0)]), min_size=1, max_size=4),
    power_w=st.sampled_from([1.0, 100.0]),
)
@few_examples(8)
def test_every_step_of_a_random_walk_is_proved(
    steps_m: list[tuple[float, float, float]], power_w: float
) -> None:
    """Certified at every step, and a solve of that moment's scene finds nothing above the bound."""
    tracker, jammer_m = Tracker(paper_like(power_w)), np.array([17.0, 15.0, 4.0])
    for step_m in steps_m:
        jammer_m = np.maximum(jammer_m + step_m, [-1e3, -1e3, 0.0])
        result = tracker.update(NODES_M, [jammer_m])
        assert result.scenario.jammers[0].position_m == tuple(jammer_m)
        assert result.status == Status.CERTIFIED
        assert agree(result)


KINDS = ("no-fly", "eavesdropper", "friendly-jamming", "relay", "airframe", "urban", "town", "whips", "field")


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_of_scene_is_tracked(name: str) -> None:
    """Whatever solve proves of a dipole, with everybody where they are said to be."""
    scene, rng = nullpose.load(EXAMPLES / f"{name}.toml"), np.random.default_rng(1)
    tracker = Tracker(scene)
    for _ in range(2):
        kinds = ("nodes", "jammers", "eavesdroppers", "sources")
        at = {kind: [point.position_m for point in getattr(tracker.scenario, kind)] for kind in kinds}
        moved: dict[str, Any] = {
            f"{kind}_m": at_m + 0.3 * rng.normal(size=(len(at_m), 3)) * [1, 1, 0]
            for kind, at_m in at.items()
            if at_m
        }
        others = {}
        if scene.destination is not None:
            others["destination_m"] = np.add(scene.destination.position_m, 0.3)
        result = tracker.update(**moved, **others)
        for kind, at_m in moved.items():
            points = getattr(result.scenario, kind.removesuffix("_m"))
            np.testing.assert_allclose([point.position_m for point in points], at_m)
        assert result.status == Status.CERTIFIED
        assert agree(result)


@pytest.mark.parametrize("airframe", [{"tilt_max_deg": 0.0}, {"tilt_max_deg": 20.0, "mount_deg": 90.0}])
@pytest.mark.parametrize("average", ["power", "db"])
def test_channels_and_tilt_limits_go_together(airframe: dict[str, float], average: str) -> None:
    """On a line of sight by elevation with a band of axes."""
    channel = {"model": "elevation", "environment": "urban", "average": average}
    tracker = Tracker(paper_like(10.0, channel=channel, airframe=airframe))
    for x_m in (17.0, 16.0):
        result = tracker.update(jammers_m=[[x_m, 15.0, 4.0]])
        assert result.status == Status.CERTIFIED
        assert agree(result)


@pytest.mark.parametrize("power_w", [1.0, 100.0])
def test_the_pose_jumps_where_the_best_one_does(power_w: float) -> None:
    """A jammer crosses the nodes' line: at each step the pose is the best of that step, though far away."""
    tracker, along, last_m, jumps_m = Tracker(paper_like(power_w)), np.radians(15.0), None, []
    for t_s in np.arange(27.0, 33.0, 0.1):
        way_m = 8.0 * (t_s - 30.0)
        result = tracker.update(NODES_M, [[way_m * np.cos(along), 20.0 + way_m * np.sin(along), 4.0]])
        assert result.status == Status.CERTIFIED
        jumps_m.append(0.0 if last_m is None else math.dist(last_m, result.pose.position_m))
        if jumps_m[-1] > 5.0:
            assert agree(result)
        last_m = result.pose.position_m
    assert max(jumps_m) > 5.0


def crowd() -> tuple[Scenario, np.ndarray, np.ndarray]:
    """Return a scene whose proofs have thousands of leaves, and where its nodes and jammers are."""
    rng = np.random.default_rng(0)
    nodes_m = np.column_stack([rng.uniform(0.0, 100.0, (6, 2)), np.zeros(6)])
    jammers_m = np.column_stack([rng.uniform(0.0, 100.0, (3, 2)), np.full(3, 4.0)])
    scene = Scenario.from_arrays(nodes_m, jammers_m, jammer_power_w=10.0, noise_w=1e-3, altitude_m=(8, 30))
    return scene, nodes_m, jammers_m


@pytest.mark.parametrize("step_m", [0.05, 1.0, 15.0])
def test_a_proof_that_begins_with_the_last_one_bounds_as_any_other(step_m: float) -> None:
    """In a convoy of ten, near and far from where it was; small steps examine fewer boxes than the first."""
    scene, nodes_m, jammers_m = crowd()
    tracker, boxes = Tracker(scene), []
    for step in range(8):
        way_m = step * step_m * np.array([0.8, 0.6, 0.0])
        result = tracker.update(nodes_m + way_m, jammers_m - 0.5 * way_m)
        boxes.append(result.stats.boxes)
        assert result.status == Status.CERTIFIED
        assert agree(result, 1e-2)
    if step_m < 0.1:
        assert max(boxes[1:]) < 0.9 * boxes[0]


def test_a_proof_that_has_grown_begins_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its leaves do not pile up behind what moves on for ever."""
    scene, nodes_m, jammers_m = crowd()
    tracker, began = Tracker(scene), []
    original = module.solve_and_prove

    def counted(*args: Any, **options: Any) -> Outcome:
        began.append(len(options["last"].leaves) if options["last"] else 0)
        return original(*args, **options)

    monkeypatch.setattr(module, "solve_and_prove", counted)
    for step in range(20):
        tracker.update(nodes_m, jammers_m + 0.5 * step)
    assert began.count(0) >= 2
    assert max(began) < 3 * began[1]


def test_at_the_deadline_there_is_a_pose_with_a_bound() -> None:
    """With no time at all, too; the status says that the gap was not reached, and why."""
    scene, nodes_m, jammers_m = crowd()
    best = solve(scene, gap=1e-2).objective.value
    for deadline_s in (0.0, 1e-3):
        result = Tracker(scene, gap=1e-6, deadline_s=deadline_s).update(nodes_m, jammers_m)
        assert result.status == Status.GAP_NOT_REACHED
        assert result.reason == f"the deadline of {deadline_s:g} s"
        assert result.objective.upper_bound is not None
        assert result.objective.upper_bound >= best
        assert result.objective.value == objective_of_links(scene, evaluate(scene, result.pose))


def test_what_is_left_out_stays() -> None:
    """Without any place the scene is solved as it stands; later as it stood last."""
    tracker = Tracker(nullpose.load(EXAMPLES / "moving_jammer.toml").at(10.0))
    assert agree(tracker.update())
    moved = tracker.update(jammers_m=[[-19.0, 15.0, 4.0]])
    again = tracker.update(nodes_m=[[1.0, 0.0, 0.0], [0.0, 50.0, 0.0]])
    assert again.scenario.jammers == moved.scenario.jammers != tracker.update().scenario.nodes
    assert again.scenario.at_s is None
    assert "at 10 s" not in again.scenario.name


@pytest.mark.parametrize(
    ("places", "words"),
    [
        ({"nodes_m": NODES_M[:, :2]}, r"nodes_m: given shape \(2, 2\); allowed: \(2, 3\)"),
        ({"jammers_m": NODES_M}, r"jammers_m: given shape \(2, 3\); allowed: \(1, 3\).*another Tracker"),
        ({"eavesdroppers_m": [[0.0, 0.0, 0.0]]}, r"eavesdroppers_m: given shape \(1, 3\); allowed: \(0, 3\)"),
        ({"destination_m": [0.0, 0.0, 0.0]}, r"destination_m: given shape \(1, 3\); allowed: \(0, 3\)"),
        ({"jammers_m": "far away"}, "jammers_m: given 'far away'"),
        ({"jammers_m": [[math.nan, 0.0, 0.0]]}, r"jammers\[0\].position_m\[0\]: got NaN"),
        ({"jammers_m": NODES_M[:1]}, r"jammers\[0\].position_m: .*the place of nodes\[0\] already"),
    ],
)
def test_places_that_do_not_fit_change_nothing(places: dict[str, Any], words: str) -> None:
    """They are refused by name, and the next step is what it would have been without them."""
    tracker, other = Tracker(paper_like()), Tracker(paper_like())
    with pytest.raises(NullposeError, match=words):
        tracker.update(**places)
    assert tracker.update().pose == other.update().pose
    assert tracker.scenario == other.scenario


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        ("array", "Tracker: given an array; allowed: one dipole"),
        ("frame", "antenna: given a pattern of .*; allowed here: a dipole"),
        ("moving_jammer", "scenario: given a scene in motion; allowed: a still one"),
    ],
)
def test_what_is_not_tracked_is_refused(scene: str, words: str) -> None:
    """Before the first step, with what is allowed."""
    with pytest.raises(UsageError, match=words):
        Tracker(nullpose.load(EXAMPLES / f"{scene}.toml"))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"gap": 0.0}, "gap: given 0.0"),
        ({"deadline_s": -1.0}, "deadline_s: given -1.0; allowed: 0 seconds or more"),
        ({"deadline_s": math.nan}, "deadline_s: given nan"),
        ({"robust": True}, "robust: unknown option"),
    ],
)
def test_options_that_cannot_be_are_refused(options: dict[str, Any], words: str) -> None:
    """A gap of nothing, a deadline in the past, a robust pose."""
    with pytest.raises(UsageError, match=words):
        Tracker(paper_like(), **options)


def test_a_step_without_a_pose_is_an_error_and_the_next_goes_on() -> None:
    """Where no pose reaches what the nodes require, and then one does."""
    scene = nullpose.load(EXAMPLES / "requirements.toml")
    far = scene.model_copy(update={"objective": "sum-rate"})
    tracker = Tracker(far)
    first = tracker.update()
    away_m = scene.node_positions_m + np.arange(len(scene.nodes))[:, None] * [1e4, 0.0, 0.0]
    with pytest.raises(nullpose.SolveError, match="min_sinr_db"):
        tracker.update(nodes_m=away_m)
    back = tracker.update(nodes_m=scene.node_positions_m)
    assert back.objective.value == pytest.approx(first.objective.value, rel=2 * GAP)


def test_an_interrupt_ends_the_stream(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C during a proof is no answer with a poor bound."""
    from nullpose.solver.proof import _Run

    def interrupted(run: _Run) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(_Run, "try_target", interrupted)
    with pytest.raises(KeyboardInterrupt):
        Tracker(paper_like()).update()


def test_a_building_is_no_place_for_a_jammer() -> None:
    """A place that is not allowed is refused as in a file."""
    town = nullpose.load(EXAMPLES / "town.toml")
    inside_m = np.mean(town.buildings[0].polygon_m, axis=0)
    with pytest.raises(ScenarioError, match="stands in it"):
        Tracker(town).update(jammers_m=[[*inside_m, 1.0]])
