"""Friendly jamming: the drone jams eavesdroppers of what sources on the ground send to nodes."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely
from benchmarks.soundness.check import check_scene
from benchmarks.soundness.features import make_feature_scene
from benchmarks.soundness.search import best_value
from hypothesis import given, strategies as st
from scipy.optimize import minimize
from sizes import and_slow

from nullpose.certificate import Certificate, verify
from nullpose.errors import UsageError
from nullpose.physics import Pose, evaluate, objective_value
from nullpose.report.geometry import shadow_outlines_m
from nullpose.scenario import Scenario, apply_overrides
from nullpose.solver import solve
from nullpose.solver.certificate_from_proof import certificate_of

KNOWN = [  # eavesdropper, power of the drone, best rate, position, rate without jamming
    ((30.0, 25.0), 1.0, 0.642329774, (30.41253, 23.96867), -0.0270),
    ((45.0, 8.0), 1.0, 0.640998464, (43.88501, 6.21602), 0.1361),
    ((15.0, 10.0), 10.0, 0.671203854, (16.07122, 9.57151), -1.3270),
]
"""Found apart from nullpose: source at the origin, 1 W, a node 40 m east of it, noise 1 mW, 8 to 30 m."""
FRAME_M = np.array([[-60.0, -60.0], [90.0, 90.0]])


def jammed(eavesdropper_m: tuple[float, float], jamming_w: float, **tables: Any) -> Scenario:
    """Return the scene of the known answers, with other tables."""
    data: dict[str, Any] = {
        "objective": "friendly-jamming",
        "airspace": {"altitude_m": [8.0, 30.0], "x_m": [-150.0, 150.0], "y_m": [-150.0, 150.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "transmitter": {"power_w": jamming_w},
        "sources": [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}],
        "nodes": [{"position_m": [40.0, 0.0, 0.0]}],
        "eavesdroppers": [{"position_m": [*eavesdropper_m, 0.0]}],
    }
    return Scenario.from_dict(data | tables)


def axis_at(angles: np.ndarray) -> np.ndarray:
    """Return the axis of an azimuth and an angle off the zenith."""
    level = np.sin(angles[1])
    return np.array([level * np.cos(angles[0]), level * np.sin(angles[0]), np.cos(angles[1])])


@pytest.mark.parametrize(("eavesdropper_m", "jamming_w", "rate", "position_m", "without"), KNOWN)
def test_physics_has_the_known_answers(
    eavesdropper_m: tuple[float, float],
    jamming_w: float,
    rate: float,
    position_m: tuple[float, float],
    without: float,
) -> None:
    """A search of the physics alone ends at the known rate, and no nearby pose of many is above it."""
    scenario = jammed(eavesdropper_m, jamming_w)

    def loss(x: np.ndarray) -> float:
        return -float(objective_value(scenario, np.array([x[0], x[1], 8.0]), axis_at(x[2:])))

    precise = {"xatol": 1e-9, "fatol": 1e-14, "maxiter": 4000, "maxfev": 4000}
    starts = np.random.default_rng(0).uniform(-1.5, 1.5, (8, 2))
    ends = [minimize(loss, [*position_m, *start], method="Nelder-Mead", options=precise) for start in starts]
    best = min(ends, key=lambda end: float(end.fun))
    assert -best.fun == pytest.approx(rate, abs=1e-9)
    np.testing.assert_allclose(best.x[:2], position_m, atol=1e-4)
    ground = 1.0 + 1e3 / 40.0**2, 1.0 + 1e3 / np.sum(np.square(eavesdropper_m))
    assert np.log2(ground[0] / ground[1]) == pytest.approx(without, abs=1e-4)


@given(seed=st.integers(0, 2**32 - 1))
def test_links_are_the_nodes(seed: int) -> None:
    """Every node's SINR and rate are those of the equation, written out with each source and eavesdropper."""
    rng = np.random.default_rng(seed)

    def spots(count: int) -> list[list[float]]:
        return [[*map(float, rng.uniform(-80.0, 80.0, 2)), 0.0] for _ in range(count)]

    sources = [
        {"position_m": at, "power_w": float(rng.uniform(0.5, 2.0)), "gain_dbi": 2.0} for at in spots(2)
    ]
    listens = rng.integers(2, size=3)
    nodes = [{"position_m": at, "from": f"A{a + 1}"} for at, a in zip(spots(3), listens, strict=True)]
    more = {"eavesdroppers": [{"position_m": at, "noise_w": 2e-3} for at in spots(2)]}
    law = {"model": "power-law", "exponent": 2.5}
    town = {"model": "elevation", "a": 9.0, "b": 0.2, "los_loss_db": 0.0, "nlos_loss_db": 0.0}
    more |= {"channel": law if seed % 2 else law | town | {"average": "power"}}
    scenario = jammed((0.0, 9.0), 3.0, sources=sources, nodes=nodes, **more)
    pose = Pose(rng.uniform([-60.0, -60.0, 8.0], [60.0, 60.0, 30.0]), *rng.uniform(-1.0, 1.0, 3))

    def jamming_w(at_m: list[float]) -> float:
        away = np.array(at_m) - pose.position_m
        square = away @ away
        return float(3.0 * (square - (away @ pose.antenna_axis) ** 2) / square**2.25)

    def signal_w(source: dict[str, Any], at_m: list[float]) -> float:
        distance_m = np.linalg.norm(np.subtract(source["position_m"], at_m))
        return float(source["power_w"] * 10.0**0.2 / distance_m**2.5)

    for link, node, a in zip(evaluate(scenario, pose), nodes, listens, strict=True):
        at_m = node["position_m"]
        sinr = signal_w(sources[a], at_m) / (1e-3 + jamming_w(at_m))
        heard = [
            signal_w(sources[a], each["position_m"]) / (2e-3 + jamming_w(each["position_m"]))
            for each in more["eavesdroppers"]
        ]
        assert link.sinr == pytest.approx(sinr, rel=1e-12)
        rate = max(0.0, np.log2(1.0 + sinr) - np.log2(1.0 + max(heard)))
        assert link.secrecy_rate_bps_hz == pytest.approx(rate, rel=1e-9, abs=1e-12)


