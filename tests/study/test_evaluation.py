"""A given pose is told with what it gives, and how far it is below what is proved."""

import math

import numpy as np
import pytest

from nullpose.errors import UsageError
from nullpose.physics import Pose, Poses, min_sinr
from nullpose.scenario import Airframe, Scenario, apply_overrides
from nullpose.solver import solve
from nullpose.study import evaluate_against


def test_distances_are_to_the_bound(paper: Scenario) -> None:
    """Each pose's value is that of the physics, and its distance is what is left to the proved bound."""
    best = solve(paper)
    rng = np.random.default_rng(5)
    poses = Poses(rng.uniform([-20, -20, 8], [60, 60, 30], (30, 3)), *rng.uniform(-3, 3, (2, 30)))
    bound_db = 10.0 * math.log10(best.objective.upper_bound)
    for pose, one in zip(poses, evaluate_against(best, poses).results, strict=True):
        assert one.objective.value == min_sinr(paper, pose)
        assert one.objective.upper_bound == best.objective.upper_bound
        assert one.details.below_bound == pytest.approx(bound_db - one.objective.value_db, abs=1e-9)
        assert one.details.below_bound > 0.0
        assert one.details.not_allowed == ()
    (same,) = evaluate_against(best, [best.pose]).results
    assert same.objective.value == pytest.approx(best.objective.value, rel=1e-12)
    assert 0.0 <= same.details.below_bound < 1e-5
    assert set(best.to_dict()) <= set(same.to_dict())


def test_a_pose_that_is_not_allowed_has_no_bound(paper: Scenario) -> None:
    """The bound is on poses that the vehicle may take; each reason against the others is told."""
    level = Airframe(tilt_max_deg=10.0, mount_deg=90.0)
    best = solve(paper.model_copy(update={"airframe": level}), certify=False)
    poses = [Pose([3.0, 24.0, 4.0], 0.0, 0.5, 0.0, level.mount_rad), Pose([0.0, 0.5, 0.0], 0.0, 0.1)]
    low, close = evaluate_against(best, poses).results
    assert low.objective.upper_bound is None
    assert low.details.below_bound is None
    assert low.details.not_allowed[0] == "the position is 4 m outside altitude_m"
    assert "more than the airframe's 10 deg" in low.details.not_allowed[1]
    assert "closer than keep_out_m" in close.details.not_allowed[1]


def test_a_pose_in_a_zone_names_it(paper: Scenario) -> None:
    """Each no-fly zone that a position is in is named, and the fence, with how far it is."""
    changes = [
        'airspace.no_fly=[{name="mast", centre_m=[10, 10], radius_m=5}, '
        '{name="wood", x_m=[8, 30], y_m=[0, 30]}]',
        "airspace.geofence_m=[[-40, -20], [12, -20], [12, 70], [-40, 70]]",
    ]
    best = solve(apply_overrides(paper, changes), certify=False)
    both, fence = evaluate_against(
        best, [Pose([11.0, 10.0, 9.0], 0.0, 0.1), Pose([15.0, 40.0, 9.0], 0.0, 0.1)]
    ).results
    assert both.details.not_allowed == (
        "the position is 4 m inside the no-fly zone mast",
        "the position is 3 m inside the no-fly zone wood",
    )
    assert fence.details.not_allowed == ("the position is 3 m outside the geofence",)


def test_a_ground_point_is_no_place(paper: Scenario) -> None:
    """Nor is there a value where a node is; and arrays have no axis to be given."""
    best = solve(paper, certify=False)
    with pytest.raises(UsageError, match="the position of S2"):
        evaluate_against(best, [Pose([0.0, 50.0, 0.0], 0.0, 0.0)])


def test_rates_are_held_against_their_bound(paper: Scenario) -> None:
    """A secrecy rate's distance is in bits/s/Hz."""
    changes = ["objective=secrecy-rate", "transmitter.power_w=2", "eavesdroppers=[{position_m=[-20,15,4]}]"]
    best = solve(apply_overrides(paper, changes))
    (one,) = evaluate_against(best, [Pose([3.0, 24.0, 9.0], 0.2, -1.1)]).results
    assert one.details.below_bound == pytest.approx(best.objective.upper_bound - one.objective.value)
