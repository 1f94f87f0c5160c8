"""From a scenario to its family: the ratios are the SINRs, the domain is the airspace."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.certificate.plain import dense_ratios

from nullpose import UsageError, certificate_of, solve, verify
from nullpose.physics import sinr
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario, apply_overrides, load
from scenes import require_fault, small

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS, nodes=st.integers(1, 8), jammers=st.integers(0, 4))
def test_ratios_are_the_sinrs(seed: int, nodes: int, jammers: int, random_problem: Callable) -> None:
    """Recomputed from the arrays with dense matrices, the ratios are the SINRs of the physics (eq. 2.1)."""
    rng = np.random.default_rng(seed)
    scene = random_problem(rng, nodes, jammers)
    position = rng.uniform([-20.0, -20.0, 10.0], [120.0, 120.0, 40.0])
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    np.testing.assert_allclose(
        dense_ratios(build_family(scene), position, axis), sinr(scene, position, axis), rtol=1e-9, atol=1e-13
    )


FENCE = [(-10.0, 0.0), (70.0, -20.0), (90.0, 50.0), (0.0, 80.0)]


@pytest.mark.parametrize(
    ("airspace", "low_m", "high_m"),
    [
        ({}, [-np.inf, -np.inf], [np.inf, np.inf]),
        ({"x_m": (-5.0, 60.0), "y_m": (0.0, 0.0)}, [-5.0, 0.0], [60.0, 0.0]),
        ({"geofence_m": FENCE}, [-10.0, -20.0], [90.0, 80.0]),
        ({"geofence_m": FENCE, "x_m": (5.0, 200.0)}, [5.0, -20.0], [90.0, 80.0]),
    ],
)
def test_the_box_is_the_airspaces_and_its_fences(
    airspace: dict, low_m: list[float], high_m: list[float], random_problem: Callable
) -> None:
    """Bounds left out are infinite, those given are kept, a fence bounds what is unbounded or wider."""
    family = build_family(random_problem(np.random.default_rng(1), 2, 1, keep_out_m=2.5, **airspace))
    np.testing.assert_array_equal(family.domain.low_m, [*low_m, 10.0])
    np.testing.assert_array_equal(family.domain.high_m, [*high_m, 40.0])
    assert family.domain.keep_out_m == 2.5


def test_a_touching_keep_out_ball_is_left_out(scene: Callable) -> None:
    """One that reaches in, by however little, is kept."""
    for keep_out_m, kept in ((8.0, []), (8.1, [0])):
        family = build_family(scene([(30.0, 0.0, 0.0)], keep_out_m=keep_out_m))
        np.testing.assert_array_equal(family.domain.keep_out_points_m, family.ratios.points_m[kept])


@given(seed=SEEDS, keep_out_m=st.floats(0.5, 45.0))
def test_no_ball_that_matters_is_left_out(seed: int, keep_out_m: float, random_problem: Callable) -> None:
    """No position lies inside the ball of a point that was left out, and every ball kept reaches in."""
    rng = np.random.default_rng(seed)
    scene = random_problem(rng, 3, 2, x_m=(20.0, 45.0), keep_out_m=keep_out_m)
    family = build_family(scene)
    kept = {tuple(point) for point in family.domain.keep_out_points_m}
    left_out = np.array([point for point in family.ratios.points_m if tuple(point) not in kept]).reshape(
        -1, 3
    )
    inside = rng.uniform([20.0, -60.0, 10.0], [45.0, 160.0, 40.0], (500, 3))
    inside[::2, 2] = 10.0
    distances = np.linalg.norm(inside[:, None] - left_out, axis=-1)
    assert np.all(distances >= keep_out_m)
    nearest = np.clip(family.domain.keep_out_points_m, family.domain.low_m, family.domain.high_m)
    assert np.all(np.linalg.norm(family.domain.keep_out_points_m - nearest, axis=1) < keep_out_m)


URBAN = 'channel={model="elevation", environment="urban", average="%s"}'
PAPER = load("examples/paper.toml")


def test_refused() -> None:
    """What does not know channels says so, and names what it takes."""
    with pytest.raises(UsageError, match="free space, or average"):
        build_family(apply_overrides(PAPER, ["channel={model='power-law', exponent=3.0}"]))


def test_guaranteed_is_free_space_of_other_strength() -> None:
    """It needs nothing of the solver: only the weights change."""
    free, scene = build_family(PAPER), build_family(apply_overrides(PAPER, [URBAN % "guaranteed"]))
    assert len(scene.ratios.channels) == 0
    assert scene.ratios.numerator_weight == pytest.approx(free.ratios.numerator_weight * 0.01)
    assert scene.ratios.denominator_weight == pytest.approx(free.ratios.denominator_weight * 10.0**-0.1)


def test_city_example_is_the_known_answer() -> None:
    """The scene of the paper in a city, 500 m wide: SLSQP from many starts, apart from nullpose."""
    result = solve(load("examples/urban.toml"))
    assert result.objective.value == pytest.approx(8.1689586, rel=2e-5)  # its gain has six digits
    assert result.pose.position_m == pytest.approx([14.097, 224.784, 159.515], abs=0.01)
    assert verify(certificate_of(result)).proved


def test_vertical_and_nulling_axes_follow_the_channel() -> None:
    """Every case is evaluated with the channel, and its bound holds for it."""
    scene = apply_overrides(load("examples/urban.toml"), ["channel.environment=suburban"])
    best = solve(scene, gap=1e-4).objective
    for scheme in ("zero-interference", "maximum-gain", "vertical"):
        found = solve(scene, scheme=scheme, gap=1e-4).objective
        assert found.value <= found.upper_bound
        assert found.value <= best.upper_bound


@pytest.mark.parametrize(("exponent", "is_refused"), [(1.6, True), (2.0, True), (4.0, False)])
def test_the_loudest_is_told_by_its_channel(exponent: float, is_refused: bool) -> None:
    """A jammer is too loud where it arrives so; a steep law lets less of it through."""
    loud = ["jammers.M.power_w=1e17", "airspace.altitude_m=[30.0, 40.0]"]
    channel = f"channel={{model='power-law', exponent={exponent}}}"
    scene: Scenario = apply_overrides(PAPER, [*loud, channel])
    if is_refused:
        require_fault(lambda: build_family(scene, any_channel=True), "jammers[0].power_w", "over the noise")
    else:
        assert len(build_family(scene, any_channel=True).ratios.channels) > 0


QUIET = {"receiver": {"noise_dbm": -60.0, "reference_gain_db": -40.0}}


def secret_scene(rng: np.random.Generator, ears: int) -> Scenario:
    """Returns three nodes, some with noise of their own, so many eavesdroppers, and jammers or none."""
    places = rng.uniform(0.0, [100.0, 100.0, 5.0], (5 + ears, 3)).tolist()
    nodes = [{"position_m": at} for at in places[:3]]
    nodes[0]["noise_dbm"], nodes[1]["jamming_dbm"] = -55.0, -58.0
    jammers = [{"position_m": at, "power_w": 10.0 ** rng.uniform(-1.0, 1.0)} for at in places[3:5]]
    listeners = [{"position_m": at, "noise_dbm": rng.uniform(-70.0, -50.0)} for at in places[5:]]
    secrecy = {"objective": "secrecy-rate", "transmitter": {"power_w": 10.0 ** rng.uniform(-2.0, 1.0)}}
    ground = {"nodes": nodes, "jammers": jammers if rng.uniform() < 0.5 else [], "eavesdroppers": listeners}
    return Scenario.from_dict(small(**QUIET | secrecy | ground))


@given(seed=SEEDS)
def test_a_secrecy_family_keeps_clear_of_everyone(seed: int) -> None:
    """Nodes, eavesdroppers and jammers are its points; jammers are in no ratio but are kept clear of."""
    scene = secret_scene(np.random.default_rng(seed), 2)
    close = scene.model_copy(update={"airspace": scene.airspace.model_copy(update={"keep_out_m": 50.0})})
    family = build_family(close)
    everyone = (scene.node_positions_m, scene.eavesdropper_positions_m, scene.jammer_positions_m)
    np.testing.assert_array_equal(
        family.ratios.points_m, np.vstack([points.reshape(-1, 3) for points in everyone])
    )
    np.testing.assert_array_equal(family.domain.keep_out_points_m, family.ratios.points_m)
    assert set(family.ratios.numerator_point) == {0, 1, 2}
    np.testing.assert_array_equal(family.ratios.denominator_point, [3, 4])


FAINT = {"position_m": [30, 5, 4], "power_w": 1e15}
LOUD = {"position_m": [17, 15, 4]}
QUIET_EAR = {"eavesdroppers": [LOUD | {"noise_w": 1e-30}], "nodes": [{"position_m": [0, 0, 0]}]}


@pytest.mark.parametrize(
    ("tables", "path", "words"),
    [
        ({"jammers": [FAINT, LOUD | {"power_w": 1e18}]}, "jammers[1].power_w", "198 dB over the noise"),
        ({"jammers": [FAINT, LOUD | {"power_dbm": 210.0}]}, "jammers[1].power_dbm", "must be at most 160 dB"),
        (
            QUIET_EAR | {"transmitter": {"power_w": 1e10}},
            "eavesdroppers[0]",
            "a signal 388 dB over the noise",
        ),
    ],
)
def test_powers_beyond_arithmetic_are_refused(tables: dict, path: str, words: str) -> None:
    """A jammer, or a transmitter overheard, so strong that rounding fills the null; from afar it is not."""
    objective = "secrecy-rate" if "transmitter" in tables else "min-sinr"
    data = small(objective=objective, **tables)
    require_fault(lambda: build_family(Scenario.from_dict(data)), path, words)
    if objective == "min-sinr":
        build_family(Scenario.from_dict(data | {"airspace": {"altitude_m": [3000.0, 4000.0]}}))
