"""Gains of antennas count the same on every path: as more power, more path gain or less noise."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from array_beams import beam_sinr
from paper_schemes import zero_interference_sinr

import nullpose
from nullpose.physics import (
    ErrorCase,
    Pose,
    digital_sinr,
    element_positions,
    evaluate,
    objective_of_links,
    ratios_under,
)
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario
from nullpose.study import sweep

NODE_DBI, OTHER_DBI, DRONE_DBI = (2.15, -3.0), 5.0, 1.76


def with_gains(*, downlink: bool = False, whips: bool = True, **more: Any) -> Scenario:
    """Return the paper's scene with a gain of every antenna, upright whips at the nodes if wanted."""
    data: dict[str, Any] = {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "antenna": {"gain_dbi": DRONE_DBI},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [
            {"position_m": [0.0, y_m, 0.0], "power_w": 1.0, "gain_dbi": gain}
            | ({"antenna": "dipole"} if whips else {})
            for y_m, gain in zip((0.0, 50.0), NODE_DBI, strict=True)
        ],
        "jammers": [{"position_m": [17.0, 15.0, 4.0], "power_w": 1.0, "gain_dbi": OTHER_DBI}],
    }
    if downlink:
        data |= {"objective": "secrecy-rate", "transmitter": {"power_w": 1.0}}
        data["eavesdroppers"] = [{"position_m": [-400.0, 300.0, 0.0], "gain_dbi": OTHER_DBI}]
    return Scenario.from_dict(data | more)


def without_gains(scenario: Scenario) -> Scenario:
    """Return the scene in which powers, path gain and noise have the gains in them."""
    data = scenario.to_dict()
    data.pop("antenna")
    data["receiver"]["reference_gain_db"] += DRONE_DBI
    for point in (*data["nodes"], *data["jammers"], *data.get("eavesdroppers", ())):
        gain = 10.0 ** (point.pop("gain_dbi") / 10.0)
        if scenario.transmitter is None:
            point["power_w"] *= gain
        elif point in data["jammers"]:  # the path gain among points on the ground is without the drone's
            point["power_w"] *= gain * 10.0 ** (-DRONE_DBI / 10.0)
        else:
            point["noise_w"] = 1e-3 / gain
    return Scenario.from_dict(data)


POSITION_M, AXIS = np.array([-2.0, 24.0, 9.0]), np.array([0.8, 0.36, 0.48])
ELEMENTS = element_positions(3, "linear", 0.5)

PATHS: dict[str, Callable[[Scenario], Any]] = {
    "pose": lambda scene: [link.sinr for link in evaluate(scene, Pose(POSITION_M, 0.3, -0.2, 1.0))],
    "zero interference": lambda scene: zero_interference_sinr(scene, POSITION_M),
    "robust": lambda scene: nullpose.guarantee(scene, POSITION_M, AXIS).lower,
    "solve": lambda scene: nullpose.solve(scene, gap=1e-4).objective.upper_bound,
    "solve many": lambda scene: nullpose.solve_many([scene, scene], gap=1e-4).value,
    "sweep": lambda scene: [row.min_sinr_db for row in sweep(scene, "receiver.noise_w", [1e-3, 1e-2]).rows],
}


@pytest.mark.parametrize("path", PATHS)
def test_a_gain_is_as_good_as_power(path: str) -> None:
    """Powers and path gain that have the gains in them give the same numbers: the search, the proof too."""
    scene = with_gains()
    np.testing.assert_allclose(PATHS[path](scene), PATHS[path](without_gains(scene)), rtol=2e-4)


@pytest.mark.parametrize(("sinr", "weights"), [(digital_sinr, ()), (beam_sinr, (np.ones((1, 3)),))])
def test_gains_count_for_each_element_of_an_array(sinr: Callable, weights: tuple) -> None:
    """Combined signals and jamming have them, as the family that is searched."""
    scene = with_gains(whips=False, array={"elements": 3, "layout": "linear", "spacing_wavelengths": 0.5})
    plain = without_gains(scene)
    found, wanted = (sinr(one, POSITION_M, ELEMENTS, *weights) for one in (scene, plain))
    np.testing.assert_allclose(found, wanted, rtol=1e-12)
    np.testing.assert_allclose(
        build_family(scene).ratios.denominator_weight,
        build_family(plain).ratios.denominator_weight,
        rtol=1e-12,
    )


def test_gains_count_where_the_drone_transmits() -> None:
    """At nodes and eavesdroppers, for the rates and for the jamming that nodes get."""
    scene = with_gains(downlink=True)
    plain = without_gains(scene)
    pose = Pose(POSITION_M, 0.3, -0.2, 1.0)
    rate = objective_of_links(scene, evaluate(scene, pose))
    assert rate > 0.0
    assert rate == pytest.approx(objective_of_links(plain, evaluate(plain, pose)), rel=1e-12)
    found, wanted = (nullpose.solve(one, gap=1e-3).objective for one in (scene, plain))
    assert found.upper_bound == pytest.approx(wanted.upper_bound, rel=2e-3)
    found, wanted = (ratios_under(one, POSITION_M, AXIS, ErrorCase.none(one)) for one in (scene, plain))
    np.testing.assert_allclose(found, wanted, rtol=1e-12)


def test_whips_gain_on_an_isotropic_jammer() -> None:
    """2.15 dBi at every node is 2.15 dB more at any pose, at the best one too."""
    scene = nullpose.load("examples/whips.toml")
    gained = nullpose.apply_overrides(scene, ["nodes.S1.gain_dbi=2.15", "nodes.S2.gain_dbi=2.15"])
    before, after = (nullpose.solve(one, gap=1e-4).objective.value_db for one in (scene, gained))
    assert after - before == pytest.approx(2.15, abs=2e-3)
