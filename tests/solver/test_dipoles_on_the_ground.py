"""Scenes with dipoles on the ground, solved and certified."""

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import and_slow, chosen, diagonal, few_examples

from nullpose.certificate import verify
from nullpose.physics import objective_value
from nullpose.scenario import Scenario
from nullpose.solver import solve
from nullpose.solver.certificate_from_proof import certificate_of

WHIPS = {  # P_M/P: best smallest SINR with upright dipoles at nodes and jammer; three seeds of another solver
    0.001: 1.1915637,
    0.01: 1.1684161,
    0.1: 1.0046481,
    1.0: 0.6539631,
    10.0: 0.6475212,
    100.0: 0.6468280,
}
SCHEMES = ["optimum", "vertical", "zero-interference", "maximum-gain"]


def with_antennas(scenario: Scenario, kinds: tuple[str, ...] = ("nodes", "jammers"), **keys: Any) -> Scenario:
    """Return a scenario whose points of some kinds have these antennas."""
    data = scenario.to_dict()
    for kind in kinds:
        for point in data[kind]:
            point.update(keys or {"antenna": "dipole"})
    return Scenario.from_dict(data)


@pytest.mark.parametrize(("ratio", "value"), and_slow(list(WHIPS.items())[:1], list(WHIPS.items())[1:]))
def test_whips_have_their_known_optimum(ratio: float, value: float, paper: Callable) -> None:
    """The paper's scene with upright dipoles at both ends, certified, and proved by the verifier."""
    solution = solve(with_antennas(paper(ratio)), gap=1e-6)
    assert solution.status == "certified"
    assert solution.objective.value == pytest.approx(value, abs=1e-7)
    assert solution.objective.relative_gap <= 1e-6
    assert verify(certificate_of(solution)).proved


@pytest.mark.parametrize(
    ("scheme", "kinds", "null_depth_db"),
    diagonal(SCHEMES, [("nodes",), ("jammers",), ("nodes", "jammers")], [None, 25.0]),
)
def test_every_case_is_certified(
    scheme: str, kinds: tuple[str, ...], null_depth_db: float | None, paper: Callable
) -> None:
    """Dipoles tilted anyhow, at nodes, at jammers or at both, with a perfect null and without one."""
    scenario = with_antennas(paper(1.0), kinds, antenna="dipole", antenna_axis=[0.3, -0.2, 1.0])
    if null_depth_db is not None:
        data = scenario.to_dict() | {"antenna": {"null_depth_db": null_depth_db}}
        scenario = Scenario.from_dict(data)
    solution = solve(scenario, scheme, gap=1e-3)
    assert solution.status == "certified"
    assert verify(certificate_of(solution)).proved


@pytest.mark.parametrize("null_depth_db", [None, 25.0])
@pytest.mark.parametrize(
    ("scheme", "gap"), and_slow([("optimum", 1.0), ("zero-interference", 0.3)], product(SCHEMES, [1e-3]))
)
def test_whips_that_leak_are_certified(
    scheme: str, null_depth_db: float | None, gap: float, paper: Callable
) -> None:
    """With the null of the drone perfect and not, at nodes and jammers; the verifier finds the same."""
    data = with_antennas(paper(100.0), antenna="dipole", null_depth_db=20.0).to_dict()
    if null_depth_db is not None:
        data["antenna"] = {"null_depth_db": null_depth_db}
    solution = solve(Scenario.from_dict(data), scheme, gap=gap)
    assert solution.status == "certified"
    assert verify(certificate_of(solution)).proved


def test_between_a_perfect_null_and_none(paper: Callable) -> None:
    """The best value with a null of 0 dB is that with isotropic antennas, with one of 200 dB the perfect."""
    whips, plain = solve(with_antennas(paper(1.0)), gap=1e-4), solve(paper(1.0), gap=1e-4)
    for depth, limit in ((0.0, plain), (200.0, whips)):
        solution = solve(with_antennas(paper(1.0), antenna="dipole", null_depth_db=depth), gap=1e-4)
        assert solution.objective.value == pytest.approx(limit.objective.value, rel=2e-4)


def test_no_needle_is_left_straight_above_a_whip(paper: Callable) -> None:
    """A level dipole above the jammer's whip hears what leaks: not both nulls, whatever the power."""
    strong = with_antennas(paper(1e6), ("jammers",), antenna="dipole", null_depth_db=30.0)
    perfect = with_antennas(paper(1e6), ("jammers",), antenna="dipole")
    place_m, axis = np.array([17.0, 15.0, 8.0]), np.array([0.0, 1.0, 0.0])
    values = [float(objective_value(one, place_m, axis)) for one in (strong, perfect)]
    assert values[1] > 1e3 * values[0]
    isotropic = paper(1e3)
    assert values[0] == pytest.approx(float(objective_value(isotropic, place_m, axis)), rel=1e-9)


