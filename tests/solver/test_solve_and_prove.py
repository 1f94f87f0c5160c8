"""Search and proof over several axis fields: one best pose, and a bound that holds for all of them."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.options import SolveOptions
from nullpose.solver.solve_and_prove import solve_and_prove

ENOUGH_S = 600.0

SEARCH = SolveOptions(certify=False)


@pytest.fixture(scope="module")
def family(random_scene: Callable) -> Family:
    """Returns three nodes and two jammers."""
    return build_family(random_scene(np.random.default_rng(3), 3, 2, 30.0))


@pytest.fixture(scope="module")
def fields(family: Family) -> list[AxisField]:
    """Returns a null on each of the jammers, and the vertical."""
    return [AxisField.towards(family.ratios.points_m[j]) for j in (3, 4)] + [AxisField.vertical()]


def test_without_limits_nothing_is_proved(family: Family, fields: list[AxisField]) -> None:
    """The search alone gives the best of all fields, and no bound."""
    each = [solve_and_prove(family, [field], SEARCH).incumbent.log_value for field in fields]
    both = solve_and_prove(family, fields, SEARCH)
    assert both.incumbent.log_value == max(each)
    assert both.chosen == int(np.argmax(each))
    assert (both.proofs, both.upper_bound, both.reason, both.nodes) == ((), None, "", 0)


def test_every_field_is_proved(family: Family, fields: list[AxisField]) -> None:
    """There is a proof for each field, all at the level of the best, and the bound is the largest."""
    effort = SolveOptions(gap=1e-3, time_limit_s=ENOUGH_S)
    outcome = solve_and_prove(family, fields, effort)
    value = np.exp(outcome.incumbent.log_value)
    assert outcome.reason == ""
    assert len(outcome.proofs) == len(fields)
    assert outcome.upper_bound == max(proof.upper_bound for proof in outcome.proofs)
    assert value <= outcome.upper_bound <= value * 1.001
    assert outcome.nodes == sum(proof.nodes for proof in outcome.proofs)
    for proof in outcome.proofs:
        assert np.all(proof.leaves[:, 6] <= outcome.upper_bound)
    thorough = solve_and_prove(family, fields, SolveOptions(seed=9, certify=False))
    assert np.exp(thorough.incumbent.log_value) <= outcome.upper_bound
    axis = outcome.incumbent.axis / np.linalg.norm(outcome.incumbent.axis)
    chosen = fields[outcome.chosen]
    wanted = chosen.offset + chosen.matrix @ outcome.incumbent.position_m
    assert abs(axis @ wanted) == pytest.approx(np.linalg.norm(wanted))


def test_the_order_of_the_fields_does_not_matter(family: Family, fields: list[AxisField]) -> None:
    """Turned round, the same field is chosen and the same bound is proved, to the gap."""
    effort = SolveOptions(gap=1e-3, time_limit_s=ENOUGH_S)
    there, back = solve_and_prove(family, fields, effort), solve_and_prove(family, fields[::-1], effort)
    assert back.chosen == len(fields) - 1 - there.chosen
    assert back.incumbent.log_value == pytest.approx(there.incumbent.log_value, abs=1e-3)


def test_limits_are_shared_by_the_fields(family: Family, fields: list[AxisField]) -> None:
    """A limit on nodes is one for all fields; what was not closed is told, and the bound holds."""
    effort = SolveOptions(gap=1e-8, node_limit=200, time_limit_s=ENOUGH_S)
    outcome = solve_and_prove(family, fields, effort)
    assert "node limit" in outcome.reason
    assert outcome.nodes <= 200 + len(fields)
    best = solve_and_prove(family, fields, SEARCH).incumbent.log_value
    assert outcome.upper_bound >= np.exp(best)