def test_buildings_and_sight_leave_ground_links_alone() -> None:
    """Line of sight by elevation changes what the drone sends, not what a source sends along the ground."""
    free, urban = (
        jammed((30.0, 25.0), 1.0),
        {"model": "elevation", "environment": "urban", "average": "power"},
    )
    seen = jammed((30.0, 25.0), 1.0, channel=urban)
    np.testing.assert_array_equal(seen.node_signal_w, free.node_signal_w)
    np.testing.assert_array_equal(seen.overheard_w, free.overheard_w)
    loud = jammed((30.0, 25.0), 1.0, antenna={"kind": "dipole", "gain_dbi": 1.76})
    np.testing.assert_array_equal(loud.overheard_w, free.overheard_w)


def test_what_errs_on_the_safe_side_is_turned_round() -> None:
    """A jammed node counts as in sight and a jammed eavesdropper as out of it, where sight is not known."""
    sure = {"model": "elevation", "environment": "urban", "average": "guaranteed"}
    scenario = jammed((30.0, 25.0), 1.0, channel=sure)
    secret = jammed((30.0, 25.0), 1.0, channel=sure, objective="secrecy-rate", sources=[])
    (node,), (eavesdropper,) = scenario.node_channels.strengths, scenario.eavesdropper_channels.strengths
    assert (node, eavesdropper) == (
        secret.eavesdropper_channels.strengths[0],
        secret.node_channels.strengths[0],
    )
    assert node > eavesdropper
    block = {"polygon_m": [[33.0, 8.0], [36.0, 8.0], [36.0, 16.0], [33.0, 16.0]], "height_m": 20.0}
    for point, grows in ((scenario.nodes[0], False), (scenario.eavesdroppers[0], True)):
        areas = [
            sum(shapely.Polygon(ring).area for ring in shadow_outlines_m(each, point, 10.0, FRAME_M))
            for each in (
                jammed((30.0, 25.0), 1.0, buildings=[block], channel={"shadow_margin_m": margin_m})
                for margin_m in (0.0, 1.0)
            )
        ]
        assert (areas[1] > areas[0]) == grows