@pytest.mark.parametrize("depth", chosen([15.0, 25.0], [0]))
def test_a_certificate_for_another_leak_is_refused(depth: float, paper: Callable) -> None:
    """The pose's value and the bound are those of the stated depth: with another one the claim is false."""
    from dataclasses import replace

    certificate = certificate_of(
        solve(with_antennas(paper(9.0), antenna="dipole", null_depth_db=20.0), gap=0.3)
    )
    assert verify(certificate).proved
    other = with_antennas(paper(9.0), antenna="dipole", null_depth_db=depth)
    assert not verify(replace(certificate, scenario=other)).proved
    value = solve(other, certify=False).objective.value
    spoiled = replace(certificate, scenario=other, value=0.9 * value, upper_bound=0.95 * value)
    assert not verify(spoiled).proved


@pytest.mark.parametrize("ratio", chosen([0.01, 1.0, 100.0], [1]))
def test_circular_antennas_are_twice_the_noise(ratio: float, paper: Callable) -> None:
    """Half the power of nodes and jammers alike is what twice the noise is, to the last bit."""
    circular = solve(with_antennas(paper(ratio), antenna="circular"), gap=1e-6)
    data = paper(ratio).to_dict()
    data["receiver"]["noise_w"] *= 2.0
    noisy = solve(Scenario.from_dict(data), gap=1e-6)
    assert circular.objective.value == noisy.objective.value
    assert circular.objective.upper_bound == noisy.objective.upper_bound
    assert circular.pose.position_m.tolist() == noisy.pose.position_m.tolist()


@given(seed=st.integers(0, 2**32 - 1))
@few_examples(5)
def test_no_pose_exceeds_the_bound(seed: int, random_scene: Callable) -> None:
    """On random fields with dipoles anyhow the bound is above every pose of a search, the pose's own too."""
    rng = np.random.default_rng(seed)
    data = random_scene(rng, int(rng.integers(1, 5)), int(rng.integers(0, 3))).to_dict()
    for point in [*data["nodes"], *data.get("jammers", [])]:
        if rng.random() < 0.7:
            point["antenna"], point["antenna_axis"] = "dipole", rng.normal(size=3).tolist()
            if rng.random() < 0.5:
                point["null_depth_db"] = float(rng.uniform(3.0, 40.0))
    if rng.random() < 0.5:
        data["antenna"] = {"null_depth_db": float(rng.uniform(15.0, 40.0))}
    scenario = Scenario.from_dict(data)
    solution = solve(scenario, gap=1e-2, node_limit=100_000)
    bound = solution.objective.upper_bound
    assert bound is not None
    assert solution.objective.value <= bound
    places = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 30.0], (4000, 3))
    places[:2000] = solution.pose.position_m + rng.normal(size=(2000, 3)) * 10.0 ** rng.uniform(
        -4, 1, (2000, 1)
    )
    places[:, 2] = np.clip(places[:, 2], 8.0, 30.0)
    axes = rng.normal(size=(4000, 3))
    axes[:1000] = solution.pose.antenna_axis + 0.1 * axes[:1000]
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    assert objective_value(scenario, places, axes).max() <= bound
    assert verify(certificate_of(solution)).proved


def test_secrecy_and_airframes_know_dipoles(paper: Callable) -> None:
    """An eavesdropper with a whip, a vehicle that tilts a little, a keep-out ball: certified and proved."""
    data = with_antennas(paper(1.0), ("nodes",)).to_dict()
    data["airframe"] = {"tilt_max_deg": 20.0}
    tilted = solve(Scenario.from_dict(data), gap=0.2)
    assert tilted.status == "certified"
    assert verify(certificate_of(tilted)).proved
    del data["airframe"], data["jammers"]
    data |= {
        "objective": "secrecy-rate",
        "transmitter": {"power_w": 1.0},
        "eavesdroppers": [{"position_m": [17.0, 15.0, 4.0], "antenna": "dipole", "null_depth_db": 20.0}],
    }
    for node in data["nodes"]:
        del node["power_w"]
    secret = solve(Scenario.from_dict(data), gap=0.2)
    assert secret.status == "certified"
    assert verify(certificate_of(secret)).proved
