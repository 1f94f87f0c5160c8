"""Families of secrecy rates, margins and fenced airspaces, against the physics."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.problem.build import build_family
from nullpose.scenario import Scenario
from scenes import require_fault, small

SEEDS = st.integers(0, 2**32 - 1)
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
