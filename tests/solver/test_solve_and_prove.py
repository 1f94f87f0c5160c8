"""Search and proof over several axis fields: one best pose, and a bound that holds for all of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from nullpose import Scenario, solve
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


NULL = {"antenna": {"null_depth_db": 0.0}}
LEVEL_HALF_WAVE = {"antenna": {"kind": "half-wave"}, "airframe": {"tilt_max_deg": 0.0, "mount_deg": 45.0}}


def scene(seed: int, nodes: int, jammers: int, whips: bool, **more: Any) -> Scenario:
    """Returns random nodes and jammers on a field of 60 m, all with upright whips or none."""
    rng = np.random.default_rng(seed)

    def points(count: int, low: float, high: float) -> list[dict[str, Any]]:
        whip = {"antenna": "dipole"} if whips else {}
        places = rng.uniform(0.0, 60.0, (count, 2))
        powers_w = 10.0 ** rng.uniform(low, high, count)
        return [
            {"position_m": [x, y, 0.0], "power_w": power_w, **whip}
            for (x, y), power_w in zip(places.tolist(), powers_w.tolist(), strict=True)
        ]

    return Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": points(nodes, -0.5, 0.5),
            "jammers": points(jammers, -2.0, 3.0),
            **more,
        }
    )


@pytest.mark.parametrize("node_limit", [300, 6000])
@pytest.mark.parametrize("nodes", [1, 8])
def test_a_proof_costs_no_answer(nodes: int, node_limit: int) -> None:
    """Where whips have perfect nulls, a proof that stops early has a pose as good as that of `--fast`."""
    for seed in range(20):
        scenario = scene(seed, nodes, 3, whips=True, **NULL)
        fast, proved = solve(scenario, certify=False), solve(scenario, node_limit=node_limit)
        assert proved.objective.value >= fast.objective.value / (1.0 + 1e-4), seed


def test_a_proof_costs_no_answer_for_a_pattern() -> None:
    """Likewise for half-wave antennas on level vehicles, whatever the seed."""
    scenario = scene(2, 8, 2, whips=False, **LEVEL_HALF_WAVE)
    fast = solve(scenario, certify=False).objective.value
    for seed in range(3):
        proved = solve(scenario, node_limit=1000, seed=seed)
        assert proved.objective.value == pytest.approx(fast, rel=1e-4)


def test_seeds_agree() -> None:
    """Where proofs stop early, several seeds give the same value."""
    for scenario in (scene(seed, 2, 3, whips=True, **NULL) for seed in range(5)):
        values = [solve(scenario, node_limit=300, seed=seed).objective.value for seed in range(4)]
        assert min(values) >= max(values) * (1.0 - 1e-6)
