"""Objectives that are functions in Python are searched as well as those whose optimum is proved."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nullpose
from nullpose import Scenario
from nullpose.errors import UsageError
from nullpose.objectives import Custom, FloatArray

KNOWN: dict[str, Callable[[FloatArray], float]] = {
    "min-sinr": lambda sinr: float(np.min(sinr)),
    "sum-rate": lambda sinr: float(np.sum(np.log2(1.0 + sinr))),
    "proportional-fair": lambda sinr: float(np.exp(np.mean(np.log(sinr)))),
}


def field(seed: int, objective: object = "min-sinr", **more: Any) -> Scenario:
    """Return a random field of two to six nodes and up to three jammers."""
    rng = np.random.default_rng(seed)
    nodes, jammers = int(rng.integers(2, 7)), int(rng.integers(0, 4))
    points = np.hstack([rng.uniform(-50.0, 50.0, (nodes + jammers, 2)), np.zeros((nodes + jammers, 1))])
    return Scenario.from_arrays(
        points[:nodes],
        points[nodes:],
        jammer_power_w=10.0 ** rng.uniform(-2.0, 2.0, jammers),
        noise_w=1e-3,
        altitude_m=(8.0, 30.0),
        airspace={"x_m": (-150.0, 150.0), "y_m": (-150.0, 150.0)},
        objective=objective,
        **more,
    )


@pytest.fixture(scope="module")
def rate() -> nullpose.Result:
    """The sum rate of a field as a function, searched."""
    return nullpose.solve(field(0, Custom(KNOWN["sum-rate"])))


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(7, 26))])
@pytest.mark.parametrize("name", KNOWN)
def test_a_known_objective_as_a_function_has_its_certified_value(name: str, seed: int) -> None:
    """To 1e-6; and the status says that nothing is proved."""
    best = nullpose.solve(field(seed, name), gap=1e-4)
    found = nullpose.solve(field(seed, Custom(KNOWN[name])))
    assert best.status == "certified"
    assert found.objective.value == pytest.approx(best.objective.value, rel=1e-6)
    assert (found.status, found.objective.upper_bound, found.rigour) == ("best-found", None, "none")
    assert "nothing is proved" in found.reason


@pytest.mark.parametrize("seed", [3, pytest.param(4, marks=pytest.mark.slow)])
def test_a_kink_away_from_the_first_pose_is_found_too(seed: int) -> None:
    """The smallest margin: its optimum is on a kink, and not that of the smallest SINR."""
    scenario = field(seed)
    weights = 10.0 ** np.random.default_rng(seed).uniform(-0.5, 0.5, len(scenario.nodes))
    nodes = [
        node | {"weight": weight}
        for node, weight in zip(scenario.to_dict()["nodes"], weights.tolist(), strict=True)
    ]
    best = nullpose.solve(Scenario.from_dict(scenario.to_dict() | {"nodes": nodes}), gap=1e-4)
    found = nullpose.solve(field(seed, Custom(lambda sinr: float(np.min(sinr / weights)))))
    assert found.objective.value == pytest.approx(best.objective.value, rel=1e-6)


@pytest.mark.parametrize(
    "airframe",
    [{"tilt_max_deg": 10.0, "mount_deg": 60.0}, pytest.param({"tilt_max_deg": 20.0}, marks=pytest.mark.slow)],
)
def test_the_airframe_is_kept(airframe: dict[str, float]) -> None:
    """The best pose within the tilt, as with a proof; in another channel too."""
    more = {"airframe": airframe, "channel": {"model": "power-law", "exponent": 2.5}}
    best = nullpose.solve(field(5, **more), gap=1e-4)
    found = nullpose.solve(field(5, Custom(KNOWN["min-sinr"]), **more))
    assert found.objective.value == pytest.approx(best.objective.value, rel=1e-6)
    assert abs(found.pose.tilt_rad) <= np.radians(airframe["tilt_max_deg"]) + 1e-9


def test_every_scheme_is_compared() -> None:
    """Each with the value that its certified solve has; maximum gain for other than two nodes is left out."""
    paper = nullpose.load("examples/paper.toml")
    known = {result.scheme: result.objective.value for result in nullpose.compare(paper)}
    found = nullpose.compare(paper.model_copy(update={"objective": Custom(KNOWN["min-sinr"])}))
    assert {result.scheme: result.objective.value for result in found} == pytest.approx(known, rel=1e-6)
    three = nullpose.compare(field(1, Custom(KNOWN["min-sinr"])))
    assert "maximum-gain" not in [result.scheme for result in three]


def test_the_unit_of_a_function_has_no_effect(rate: nullpose.Result) -> None:
    """A rate in bit/s and less a constant has its optimum at the same place."""
    large = nullpose.solve(field(0, Custom(lambda sinr: 2e7 * KNOWN["sum-rate"](sinr) - 1e9)))
    assert large.objective.value == pytest.approx(2e7 * rate.objective.value - 1e9, rel=1e-9)


def test_what_cannot_hold_a_function_refuses_it_in_words() -> None:
    """Certificates, robust poses, arrays, patterns, many scenes and sensitivities."""
    scenario = field(0, Custom(KNOWN["min-sinr"]))
    found = nullpose.solve(scenario)
    assert found.sensitivity is None
    array = {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5}
    calls: dict[str, Callable[[], object]] = {
        "function in Python": lambda: nullpose.certificate_of(found),
        "a function in Python; allowed here": lambda: nullpose.solve(scenario, robust=True),
        "array: given": lambda: nullpose.solve(scenario.model_copy(update={"array": array})),
        "antenna: given a": lambda: nullpose.solve(
            scenario.model_copy(update={"antenna": {"kind": "half-wave"}})
        ),
        r"scenarios\[0\]: asks for": lambda: nullpose.solve_many([scenario]),
        "sensitivity: given an objective": lambda: nullpose.sensitivity(scenario, found.pose),
    }
    for words, call in calls.items():
        with pytest.raises(UsageError, match=words):
            call()


def test_a_function_that_returns_no_number_at_a_pose_is_refused() -> None:
    """Where the samples of the scenario did not show it: both SINRs are nearly equal at the best pose."""

    def mine(sinr: FloatArray) -> float:
        return float("nan") if 1.2 < np.min(sinr) < np.max(sinr) < 1.26 else float(np.min(sinr))

    paper = nullpose.load("examples/paper.toml").model_copy(update={"objective": Custom(mine, "mine")})
    with pytest.raises(UsageError, match="mine returned no number at a pose"):
        nullpose.solve(paper)


def test_equal_seeds_give_equal_poses(rate: nullpose.Result) -> None:
    """And a search that is told to prove nothing finds the same."""
    found = nullpose.solve(rate.scenario, certify=False)
    np.testing.assert_array_equal(found.pose.position_m, rate.pose.position_m)
