"""The relay: the smaller of the nodes' SINR at the drone and of the drone's SNR at the destination."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from benchmarks.soundness.check import check_scene
from benchmarks.soundness.features import make_feature_scene
from hypothesis import given, strategies as st
from sizes import and_slow, chosen, few_examples

from nullpose.certificate import verify
from nullpose.physics import Pose, destination_snr, evaluate, node_snr, objective_value, sinr
from nullpose.scenario import Jammer, Scenario, load
from nullpose.solver import Result, solve
from nullpose.solver.certificate_from_proof import certificate_of

NODES = [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}, {"position_m": [0.0, 50.0, 0.0], "power_w": 1.0}]
END = {"position_m": [60.0, 10.0, 0.0], "noise_w": 2e-3}


def relay(**tables: Any) -> Scenario:
    """Return the paper's scene with a destination, with other tables; None takes one away."""
    data = {
        "objective": "relay",
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "transmitter": {"power_w": 2.0},
        "nodes": NODES,
        "jammers": [{"position_m": [17.0, 15.0, 4.0], "power_w": 1.0}],
        "destination": END,
    }
    return Scenario.from_dict({key: each for key, each in (data | tables).items() if each is not None})


def hops_alone(scenario: Scenario) -> tuple[Scenario, Scenario]:
    """Return the scenes of each hop: the drone hears the nodes; it sends to a node at the destination."""
    raw = scenario.to_dict()
    transmitter, end = raw.pop("transmitter"), raw.pop("destination")
    heard = raw | {"objective": "min-sinr"}
    return Scenario.from_dict(heard), Scenario.from_dict(
        raw | {"objective": "downlink", "transmitter": transmitter, "nodes": [end]}
    )


def relays(*numbers: int) -> list[Scenario]:
    """Return random relays that are solved by the optimum and leave the airspace as it is."""
    return [make_feature_scene("relay", number).scenario for number in numbers]


@given(seed=st.integers(0, 2**32 - 1))
def test_links_are_those_of_both_hops(seed: int) -> None:
    """The links are the nodes' at the drone, and then that of a node that receives at the destination."""
    scenario = relay(destination=END | {"antenna": "dipole", "antenna_axis": [1.0, 2.0, 0.5]})
    rng = np.random.default_rng(seed)
    pose = Pose(rng.uniform([-60.0, -60.0, 8.0], [60.0, 60.0, 30.0]), *rng.uniform(-1.0, 1.0, 3))
    at = (pose.position_m, pose.antenna_axis)
    ratios = [link.sinr for link in evaluate(scenario, pose)]
    hears, sends = hops_alone(scenario)
    np.testing.assert_allclose(ratios, [*sinr(hears, *at), *node_snr(sends, *at)], rtol=1e-14)
    assert destination_snr(scenario, *at) == ratios[-1:]


@pytest.mark.parametrize("scheme", ["optimum", "vertical"])
def test_a_strong_drone_leaves_the_first_hop(scheme: str) -> None:
    """With a drone of a trillion watts the value is that of the drone that only receives."""
    strong = solve(relay(transmitter={"power_w": 1e12}), scheme)
    hears, _ = hops_alone(relay())
    assert strong.objective.value == pytest.approx(solve(hears, scheme).objective.value, rel=2e-6)


@pytest.mark.parametrize("number", chosen(range(6), [0, 1, 3]))
def test_no_relay_is_better_than_a_hop_alone(number: int) -> None:
    """What a relay gives is at most the bound of each hop that is alone in the same airspace."""
    (scenario,) = relays(number)
    value = solve(scenario, certify=False).objective.value
    for hop in hops_alone(scenario):
        # a hop alone need not stay clear of the other's points, which only gives it more poses
        bound = solve(hop, gap=1e-3).objective.upper_bound
        assert bound is not None
        assert value <= bound * (1.0 + 1e-9)


@pytest.mark.parametrize("number", and_slow(range(2), range(2, 12)))
def test_random_relays_are_sound(number: int) -> None:
    """No search exceeds a bound, certificates verify, and no answer is below that of the search alone."""
    assert check_scene(make_feature_scene("relay", number), starts=60).faults == ()


def test_the_smaller_hop_counts_by_its_margin() -> None:
    """A destination that asks for half of what the nodes ask counts as if its noise were half as much."""
    halved = relay(destination=END | {"noise_w": 1e-3, "jamming_w": 1e-9})
    asked = relay(destination=END | {"noise_w": 2e-3, "jamming_w": 2e-9, "weight": 0.5})
    pose = Pose([20.0, 20.0, 12.0], 0.3, -0.8)
    assert evaluate(asked, pose)[-1].margin == pytest.approx(evaluate(halved, pose)[-1].sinr, rel=1e-12)
    assert evaluate(asked, pose)[0].margin == evaluate(halved, pose)[0].sinr


