"""Families of secrecy rates, margins and fenced airspaces, against the physics."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.errors import ScenarioError
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario

SEEDS = st.integers(0, 2**32 - 1)


PLAIN = {
    "airspace": {"altitude_m": [10.0, 40.0]},
    "receiver": {"noise_dbm": -60.0, "reference_gain_db": -40.0},
}


def secret_scene(rng: np.random.Generator, ears: int) -> Scenario:
    """Returns three nodes, some with noise of their own, so many eavesdroppers, and jammers or none."""
    places = rng.uniform(0.0, [100.0, 100.0, 5.0], (5 + ears, 3)).tolist()
    nodes = [{"position_m": at} for at in places[:3]]
    nodes[0]["noise_dbm"], nodes[1]["jamming_dbm"] = -55.0, -58.0
    jammers = [{"position_m": at, "power_w": 10.0 ** rng.uniform(-1.0, 1.0)} for at in places[3:5]]
    listeners = [{"position_m": at, "noise_dbm": rng.uniform(-70.0, -50.0)} for at in places[5:]]
    secrecy = {"objective": "secrecy-rate", "transmitter": {"power_w": 10.0 ** rng.uniform(-2.0, 1.0)}}
    ground = {"nodes": nodes, "jammers": jammers if rng.uniform() < 0.5 else [], "eavesdroppers": listeners}
    return Scenario.from_dict(PLAIN | secrecy | ground)


@given(seed=SEEDS)
def test_a_secrecy_family_keeps_clear_of_everyone(seed: int) -> None:
    """Nodes, eavesdroppers and jammers are its points; jammers are in no ratio but are kept clear of."""
    scene = secret_scene(np.random.default_rng(seed), 2)
    close = scene.model_copy(update={"airspace": scene.airspace.model_copy(update={"keep_out_m": 50.0})})
    family = build_family(close)
    everyone = (scene.node_positions_m, scene.eavesdropper_positions_m, scene.jammer_positions_m)
    np.testing.assert_array_equal(family.points_m, np.vstack([points.reshape(-1, 3) for points in everyone]))
    np.testing.assert_array_equal(family.keep_out_points_m, family.points_m)
    assert set(family.numerator_point) == {0, 1, 2}
    np.testing.assert_array_equal(family.denominator_point, [3, 4])


def test_a_fence_bounds_the_box(random_problem: Callable) -> None:
    """The box is met with the fence's own: what is unbounded becomes bounded, what is narrower stays."""
    rng = np.random.default_rng(1)
    fence = [(-10.0, 0.0), (70.0, -20.0), (90.0, 50.0), (0.0, 80.0)]
    free = build_family(random_problem(rng, 2, 1, geofence_m=fence))
    np.testing.assert_array_equal(free.low_m, [-10.0, -20.0, 10.0])
    np.testing.assert_array_equal(free.high_m, [90.0, 80.0, 40.0])
    boxed = build_family(random_problem(rng, 2, 1, geofence_m=fence, x_m=(5.0, 200.0)))
    np.testing.assert_array_equal(boxed.low_m, [5.0, -20.0, 10.0])
    np.testing.assert_array_equal(boxed.high_m, [90.0, 80.0, 40.0])


@pytest.mark.parametrize(
    ("jammer", "path"),
    [({"power_w": 1e18}, "jammers[1].power_w"), ({"power_dbm": 210.0}, "jammers[1].power_dbm")],
)
def test_jamming_beyond_arithmetic_is_refused(jammer: dict[str, float], path: str) -> None:
    """A jammer so strong that rounding fills its null is refused by the path of its power."""
    data = {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [{"position_m": [0, 0, 0], "power_w": 1.0}],
        "jammers": [{"position_m": [30, 5, 4], "power_w": 1e15}, {"position_m": [17, 15, 4], **jammer}],
    }
    with pytest.raises(ScenarioError) as caught:
        build_family(Scenario.from_dict(data))
    (fault,) = caught.value.faults
    assert fault.path == path
    assert "198 dB over the noise" in fault.message
    assert "at most 160 dB" in fault.message
    data["airspace"]["altitude_m"] = [3000.0, 4000.0]
    build_family(Scenario.from_dict(data))


def test_an_eavesdropper_beyond_arithmetic_is_refused() -> None:
    """So is a transmitter that an eavesdropper hears so far above its noise."""
    data = {
        "objective": "secrecy-rate",
        "transmitter": {"power_w": 1e10},
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [{"position_m": [0, 0, 0]}],
        "eavesdroppers": [{"position_m": [17, 15, 4], "noise_w": 1e-30}],
    }
    with pytest.raises(ScenarioError, match=r"eavesdroppers\[0\]: got a signal 388 dB over the noise"):
        build_family(Scenario.from_dict(data))
