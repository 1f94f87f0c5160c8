"""Solving with channels that are functions in Python."""

import math
from typing import Any

import numpy as np
import pytest
from sizes import and_slow

import nullpose
from nullpose import Scenario
from nullpose.channel import Custom
from nullpose.channel.convex import FloatArray
from nullpose.errors import ScenarioError, UsageError
from nullpose.solver import position_search


@pytest.fixture(autouse=True)
def _coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Has positions searched from a quarter of the places, in which the paper's optimum is found too."""
    monkeypatch.setattr(position_search, "_DRAWN", 250)
    monkeypatch.setattr(position_search, "_CLIMBED", 1)


FIELD: dict[str, Any] = {
    "nodes_m": [[0, 0, 0], [0, 50, 0]],
    "jammers_m": [[17, 15, 4]],
    "noise_w": 1e-3,
    "altitude_m": (8, 30),
}


def scene(channel: object, **more: object) -> Scenario:
    """Return the paper's scene with a channel."""
    return Scenario.from_arrays(**FIELD, channel=channel, **more)


def power_law(exponent: float) -> Custom:
    """Return a power law as a function."""
    return Custom(
        gain=lambda d, elevation, azimuth: d**-exponent, exponents=(exponent, exponent), db_per_deg=0.0
    )


def urban(distance_m: FloatArray, elevation_rad: FloatArray, azimuth_rad: FloatArray) -> FloatArray:
    """Evaluate the mean power with line of sight by elevation in the urban environment."""
    seen = 1.0 / (1.0 + 9.61 * np.exp(-0.16 * (np.degrees(elevation_rad) - 9.61)))
    return np.asarray(distance_m**-2.0 * (seen * 10.0**-0.1 + (1.0 - seen) * 10.0**-2.0))


TILTING = {"airframe": {"tilt_max_deg": 20.0}}


@pytest.mark.parametrize(
    ("scheme", "more"),
    and_slow([("optimum", TILTING), ("vertical", {})], [("optimum", {}), ("vertical", TILTING)]),
)
def test_a_power_law_as_a_function_has_the_value_of_the_model(scheme: str, more: dict[str, Any]) -> None:
    """Under two schemes, with and without an airframe."""
    law = nullpose.solve(scene(power_law(3.0), **more), scheme, gap=0.2)
    model = nullpose.solve(scene({"model": "power-law", "exponent": 3.0}, **more), scheme, gap=1e-4)
    assert (law.status, law.rigour) == ("certified", "floating-point")
    assert law.objective.value == pytest.approx(model.objective.value, rel=1e-4)
    assert model.objective.value <= law.objective.upper_bound <= 1.2001 * law.objective.value


def test_sight_by_elevation_as_a_function_has_the_value_and_a_bound_above_it() -> None:
    """The optimum is in mid-air there."""
    channel = Custom(gain=urban, exponents=(2.0, 2.0), db_per_deg=0.6)
    model = {"model": "elevation", "environment": "urban", "average": "power"}
    best = nullpose.solve(scene(model), gap=1e-4).objective
    found = nullpose.solve(scene(channel), gap=1.0).objective
    assert found.value == pytest.approx(best.value, rel=1e-4)
    assert best.value <= found.upper_bound


def test_a_limit_leaves_the_bound_that_was_reached() -> None:
    """The status says that the gap was not reached."""
    channel = Custom(gain=urban, exponents=(2.0, 2.0), db_per_deg=0.6)
    found = nullpose.solve(scene(channel), gap=1e-3, node_limit=500)
    assert found.status == "gap-not-reached"
    assert 1e-3 < found.objective.relative_gap < math.inf


def test_an_interrupt_leaves_the_bound_that_was_reached() -> None:
    """And the bound is above the best value there is."""
    calls: list[float] = []

    def interrupt(gap: float, boxes: int) -> None:
        calls.append(gap)
        if len(calls) == 10:
            raise KeyboardInterrupt

    channel = Custom(gain=urban, exponents=(2.0, 2.0), db_per_deg=0.6)
    found = nullpose.solve(scene(channel), gap=1e-3, on_progress=interrupt)
    model = {"model": "elevation", "environment": "urban", "average": "power"}
    assert found.interrupted
    assert nullpose.solve(scene(model), gap=1e-4).objective.value <= (found.objective.upper_bound or 0.0)


def test_without_bounds_nothing_is_bounded_and_the_reason_says_so() -> None:
    """Status and bound are those of a search."""
    found = nullpose.solve(scene(Custom(gain=urban)))
    assert (found.status, found.objective.upper_bound) == ("best-found", None)
    assert "no bounds" in found.reason


def test_a_jammer_may_have_one_of_its_own() -> None:
    """Only nodes in free space then bound how far away a pose can be."""
    jammer = {"position_m": [17, 15, 4], "power_w": 1.0, "channel": power_law(3.0)}
    free = scene(None).to_dict()
    found = nullpose.solve(Scenario.from_dict({**free, "jammers": [jammer]}), gap=0.2)
    model = {**jammer, "channel": {"model": "power-law", "exponent": 3.0}}
    best = nullpose.solve(Scenario.from_dict({**free, "jammers": [model]}), gap=1e-4)
    assert found.status == "certified"
    assert found.objective.value == pytest.approx(best.objective.value, rel=1e-4)


def test_the_rate_of_a_drone_that_transmits_is_solved_too() -> None:
    """The functions are those of nodes and eavesdroppers."""
    eavesdroppers = [{"position_m": [40, 20, 0]}]
    more = {"objective": "secrecy-rate", "eavesdroppers": eavesdroppers, "transmitter": {"power_w": 1.0}}
    field = FIELD | {"jammers_m": []}
    found = nullpose.solve(Scenario.from_arrays(**field, channel=power_law(3.0), **more), gap=0.2)
    model = {"model": "power-law", "exponent": 3.0}
    best = nullpose.solve(Scenario.from_arrays(**field, channel=model, **more), gap=1e-3)
    assert found.objective.value == pytest.approx(best.objective.value, rel=1e-3)


def test_what_knows_no_functions_refuses_them_in_words() -> None:
    """Batches, certificates and files."""
    scenario = scene(power_law(3.0))
    with pytest.raises(UsageError, match="function in Python"):
        nullpose.solve_many([scenario])
    with pytest.raises(UsageError, match="function in Python"):
        nullpose.certificate_of(nullpose.solve(scenario, gap=1.0))
    with pytest.raises(ScenarioError, match=r"channel\.model"):
        Scenario.from_dict(scenario.to_dict())
