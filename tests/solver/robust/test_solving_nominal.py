"""What a robust solve says of poses without errors agrees with what a solve says."""

import pytest

import nullpose


@pytest.mark.parametrize("depth_db", [None, 20.0])
def test_the_best_pose_without_errors_has_the_value_that_solve_finds(depth_db):
    """The column without errors has the stated antennas, also where a guarantee counts worse ones."""
    scenario = nullpose.load("examples/whips.toml")
    changes = ["receiver.attitude_error_deg=1"]
    changes += (
        [] if depth_db is None else [f"{each}.null_depth_db={depth_db}" for each in ("nodes.S1", "nodes.S2")]
    )
    uncertain = nullpose.apply_overrides(scenario, changes)
    robust = nullpose.solve(uncertain, robust=True, certify=False)
    best = nullpose.solve(uncertain, certify=False)
    assert robust.details.nominal.nominal == pytest.approx(best.objective.value, rel=1e-6)
    assert robust.details.robust.nominal == pytest.approx(
        nullpose.min_sinr(uncertain, robust.pose), rel=1e-12
    )