def test_jamming_at_the_destination_is_as_at_a_node_that_receives() -> None:
    """It is worked out of the jammers in line of sight, unless it is stated."""
    scenario = relay()
    _, sends = hops_alone(scenario)
    assert scenario.destination_noise_w.tolist() == sends.node_noise_w.tolist()
    assert scenario.destination_noise_w[0] > 2e-3
    quiet = relay(destination=END | {"jamming_w": 1e-3})
    assert quiet.destination_noise_w.tolist() == [3e-3]


@pytest.mark.parametrize("scheme", ["optimum", "vertical", "zero-interference"])
def test_certificates_are_verified(scheme: str) -> None:
    """The verifier accepts a relay's proof under each scheme, and none of another destination."""
    result = solve(relay(), scheme, gap=1e-3)
    certificate = certificate_of(result)
    verdict = verify(certificate)
    assert verdict.proved
    assert "every node and the destination an SINR" in verdict.message
    moved = relay(destination=END | {"position_m": [61.0, 10.0, 0.0]})
    assert not verify(replace(certificate, scenario=moved)).proved


@pytest.fixture(scope="module")
def one_node() -> Result:
    """The optimum of a relay with one node, without jammers."""
    return solve(relay(nodes=NODES[:1], jammers=None, destination=END | {"noise_w": 1e-3}))


def test_maximum_gain_serves_both_ends(one_node: Result) -> None:
    """With one node and the destination the axis is broadside to both: the optimum where nobody jams."""
    gain = solve(one_node.scenario, "maximum-gain")
    assert gain.objective.value == pytest.approx(one_node.objective.value, rel=1e-5)
    ends_m = one_node.scenario.terminal_positions_m - gain.pose.position_m
    np.testing.assert_allclose(ends_m @ gain.pose.antenna_axis, 0.0, atol=1e-4)


def test_robust_poses_guarantee_both_hops() -> None:
    """The guaranteed value of a robust relay is at most that of each terminal, the destination among them."""
    scenario = relay(receiver={"noise_w": 1e-3, "reference_gain_db": 0.0, "attitude_error_deg": 3.0})
    result = solve(scenario, robust=True, gap=1e-2)
    ratios = result.details.robust.guarantee.ratios
    assert [ratio.node for ratio in ratios] == ["S1", "S2", "destination"]
    assert all(ratio.lower <= ratio.nominal for ratio in ratios)
    assert result.objective.value <= solve(scenario).objective.value


@few_examples(5)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_destination_is_kept_clear_of(seed: int) -> None:
    """No pose of a relay is nearer to the destination than the keep-out radius, be it as strong as it may."""
    rng = np.random.default_rng(seed)
    place = [*rng.uniform(0.0, 40.0, 2).tolist(), 12.0]
    scenario = relay(
        destination={"position_m": place, "noise_w": 1.0, "jamming_w": 1e-6},
        airspace={"altitude_m": [8.0, 30.0], "keep_out_m": 3.0},
        jammers=[Jammer(name="M", position_m=[17.0, 15.0, 4.0], power_w=1e-3).to_dict()],
    )
    pose = solve(scenario, certify=False).pose
    assert np.linalg.norm(pose.position_m - place) >= 3.0 * (1.0 - 1e-9)


@pytest.fixture(scope="module")
def town() -> Scenario:
    """The town whose buildings hide nodes, with a destination in it."""
    more = {"objective": "relay", "transmitter": {"power_dbm": 10.0}}
    end = {"position_m": [5.0, -75.0, 2.0], "noise_dbm": -95.0}
    return Scenario.from_dict(load("examples/town.toml").to_dict() | more | {"destination": end})


def test_buildings_hide_the_destination_like_a_node(town: Scenario) -> None:
    """Its link is clear and blocked where that of a node at its place is, and no pose exceeds the bound."""
    rng, result = np.random.default_rng(5), solve(town, gap=1.0)
    low_m, high_m = [-100.0, -100.0, 20.0], [100.0, 100.0, 120.0]
    positions_m = rng.uniform(low_m, high_m, (2000, 3))
    positions_m[1000:] = rng.normal(result.pose.position_m, 5.0, (1000, 3)).clip(low_m, high_m)
    positions_m = positions_m[town.open_airspace.allows(positions_m)]
    axes = rng.normal(size=positions_m.shape)
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    _, sends = hops_alone(town)
    snr = destination_snr(town, positions_m, axes)
    np.testing.assert_array_equal(snr, node_snr(sends, positions_m, axes))
    clear = snr / destination_snr(town.model_copy(update={"buildings": ()}), positions_m, axes)
    assert 0.02 < np.mean(clear < 0.9) < 0.98
    values = objective_value(town, positions_m, axes)
    assert np.max(values) <= result.objective.upper_bound
    assert result.objective.value == objective_value(town, result.pose.position_m, result.pose.antenna_axis)
