"""Peers, provers and workloads: their problem is the physics', their claims are judged by the poses."""

import math
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import numpy as np
import pytest
from benchmarks.__main__ import main
from benchmarks.five_pose import FivePose
from benchmarks.page import PAGE, RESULTS, markdown, write_page
from benchmarks.peers import PEERS, Budget, climb
from benchmarks.provers import FINISHED, NOT_CLOSED, Problem
from benchmarks.provers.problem import Scaled
from benchmarks.scenes import Scene, field_scenes
from tests.reference.plain_kernels import plain

from benchmarks import certified, fields, five_pose, proofs, tracker
from nullpose.physics import Pose, min_sinr, sinr

SCENE = Scene(nodes=5, jammers=3, jamming_ratio=10.0, seed=1)


@pytest.fixture(scope="module")
def problem() -> Iterator[FivePose]:
    """One scene for all tests of peers, its kernels as Python runs them."""
    with pytest.MonkeyPatch.context() as patch:
        for name in ("cost", "costs", "ratios_and_slopes"):
            patch.setattr(five_pose, name, plain(getattr(five_pose, name)))
        yield FivePose.of(SCENE.scenario())


def points(count: int) -> np.ndarray:
    """Scaled poses at random."""
    return np.random.default_rng(3).uniform(size=(count, 5))


def test_cost_and_slopes_are_the_physics(problem: FivePose) -> None:
    """The compiled cost is minus the log of the smallest SINR; slopes agree with central differences."""
    step, xs = 1e-6, points(5)
    assert np.array_equal(problem.costs(xs), [problem.cost(x) for x in xs])
    for x in xs:
        pose = problem.pose(x)
        assert -problem.cost(x) == pytest.approx(np.log(min_sinr(problem.scenario, pose)), rel=1e-12)
        logs, slopes = problem.ratios_and_slopes(x)
        expected = np.log(sinr(problem.scenario, pose.position_m, pose.antenna_axis))
        assert logs == pytest.approx(expected, rel=1e-11)
        for i, direction in enumerate(np.eye(5)):
            ahead = problem.ratios_and_slopes(x + step * direction)[0]
            behind = problem.ratios_and_slopes(x - step * direction)[0]
            assert slopes[:, i] == pytest.approx((ahead - behind) / (2 * step), rel=1e-4, abs=1e-4)


def test_climb_never_loses(problem: FivePose) -> None:
    """The polish ends at least as high as it starts, inside the airspace."""
    for start in points(10):
        end = climb(problem, start)
        assert problem.cost(end) <= problem.cost(start)
        assert np.all((end[:3] >= 0.0) & (end[:3] <= 1.0))


@pytest.mark.parametrize("name", [name for name in PEERS if not name.startswith("CMA")])
def test_peer_gets_better_and_repeats(name: str, problem: FivePose) -> None:
    """A peer's answers get better from stage to stage and repeat with the seed."""
    budget = Budget(evaluations=500, starts=4)
    runs = [[problem.cost(x) for _, x in PEERS[name](problem, budget, 0)] for _ in range(2)]
    assert runs[0] == runs[1] == sorted(runs[0], reverse=True)


TRUE = {"jamming_ratio": 1.0, "method": "SCIP", "status": FINISHED, "claimed_value": 2.0, "value": 2.0}
TRUE |= {"bound": 2.0 * (1.0 + 0.5 * certified.GAP), "seconds": 0.3, "boxes": 10}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({}, "true"),
        ({"status": NOT_CLOSED}, "not closed"),
        ({"status": "failed: x"}, "failed: x"),
        ({"claimed_value": 2.1}, "value above the optimum"),
        ({"bound": 1.9999}, "bound below a pose"),
        ({"value": 1.9, "claimed_value": 1.9}, "wider than the gap"),
        ({"value": math.nan}, "pose below its value"),
    ],
)
def test_claims_are_judged(changed: dict[str, Any], words: str) -> None:
    """A claim is true if it is closed, its pose reaches its value, and no pose is above its bound."""
    assert words in certified.verdict(TRUE | changed, 2.0)


def test_only_true_claims_count_in_the_lead() -> None:
    """The rival is the fastest with a true claim."""
    ours, false = (
        TRUE | {"method": "nullpose", "seconds": 0.001},
        TRUE | {"seconds": 0.1, "claimed_value": 2.1},
    )
    table = certified.tables([ours, false | {"method": "other"}, TRUE])["Time of a true claim, ms"]
    assert table["times nullpose"][0] == pytest.approx(300.0)
    assert certified.faults([ours, TRUE]) == []
    assert certified.faults([ours | {"bound": 1.9}, TRUE]) != []


