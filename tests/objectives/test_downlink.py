"""The downlink: the smallest SNR of the drone's signal at the nodes."""

from typing import Any

import numpy as np
import pytest
from benchmarks.soundness.check import check_scene
from benchmarks.soundness.features import make_feature_scene
from sizes import and_slow

from nullpose.physics import Pose, evaluate
from nullpose.scenario import Scenario
from nullpose.solver import solve, solve_many


def downlink(**tables: Any) -> Scenario:
    """Return a scene in which the drone sends to the nodes, with other tables."""
    data = {
        "objective": "downlink",
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 3.0},
        "transmitter": {"power_w": 0.7},
        "nodes": [{"position_m": [5.0, -3.0, 1.0]}, {"position_m": [40.0, 30.0, 0.0], "noise_dbm": -2.0}],
    }
    return Scenario.from_dict(data | tables)


@pytest.mark.parametrize("keep_out_m", [1.0, 11.0])
def test_one_node_is_served_from_above(keep_out_m: float) -> None:
    """Straight above at the lowest altitude, or on the keep-out ball, the axis broadside: a closed form."""
    airspace = {"altitude_m": [8.0, 30.0], "keep_out_m": keep_out_m}
    scenario = downlink(airspace=airspace, nodes=[{"position_m": [5.0, -3.0, 1.0], "noise_w": 2e-3}])
    result = solve(scenario)
    near_m = max(7.0, keep_out_m)
    assert result.objective.name == "min_snr"
    assert result.objective.value == pytest.approx(10.0**0.3 * 0.7 / near_m**2 / 2e-3, rel=1e-6)
    away_m = result.pose.position_m - [5.0, -3.0, 1.0]
    assert np.linalg.norm(away_m) == pytest.approx(near_m, rel=1e-6)
    assert result.pose.antenna_axis @ away_m == pytest.approx(0.0, abs=1e-3 * near_m)


def test_jamming_counts_as_noise_at_the_nodes() -> None:
    """A jammer raises the noise of each node by what it gets there in sight, and stands in no ratio."""
    jammer = {"position_m": [20.0, 20.0, 0.0], "power_w": 2.0}
    scenario, pose = downlink(jammers=[jammer]), Pose([20.0, 5.0, 12.0], 0.2, 1.1)
    quiet, noise_w = evaluate(downlink(), pose), np.array([1e-3, 10.0**-0.2 * 1e-3])
    squares_m2 = np.sum((scenario.node_positions_m - jammer["position_m"]) ** 2, axis=1)
    share = noise_w / (noise_w + 10.0**0.3 * 2.0 / squares_m2)
    ratios = [link.sinr for link in evaluate(scenario, pose)]
    np.testing.assert_allclose(ratios, share * [link.sinr for link in quiet], rtol=1e-12)
    assert len(scenario.objective_record.ratios(scenario).denominator_weight) == 0


def test_margins_are_those_of_the_snr() -> None:
    """A requirement divides the node's SNR, as it divides the SINR where the drone receives."""
    nodes = [{"position_m": [5.0, -3.0, 1.0], "min_sinr_db": 6.0}, {"position_m": [40.0, 30.0, 0.0]}]
    result = solve(downlink(nodes=nodes), gap=1e-4)
    first, second = result.links
    assert result.objective.name == "min_snr_margin"
    assert first.margin_db == pytest.approx(first.sinr_db - 6.0, abs=1e-12)
    assert result.objective.value == min(first.margin, second.margin)


def test_many_downlinks_are_solved_together() -> None:
    """``solve_many`` gives the values of ``solve``."""
    scenes = [downlink(), downlink(transmitter={"power_w": 1.4})]
    many = solve_many(scenes, gap=1e-4)
    assert many.value[1, 0] == pytest.approx(2.0 * many.value[0, 0], rel=2e-4)
    assert many.value[0, 0] == pytest.approx(solve(scenes[0], gap=1e-4).objective.value, rel=2e-4)


@pytest.mark.parametrize("number", and_slow(range(2), range(2, 12)))
def test_random_downlinks_are_sound(number: int) -> None:
    """No search exceeds a bound, certificates verify, and no answer is below that of the search alone."""
    assert check_scene(make_feature_scene("downlink", number), starts=60).faults == ()
