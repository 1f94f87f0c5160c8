"""The exchange between error cases and poses."""

import math
import time

import numpy as np
import pytest
from scipy.optimize import minimize

from nullpose.physics import ratios_under
from nullpose.problem.axis_field import AxisField
from nullpose.problem.robust import BindingCase
from nullpose.scenario import Scenario
from nullpose.solver.options import SolveOptions
from nullpose.solver.robust.exchange import Exchange
from nullpose.solver.robust.guarantee import Inner

POSE = np.array([5.0, 20.0, 9.0]), np.array([0.6, 0.0, 0.8])


@pytest.fixture(scope="module")
def exchange(strong: Scenario) -> Exchange:
    """Returns an exchange whose search has ended."""
    exchange = Exchange(Inner(strong), AxisField.free(), SolveOptions(gap=1e-2), *POSE)
    exchange.search(time.perf_counter() + 600.0)
    return exchange


def promised(scene: Scenario, cases: list[BindingCase], p: np.ndarray, u: np.ndarray) -> float:
    """Returns the smallest ratio of the finite family at a pose, by the plain physics."""
    return min(float(ratios_under(scene, p, u, one.case)[one.ratio, 0]) for one in cases)


def test_cases_promise_no_less_than_is_guaranteed(strong: Scenario, exchange: Exchange) -> None:
    """At every pose the finitely many cases leave at least what the worst of all errors leaves."""
    rng = np.random.default_rng(0)
    for _ in range(200):
        p = rng.uniform([-40.0, -20.0, 8.0], [40.0, 60.0, 30.0])
        u = rng.normal(size=3)
        u /= np.linalg.norm(u)
        worst = min(one.worst for one in exchange.inner.worst(p, u))
        assert promised(strong, exchange.cases, p, u) >= worst * (1.0 - 1e-12)


def test_it_ends_where_promise_and_guarantee_meet(strong: Scenario, exchange: Exchange) -> None:
    """At the end the promise of the cases is a third of the gap above the best pose's guarantee at most."""
    assert exchange.incumbent is not None
    value = math.exp(exchange.incumbent.log_value)
    u = exchange.incumbent.axis / np.linalg.norm(exchange.incumbent.axis)
    assert promised(strong, exchange.cases, exchange.incumbent.position_m, u) == pytest.approx(
        value, rel=1e-9
    )
    assert exchange.best.worst <= value <= exchange.best.worst * (1.0 + 1e-2 / 3.0)


def test_a_general_solver_finds_no_better_promise(strong: Scenario, exchange: Exchange) -> None:
    """SLSQP on the finite family's epigraph, from many starts, ends nowhere above the exchange's search."""
    assert exchange.incumbent is not None
    best = exchange.incumbent.log_value
    rng = np.random.default_rng(1)
    cases = exchange.cases

    def logs(x: np.ndarray) -> np.ndarray:
        u = x[3:6] / np.linalg.norm(x[3:6])
        return np.log([float(ratios_under(strong, x[:3], u, one.case)[one.ratio, 0]) for one in cases])

    reached = []
    for i in range(6):
        p = exchange.incumbent.position_m if i == 0 else rng.uniform([-25.0, 5.0, 8.0], [10.0, 40.0, 12.0])
        axis = np.array([17.0, 15.0, 4.0]) - p
        start = np.concatenate([p, axis / np.linalg.norm(axis)])
        search = minimize(
            lambda x: -x[6],
            np.append(start, logs(start).min()),
            method="SLSQP",
            bounds=[(-60.0, 60.0)] * 2 + [(8.0, 30.0)] + [(-1.5, 1.5)] * 3 + [(None, None)],
            constraints=[{"type": "ineq", "fun": lambda x: logs(x) - x[6]}],
            options={"maxiter": 150, "ftol": 1e-9},
        )
        reached.append(float(logs(search.x).min()))
    assert max(reached) <= best + 1e-6
    assert max(reached) == pytest.approx(best, abs=1e-3)
