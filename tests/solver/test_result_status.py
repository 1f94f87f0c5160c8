"""A result says certified when the two numbers that it reports say so, and never otherwise."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sizes import and_slow

from nullpose import Airframe, Array, Scenario, Scheme, SolveError, Status, solve, solve_many, sweep
from nullpose.objectives import RECORDS, Quantity
from nullpose.solver import Result
from nullpose.solver.objective import Objective, status_of


def scene(rng: np.random.Generator, jammers: int = 1, **more: Any) -> Scenario:
    """Returns two nodes and some jammers on a field of 60 m."""

    def spots(count: int) -> list[list[float]]:
        return [[*spot, 0.0] for spot in rng.uniform(0.0, 60.0, (count, 2)).tolist()]

    return Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [{"position_m": spot, "power_w": 1.0} for spot in spots(2)],
            "jammers": [{"position_m": spot, "power_w": 1.0} for spot in spots(jammers)],
            **more,
        }
    )


def secrecy(rng: np.random.Generator) -> Scenario:
    """Returns one whose smallest secrecy rate counts."""
    data = scene(rng).to_dict()
    for node in data["nodes"]:
        del node["power_w"]
    heard = [{"position_m": [*rng.uniform(0.0, 60.0, 2).tolist(), 0.0]}]
    sent = {"objective": "secrecy-rate", "transmitter": {"power_w": 1.0}, "eavesdroppers": heard}
    return Scenario.from_dict(data | sent)


def says_what_its_numbers_say(result: Result, gap: float) -> bool:
    """Returns whether the status follows from the reported gap and the requested one."""
    reached = result.objective.relative_gap is not None and result.objective.relative_gap <= gap
    return (result.status is Status.CERTIFIED) == reached and bool(result.reason) != reached


@pytest.mark.parametrize(
    ("seed", "gap"), and_slow([(0, 1e-6), (1, 1e-2), (0, 1.0)], [(1, 1e-6), (0, 1e-2), (1, 1.0)])
)
def test_certified_is_what_the_reported_numbers_say(seed: int, gap: float) -> None:
    """Of every kind of result: certified is one whose reported gap is at most the requested one."""
    rng = np.random.default_rng(seed)
    one, quiet, rate = scene(rng), scene(rng, jammers=0), secrecy(rng)
    half = scene(rng, antenna={"kind": "half-wave"}, airframe={"tilt_max_deg": 10.0})
    asked: dict[str, Any] = {"gap": gap, "node_limit": 2000}
    results = [solve(each, scheme, **asked) for each in (one, quiet) for scheme in one_scheme_each(each)]
    results += [solve(each, **asked) for each in (rate, half)]
    results += [solve(each, **asked | {"node_limit": 1}) for each in (one, rate)]
    array = Array(elements=2, layout="linear", spacing_wavelengths=0.5)
    results.append(solve(one.model_copy(update={"array": array}), gap=max(gap, 1e-2)))
    results.append(solve(one, robust=True, **asked | {"node_limit": 100}))
    for result in results:
        assert says_what_its_numbers_say(result, max(gap, 1e-2) if result.scheme == "array-digital" else gap)
    many = solve_many([one, quiet], airframes=[None, Airframe(tilt_max_deg=0.0)], gap=gap, node_limit=300)
    assert np.array_equal(many.status == Status.CERTIFIED, many.relative_gap <= gap)
    assert np.array_equal(many.status == Status.CERTIFIED, many.reason == "")


def one_scheme_each(scenario: Scenario) -> list[Scheme]:
    """Returns the schemes that have a meaning in a scene, and a bound."""
    return [each for each in Scheme if each.not_applicable(scenario) is None]


def test_a_sweep_is_certified_by_its_numbers() -> None:
    """A point that takes the bound of a freer one is certified by its own value."""
    table = sweep(scene(np.random.default_rng(1)), "jammers.M1.power_w", [1e-6, 1.0001, 1.0], gap=1e-2)
    for row in table.rows:
        assert (row.status == Status.CERTIFIED) == (row.objective.relative_gap <= 1e-2)


@pytest.mark.parametrize("share", [1.71, 1.0 + 1e-5])
def test_a_contradiction_is_a_fault_of_nullpose(share: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ratios of more than what the physics evaluates make no certified result beyond its gap."""
    right = RECORDS["min-sinr"]

    def louder(scenario: Scenario) -> Any:
        ratios = right.ratios(scenario)
        return ratios._replace(numerator_weight=share * ratios.numerator_weight)

    monkeypatch.setitem(RECORDS, "min-sinr", replace(right, ratios=louder))
    scenario = scene(np.random.default_rng(0))
    for solving in (lambda: solve(scenario), lambda: solve_many([scenario])):
        with pytest.raises(SolveError, match="apart; this is a fault of nullpose"):
            solving()
    unfinished = solve(scenario, node_limit=1)
    assert unfinished.status is Status.GAP_NOT_REACHED
    assert unfinished.objective.relative_gap > 1e-6


@pytest.mark.parametrize("quantity", [one for record in RECORDS.values() for one in record.quantities])
def test_rounding_alone_is_no_contradiction(quantity: Quantity) -> None:
    """Numbers that miss the gap by their rounding are not certified, and no fault."""
    numbers = {"value": 1.0, "value_db": 0.0, "upper_bound": 1.0 + 1e-6, "relative_gap": 1e-6 + 1e-13}
    missed = Objective(quantity=quantity, **numbers)
    assert status_of(missed, 1e-6, "") == (Status.GAP_NOT_REACHED, "the rounding of value and bound")
    assert status_of(replace(missed, relative_gap=1e-6), 1e-6, "a limit") == (Status.CERTIFIED, "")
