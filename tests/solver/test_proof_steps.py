"""The steps of a proof shown again: boxes that close in on the pose."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import nullpose
from nullpose.physics import evaluate
from nullpose.solver import Result, best_axis
from nullpose.solver.proof_steps import ProofStep, has_proof_steps, proof_steps

EXAMPLES = Path(__file__).parents[2] / "examples"
Example = tuple[Result, tuple[ProofStep, ...]]
CASES = [
    ("paper", "optimum"),
    ("paper", "vertical"),
    ("field", "optimum"),
    ("field", "zero-interference"),  # one tree for each jammer
    ("airframe", "optimum"),
    ("eavesdropper", "optimum"),
    ("no-fly", "optimum"),
]


def solved(name: str, scheme: str) -> Result:
    """Return an example's result."""
    return nullpose.solve(nullpose.load(EXAMPLES / f"{name}.toml"), scheme, threads=1)


@pytest.fixture(scope="module", params=CASES, ids="-".join)
def example(request: pytest.FixtureRequest) -> Example:
    """A result and the steps of its proof."""
    result = solved(*request.param)
    return result, proof_steps(result)


def test_the_bound_falls_from_twice_the_value_to_the_one_proved(example: Example) -> None:
    """The gaps fall to that of the result, where no box is left."""
    result, steps = example
    value, bound = result.objective.value, result.objective.upper_bound
    gap = 2.0 ** (bound - value) - 1.0 if result.objective.quantity.is_rate else bound / value - 1.0
    gaps = [step.gap for step in steps]
    assert gaps[0] > 0.3
    assert gaps[-1] == pytest.approx(gap, rel=1e-6)
    assert gaps == sorted(gaps, reverse=True)
    assert len(steps[-1].half_m) == 0


def test_the_boxes_left_hold_the_pose_until_none_is_left(example: Example) -> None:
    """The drone is inside of what is drawn."""
    result, steps = example
    assert all(step.holds(result.pose.position_m) for step in steps[:-1])


def test_the_boxes_of_each_step_lie_within_those_of_the_step_before(example: Example) -> None:
    """What was closed is not opened again."""
    _, steps = example
    for before, after in pairwise(steps):
        for middle, half in zip(after.centre_m, after.half_m, strict=True):
            around = np.abs(middle - before.centre_m) + half <= before.half_m * (1.0 + 1e-9) + 1e-9
            assert np.any(np.all(around, axis=1))


def test_what_is_left_shrinks_onto_the_pose(example: Example) -> None:
    """The boxes reach less and less far from the drone."""
    result, steps = example
    reach = [step.reach_m(result.pose.position_m) for step in steps[:-1]]
    assert all(after <= before * (1.0 + 1e-9) for before, after in pairwise(reach))
    assert reach[-1] < 0.5 * reach[0]


def test_no_position_outside_of_the_boxes_left_beats_the_value_by_more_than_the_gap() -> None:
    """Sampled positions with their best axes agree with the boxes."""
    result = solved("paper", "optimum")
    steps, scenario = proof_steps(result), result.scenario
    near = np.random.default_rng(1).normal(0.0, 3.0, (400, 3)) + result.pose.position_m
    wide = np.random.default_rng(2).uniform([-40.0, -20.0, 8.0], [40.0, 70.0, 30.0], (400, 3))
    positions = [p for p in np.vstack([near, wide]) if 8.0 <= p[2] <= 30.0]
    best = np.array([min(x.sinr for x in evaluate(scenario, best_axis(scenario, p))) for p in positions])
    value, last = result.objective.value, steps[-1].gap
    for step in steps:
        outside = np.array([not step.holds(p) for p in positions])
        assert np.all(best[outside] <= value * (1.0 + last))
        assert np.all(best <= value * (1.0 + step.gap))


def test_an_antenna_with_a_pattern_has_steps_too() -> None:
    """An antenna whose proof keeps no boxes is proved again."""
    scenario = nullpose.load(EXAMPLES / "frame.toml")
    result = nullpose.solve(scenario, gap=0.3, threads=1)
    steps = proof_steps(result)
    assert has_proof_steps(result)
    assert len(steps) > 2
    assert all(step.holds(result.pose.position_m) for step in steps[:-1])


def test_a_result_without_a_proof_of_its_own_has_no_steps() -> None:
    """Nothing proved, or only of other axes: there is nothing to show."""
    assert not has_proof_steps(nullpose.solve(nullpose.load(EXAMPLES / "paper.toml"), certify=False))
    assert not has_proof_steps(solved("field", "maximum-gain"))  # its bound is that of any axis


def test_what_the_caller_raises_ends_the_work() -> None:
    """A newer scene does not wait."""

    class NewerError(Exception):
        pass

    def go_on() -> None:
        raise NewerError

    with pytest.raises(NewerError):
        proof_steps(solved("paper", "optimum"), go_on)