def test_written_and_read() -> None:
    """The source that a node listens to is the key ``from``, in files too."""
    sources = [{"position_m": [0.0, y, 0.0], "power_w": 1.0} for y in (0.0, 5.0)]
    scenario = jammed(
        (9.0, 9.0), 1.0, sources=sources, nodes=[{"position_m": [40.0, 0.0, 0.0], "from": "A2"}]
    )
    assert scenario.to_dict()["nodes"][0]["from"] == "A2"
    assert 'from = "A2"' in scenario.to_toml()
    assert Scenario.from_dict(scenario.to_dict()) == scenario
    assert scenario.node_senders.tolist() == [1]


@pytest.mark.parametrize(("eavesdropper_m", "jamming_w", "rate", "position_m"), [row[:4] for row in KNOWN])
def test_known_answers_are_certified_and_verified(
    eavesdropper_m: tuple[float, float], jamming_w: float, rate: float, position_m: tuple[float, float]
) -> None:
    """The solver finds the known rate and position, closes a gap of 1e-4, and the verifier agrees."""
    solution = solve(jammed(eavesdropper_m, jamming_w), gap=1e-4)
    assert solution.objective.value == pytest.approx(rate, abs=1e-8)
    np.testing.assert_allclose(solution.pose.position_m, [*position_m, 8.0], atol=1e-4)
    assert str(solution.status) == "certified"
    assert verify(certificate_of(solution)).proved


@pytest.mark.parametrize("number", and_slow(range(3), range(3, 20)))
def test_random_scenes_are_sound(number: int) -> None:
    """No independent search is above a bound, and each certificate is proved."""
    assert check_scene(make_feature_scene("friendly-jamming", number), starts=60).faults == ()


def test_the_null_is_on_a_node_and_jamming_helps() -> None:
    """With one node the drone's null is towards it, and no drone at all is worse."""
    solution = solve(jammed((30.0, 25.0), 1.0), certify=False)
    to_node = np.array([40.0, 0.0, 0.0]) - solution.pose.position_m
    cosine = abs(to_node @ solution.pose.antenna_axis) / np.linalg.norm(to_node)
    assert cosine == pytest.approx(1.0, abs=1e-3)
    weak = solve(jammed((30.0, 25.0), 1e-9), certify=False)
    assert weak.objective.value == 0.0


def test_more_nodes_and_eavesdroppers_never_help() -> None:
    """The best value of a scene is at most that of the scene with one of them less."""
    one = solve(jammed((45.0, 8.0), 1.0), gap=1e-3)
    assert one.objective.upper_bound is not None
    for more in (
        {"eavesdroppers": [{"position_m": [45.0, 8.0, 0.0]}, {"position_m": [20.0, -9.0, 0.0]}]},
        {"nodes": [{"position_m": [40.0, 0.0, 0.0]}, {"position_m": [10.0, -20.0, 0.0]}]},
    ):
        assert solve(jammed((45.0, 8.0), 1.0, **more), certify=False).objective.value <= (
            one.objective.upper_bound + 1e-9
        )


@pytest.fixture(scope="module")
def certificate() -> Certificate:
    """The proof of a scene with two nodes and two eavesdroppers."""
    more = {"nodes": [{"position_m": [40.0, 0.0, 0.0]}, {"position_m": [5.0, 30.0, 0.0]}]}
    listeners = [{"position_m": [45.0, 28.0, 0.0]}, {"position_m": [30.0, 50.0, 0.0]}]
    scenario = jammed((45.0, 28.0), 3.0, eavesdroppers=listeners, **more)
    return certificate_of(solve(scenario, gap=0.1))


