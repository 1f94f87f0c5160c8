"""Search and proof over several axis fields: one best pose, and a bound that holds for all of them."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.family import AxisField, Family, build_family
from nullpose.solve.effort import Effort
from nullpose.solve.limits import Limits
from nullpose.solve.settle import settle

ENOUGH_S = 600.0


@pytest.fixture(scope="module")
def family(random_scene: Callable) -> Family:
    """Returns three nodes and two jammers."""
    return build_family(random_scene(np.random.default_rng(3), 3, 2, 30.0))


@pytest.fixture(scope="module")
def fields(family: Family) -> list[AxisField]:
    """Returns a null on each of the jammers, and the vertical."""
    return [AxisField.towards(family.points_m[j]) for j in (3, 4)] + [AxisField.vertical()]


def test_without_limits_nothing_is_proved(family: Family, fields: list[AxisField]) -> None:
    """The search alone gives the best of all fields, and no bound."""
    each = [settle(family, [field], Effort()).found.log_value for field in fields]
    both = settle(family, fields, Effort())
    assert both.found.log_value == max(each)
    assert both.chosen == int(np.argmax(each))
    assert (both.proofs, both.upper_bound, both.reason, both.nodes) == ((), None, "", 0)


def test_every_field_is_proved(family: Family, fields: list[AxisField]) -> None:
    """There is a proof for each field, all at the level of the best, and the bound is the largest."""
    effort = Effort(limits=Limits(gap=1e-3, time_limit_s=ENOUGH_S))
    settled = settle(family, fields, effort)
    value = np.exp(settled.found.log_value)
    assert settled.reason == ""
    assert len(settled.proofs) == len(fields)
    assert settled.upper_bound == max(proof.upper_bound for proof in settled.proofs)
    assert value <= settled.upper_bound <= value * 1.001
    assert settled.nodes == sum(proof.nodes for proof in settled.proofs)
    for proof in settled.proofs:
        assert np.all(proof.leaves[:, 6] <= settled.upper_bound)
    thorough = settle(family, fields, Effort(seed=9))
    assert np.exp(thorough.found.log_value) <= settled.upper_bound
    axis = settled.found.axis / np.linalg.norm(settled.found.axis)
    chosen = fields[settled.chosen]
    wanted = chosen.offset + chosen.matrix @ settled.found.position_m
    assert abs(axis @ wanted) == pytest.approx(np.linalg.norm(wanted))


def test_the_order_of_the_fields_does_not_matter(family: Family, fields: list[AxisField]) -> None:
    """Turned round, the same field is chosen and the same bound is proved, to the gap."""
    effort = Effort(limits=Limits(gap=1e-3, time_limit_s=ENOUGH_S))
    there, back = settle(family, fields, effort), settle(family, fields[::-1], effort)
    assert back.chosen == len(fields) - 1 - there.chosen
    assert back.found.log_value == pytest.approx(there.found.log_value, abs=1e-3)


def test_searches_are_counted_once(family: Family, fields: list[AxisField]) -> None:
    """Starts and evaluations are those of all fields together."""
    each = [settle(family, [field], Effort()).found for field in fields]
    both = settle(family, fields, Effort()).found
    assert both.starts == sum(found.starts for found in each)
    assert both.evaluations == sum(found.evaluations for found in each)


def test_limits_are_shared_by_the_fields(family: Family, fields: list[AxisField]) -> None:
    """A limit on nodes is one for all fields; what was not closed is told, and the bound holds."""
    effort = Effort(limits=Limits(gap=1e-8, node_limit=200, time_limit_s=ENOUGH_S))
    settled = settle(family, fields, effort)
    assert "node limit" in settled.reason
    assert settled.nodes <= 200 + len(fields)
    best = settle(family, fields, Effort()).found.log_value
    assert settled.upper_bound >= np.exp(best)