def prover_problem(jamming_w: float, start_value: float) -> Problem:
    """The paper's scene with a start of a given value; its pose does not matter here."""
    scene = certified.paper_scene(jamming_w)
    axis = np.array([0.0, 0.6, 0.8])
    problem = certified._problem(scene, Pose.from_axis([0.0, 25.0, 8.0], axis), 1.0)
    return Problem(**(asdict(problem) | {"start_value": start_value}))


@pytest.mark.parametrize("jamming_w", [50.0, 1000.0])
def test_no_pose_as_good_as_the_start_is_cut_away(jamming_w: float) -> None:
    """Box, reach and level of the provers' problem hold for every pose at least as good as the start."""
    scaled, scene = Scaled(problem=prover_problem(jamming_w, 0.7)), certified.paper_scene(jamming_w)
    rng, good = np.random.default_rng(0), 0
    for _ in range(5_000):
        position_m = rng.uniform((-15.0, 18.0, 8.0), (8.0, 32.0, 12.0))
        towards = np.array(scaled.problem.jammer_m) - position_m
        axis = towards / np.linalg.norm(towards) + rng.normal(scale=0.5 / math.sqrt(jamming_w), size=3)
        value = min_sinr(scene, Pose.from_axis(position_m, axis))
        if value < 0.7:
            continue
        good += 1
        p, (low, high) = position_m / scaled.unit_m, scaled.box
        assert np.all((low <= p) & (p <= high))
        assert np.all(np.sum((scaled.nodes - p) ** 2, axis=1) <= scaled.reaches)
        assert value <= scaled.level_high
    assert good > 200


def test_broken_promises_are_faults() -> None:
    """A bound below its value, one that is too wide, and a scene in which another method finds more."""
    row = {"scene": "a", "status": "certified", "value": 2.0, "bound": 2.0 * (1.0 + 0.5 * proofs.GAP)}
    assert proofs.faults([row]) == []
    assert proofs.faults([row | {"bound": 1.9}, row | {"bound": 2.1}])[0].startswith("a: ")
    row = {"scene": "a", "nodes": 2, "method": "nullpose, search alone", "stage": "solve", "seconds": 0.1}
    rows = [row | {"value": 1.0}, row | {"method": "reference", "value": 1.1}]
    assert fields.faults(rows) == ["0 of 1 hits"]
    assert len(set(field_scenes(quick=False))) == 200


def test_the_page_is_that_of_the_stored_results(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """docs/benchmarks.md is what `results.json` says."""
    committed = PAGE.read_text(encoding="utf-8")
    monkeypatch.setattr("benchmarks.page.PAGE", tmp_path / "page.md")
    write_page()
    assert (tmp_path / "page.md").read_text(encoding="utf-8") == committed
    assert RESULTS.exists()
    assert markdown(certified.tables([TRUE | {"method": "nullpose"}, TRUE])["Time of a true claim, ms"])


@pytest.mark.parametrize("arguments", [["no-such"], ["--quick", "--page"]])
def test_senseless_command_is_refused(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    """Exit code 2 and the reason, before anything runs."""
    with pytest.raises(SystemExit, match="2"):
        main(arguments)
    assert capsys.readouterr().err


def test_late_or_uncertified_steps_of_a_tracker_break_a_promise() -> None:
    """Scenes of two nodes have two milliseconds in the median, those of ten have forty."""
    good = {"scene": "circle", "nodes": 2, "steps": 9, "certified": 9} | {
        "median_thread_ms": 1.0,
        "p99.9_thread_ms": 4.0,
    }
    slow = good | {"median_thread_ms": 30.0}
    rows = [good, slow, slow | {"nodes": 10}, good | {"certified": 8}, good | {"p99.9_thread_ms": 11.0}]
    assert tracker.faults(rows[:1] + rows[2:3]) == []
    assert [fault.split(",")[0] for fault in tracker.faults(rows)] == [
        "circle: 9 of 9 certified",
        "circle: 8 of 9 certified",
        "circle: 9 of 9 certified",
    ]


def test_the_jammer_that_passes_makes_the_pose_jump() -> None:
    """In a run of steps that are further apart, too, and every step of it is certified."""
    named = {name: (scene, jammers_m) for name, scene, jammers_m in tracker._scenes()}
    row = tracker._followed("cross", *named["cross, P_M/P = 1"], steps=200)
    assert row["jumps"] >= 1
    assert row["certified"] == 200