def test_a_certificate_with_other_multipliers_is_rejected(certificate: Certificate) -> None:
    """Of every leaf the weights and what the tangents touch at count; either may not be negative."""
    assert verify(certificate).proved
    (tree,) = certificate.trees
    pairs = len(certificate.scenario.nodes) * len(certificate.scenario.eavesdroppers)

    def verdict_of(change: Any) -> Any:
        mixes = tuple(dict(change(mix)) for mix in tree.leaves.mixes)
        return verify(replace(certificate, trees=(replace(tree, leaves=replace(tree.leaves, mixes=mixes)),)))

    for factor in (0.0, 3.0):
        assert not verdict_of(
            lambda mix, f=factor: {q: w * (f if q >= pairs else 1.0) for q, w in mix.items()}
        ).proved
    assert not verdict_of(lambda mix: {q: w for q, w in mix.items() if q >= pairs} or mix).proved
    assert "negative" in verdict_of(lambda mix: {**mix, 2 * pairs - 1: -1.0}).message
    assert "does not exist" in verdict_of(lambda mix: {**mix, 2 * pairs: 1.0}).message
    levels = np.full(len(tree.leaves), 0.9)
    low = replace(tree, leaves=replace(tree.leaves, level=levels))
    assert not verify(replace(certificate, trees=(low,))).proved


@pytest.mark.parametrize(
    "change",
    [
        "sources[0].power_w=1.01",
        "transmitter.power_w=3.1",
        "nodes[0].noise_w=9e-4",
        "receiver.noise_w=1.1e-3",
    ],
)
def test_a_certificate_of_another_scene_is_rejected(certificate: Certificate, change: str) -> None:
    """The powers and noises on the ground are part of what is proved."""
    other = apply_overrides(certificate.scenario, [change])
    assert not verify(replace(certificate, scenario=other)).proved


def test_what_does_not_know_pairs_refuses_them() -> None:
    """Robust poses and antennas that are no dipole name the objective."""
    for scenario in (
        jammed((30.0, 25.0), 1.0, receiver={"noise_w": 1e-3, "reference_gain_db": 0, "position_error_m": 1}),
        jammed((30.0, 25.0), 1.0, antenna={"kind": "half-wave"}),
    ):
        with pytest.raises(UsageError, match='"friendly-jamming"'):
            solve(scenario, robust=scenario.is_uncertain)


@pytest.mark.parametrize("seed", and_slow([0], range(1, 6)))
def test_no_pose_among_buildings_beats_the_bound(seed: int) -> None:
    """A search of the physics finds nothing above the bound, nor better than what is certified."""
    rng = np.random.default_rng(seed)
    west, south = map(float, rng.uniform([-50.0, -45.0], [20.0, -25.0]))
    east, north = west + float(rng.uniform(8.0, 30.0)), south + float(rng.uniform(8.0, 20.0))
    block = {"polygon_m": [[west, south], [east, south], [east, north], [west, north]]}
    listeners = [
        {"position_m": [x, y, 0.0]} for x, y in rng.uniform([-60.0, -15.0], [60.0, 60.0], (2, 2)).tolist()
    ]
    scenario = jammed(
        (0.0, 0.0),
        float(10.0 ** rng.uniform(-1.0, 1.0)),
        buildings=[block | {"height_m": float(rng.uniform(8.0, 25.0))}],
        channel={"model": "power-law", "exponent": 2.0, "blocked_loss_db": 20.0},
        eavesdroppers=listeners,
    )
    found = solve(scenario, gap=1e-2, time_limit_s=60.0)
    near = found.pose.position_m, found.pose.antenna_axis
    best = best_value(scenario, "optimum", starts=100, seed=seed, near=near)
    assert found.objective.value <= best <= found.objective.upper_bound * (1.0 + 1e-9)
    assert found.status == "certified"
