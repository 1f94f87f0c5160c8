"""The five-dimensional problem and the peers that need nothing beyond SciPy."""

import numpy as np
import pytest
from benchmarks.peers import GENERAL_PURPOSE, PEERS, TAILORED, Budget, FivePose, Peer
from benchmarks.peers.epigraph import climb
from benchmarks.workloads.fields.labels import LABELS, LOOKS
from benchmarks.workloads.fields.scenes import Scene

from nullpose.physics import Pose, min_sinr, sinr
from nullpose.scenario import Scenario

SCENE = Scene(nodes=5, jammers=3, jamming_ratio=10.0, seed=1)
BUDGET = Budget(evaluations=2_000, starts=8, samples=64)


@pytest.fixture(scope="module")
def problem() -> FivePose:
    """One scene for all tests but those that count."""
    return FivePose.of(SCENE.scenario())


def points(count: int) -> np.ndarray:
    """Return scaled poses at random."""
    return np.random.default_rng(3).uniform(size=(count, 5))


def test_cost_is_the_physics(problem: FivePose) -> None:
    """The compiled cost is minus the log of the smallest SINR of the pose that the five numbers stand for."""
    for x in points(20):
        position_m = np.array([-25.0, -25.0, 8.0]) + x[:3] * np.array([150.0, 150.0, 22.0])
        pose = Pose(position_m, np.pi * (x[3] - 0.5), np.pi * (x[4] - 0.5))
        assert -problem.cost(x) == pytest.approx(np.log(min_sinr(problem.scenario, pose)), rel=1e-12)
        assert problem.value(x) == pytest.approx(np.exp(-problem.cost(x)), rel=1e-12)


def test_many_costs_are_the_single_ones(problem: FivePose) -> None:
    """A population's costs are those of its members."""
    xs = points(20)
    assert np.array_equal(problem.costs(xs), [problem.cost(x) for x in xs])


def test_slopes_are_those_of_the_ratios(problem: FivePose) -> None:
    """The ratios are every node's, and their slopes agree with central differences."""
    step = 1e-6
    for x in points(5):
        logs, slopes = problem.ratios_and_slopes(x)
        pose = problem.pose(x)
        expected = np.log(sinr(problem.scenario, pose.position_m, pose.antenna_axis))
        assert logs == pytest.approx(expected, rel=1e-11)
        for i, direction in enumerate(np.eye(5)):
            ahead = problem.ratios_and_slopes(x + step * direction)[0]
            behind = problem.ratios_and_slopes(x - step * direction)[0]
            # the differences lose half of the digits, more where the slope is large
            assert slopes[:, i] == pytest.approx((ahead - behind) / (2 * step), rel=1e-4, abs=1e-4)


def test_evaluations_are_counted() -> None:
    """Every pose evaluated counts once, a population as many times as it has members."""
    problem = FivePose.of(SCENE.scenario())
    problem.cost(points(1)[0])
    problem.costs(points(7))
    problem.ratios_and_slopes(points(1)[0])
    assert problem.evaluations == 9


def test_unbounded_scene_is_refused() -> None:
    """A scene without bounds on x and y has no five-dimensional box."""
    with pytest.raises(ValueError, match="bounded on every side"):
        FivePose.of(SCENE.scenario(boxed=False))


def test_climb_never_loses(problem: FivePose) -> None:
    """The polish returns something at least as good as its start, inside the airspace."""
    for start in points(10):
        end = climb(problem, start)
        assert problem.cost(end) <= problem.cost(start)
        assert np.all((end[:3] >= 0.0) & (end[:3] <= 1.0))


@pytest.mark.parametrize(
    "peer", [peer for peer in PEERS if peer.name != "cma-es"], ids=lambda peer: peer.name
)
def test_peer_answers_within_its_budget(peer: Peer, problem: FivePose) -> None:
    """A peer's answers get better from stage to stage, repeat with the seed, and cost about what they may."""
    first, again = (
        [(answer.stage, problem.value(answer.x)) for answer in peer.answers(fresh, BUDGET, 0)]
        for fresh in (FivePose.of(problem.scenario), FivePose.of(problem.scenario))
    )
    assert first == again
    values = [value for _, value in first]
    assert values == sorted(values)
    assert values[-1] > 0.0


def test_peers_are_told_apart() -> None:
    """Names are unique, each peer is general or tailored, and each has a label and a look of its own."""
    names = [peer.name for peer in PEERS]
    assert len(set(names)) == len(names)
    assert set(names) == GENERAL_PURPOSE | TAILORED
    assert set(names) <= set(LABELS)
    assert len(set(LOOKS.values())) == len(LOOKS) == len(names) + 2  # nullpose, with its proof and without


def test_strong_peer_finds_the_papers_optimum() -> None:
    """The multistart reaches the paper scenario's known optimum at P_M/P = 1, 0.9836997 dB."""
    scenario = Scenario.from_dict(
        {
            "airspace": {"altitude_m": (8.0, 30.0), "x_m": (-60.0, 80.0), "y_m": (-40.0, 90.0)},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [{"position_m": (0.0, y, 0.0), "power_w": 1.0} for y in (0.0, 50.0)],
            "jammers": [{"position_m": (17.0, 15.0, 4.0), "power_w": 1.0}],
        }
    )
    problem = FivePose.of(scenario)
    multistart = next(peer for peer in PEERS if peer.name == "multistart-slsqp")
    *_, last = multistart.answers(problem, BUDGET, 0)
    assert 10.0 * np.log10(problem.value(last.x)) == pytest.approx(0.9836997, abs=5e-8)
