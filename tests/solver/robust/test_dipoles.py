"""Guarantees where nodes or jammers have dipoles."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import and_slow, few_examples

from nullpose.physics import ErrorCase, ratios_under, rotation_between
from nullpose.scenario import Scenario
from nullpose.solver import solve
from nullpose.solver.robust import guarantee


def erring(scenario: Scenario, null_depth_db: float | None) -> Scenario:
    """Return a scenario with whips everywhere, and with errors of every kind."""
    data = scenario.to_dict()
    for point in [*data["nodes"], *data["jammers"]]:
        point["antenna"] = "dipole"
        if null_depth_db is not None:
            point["null_depth_db"] = 15.0
    data["receiver"] |= {"attitude_error_deg": 2.0, "position_error_m": 0.5}
    data["jammers"][0]["uncertainty_m"] = 3.0
    if null_depth_db is not None:
        data["antenna"] = {"null_depth_db": null_depth_db}
    return Scenario.from_dict(data)


@pytest.mark.parametrize("null_depth_db", [None, 25.0])
@given(seed=st.integers(0, 2**32 - 1))
@few_examples(2)
def test_no_error_case_is_below_the_guarantee(
    null_depth_db: float | None, seed: int, paper: Callable
) -> None:
    """Axis, position and jammer anywhere within their errors: every ratio is at least what is guaranteed."""
    rng = np.random.default_rng(seed)
    scenario = erring(paper(1.0), null_depth_db)
    position_m, axis = rng.uniform([-20.0, 5.0, 8.0], [20.0, 45.0, 20.0]), rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    held = guarantee(scenario, position_m, axis)
    assert held.lower <= held.worst
    for _ in range(50):
        away, shift, moved = rng.normal(size=(3, 3))
        away -= axis * (away @ axis)
        angle = np.radians(2.0) * rng.random()
        turned = np.cos(angle) * axis + np.sin(angle) * away / np.linalg.norm(away)
        case = replace(
            ErrorCase.none(scenario),
            rotation_world=rotation_between(axis, turned),
            position_offset_m=0.5 * rng.random() * shift / np.linalg.norm(shift),
            jammer_offsets_m=3.0 * rng.random() * moved[None] / np.linalg.norm(moved),
        )
        there = ratios_under(scenario, position_m, axis, case)
        for ratio, one in zip(there.ravel(), held.ratios, strict=True):
            assert ratio >= one.lower * (1.0 - 1e-9)


def hovering(*, whips: bool, seed: int = 0) -> Scenario:
    """Return a scene of five nodes and a jammer, a level vehicle, and errors of all kinds."""
    rng = np.random.default_rng(seed)

    def point(**power: float) -> dict[str, Any]:
        place = [*rng.uniform(-300.0, 300.0, 2).tolist(), float(rng.uniform(1.0, 10.0))]
        return {"position_m": place, **power} | ({"antenna": "dipole"} if whips else {})

    receiver = {"noise_dbm": -97.0, "reference_gain_db": -40.0}
    return Scenario.from_dict(
        {
            "nodes": [point(power_w=0.5) for _ in range(5)],
            "jammers": [point(power_w=5.0) | {"uncertainty_m": 3.0}],
            "receiver": receiver | {"attitude_error_deg": 3.0, "position_error_m": 3.0},
            "airspace": {"x_m": [-300.0, 300.0], "y_m": [-300.0, 300.0], "altitude_m": [30.0, 120.0]},
            "antenna": {"null_depth_db": 20.0},
            "airframe": {"tilt_max_deg": 0.0},
        }
    )


@pytest.mark.parametrize(("whips", "accuracy"), and_slow([(False, 0.05)], [(True, 0.3)]))
def test_the_guarantee_straight_above_a_jammer_settles(*, whips: bool, accuracy: float) -> None:
    """In both nulls, with a leak and a ball, the bound is close after few cells and holds."""
    scenario = hovering(whips=whips)
    position_m, axis = scenario.jammer_positions_m[0] + [0.0, 0.0, 32.0], np.array([0.0, 0.0, 1.0])
    held = guarantee(scenario, position_m, axis, accuracy=1e-2)
    assert held.cells <= 20_000 * len(scenario.nodes)
    lower = np.array([one.lower for one in held.ratios])
    assert np.all(lower >= (1.0 - accuracy) * np.array([one.worst for one in held.ratios]))
    rng = np.random.default_rng(1)
    for _ in range(1000):
        lean, shift, moved = (x / max(1.0, float(np.linalg.norm(x))) for x in rng.normal(size=(3, 3)))
        angle = np.radians(3.0) * float(np.linalg.norm(lean[:2]))
        turned = np.array([*np.radians(3.0) * lean[:2], 0.0])
        turned = np.cos(angle) * axis + turned * (np.sin(angle) / angle)
        case = replace(
            ErrorCase.none(scenario),
            rotation_world=rotation_between(axis, turned),
            position_offset_m=3.0 * shift,
            jammer_offsets_m=(scenario.jammer_uncertainty_m[0] * moved)[None],
        )
        assert np.all(ratios_under(scenario, position_m, axis, case)[:, 0] >= lower)


def test_the_pose_without_errors_is_what_solve_certifies(paper: Callable) -> None:
    """The best pose without errors has the value that solve certifies: jammers keep their whips."""
    scenario = erring(paper(0.1), None)
    solution = solve(scenario, robust=True, certify=False)
    assert solution.details.nominal.nominal == pytest.approx(solve(scenario).objective.value, rel=1e-4)
    assert solution.details.robust.guaranteed > solution.details.nominal.guaranteed


@pytest.mark.parametrize("ratio", [0.1, pytest.param(1.0, marks=pytest.mark.slow)])
def test_a_robust_pose_is_close_to_its_bound(ratio: float, paper: Callable) -> None:
    """The guarantee of the best pose is within some percent of a bound, with whips on all points."""
    solution = solve(erring(paper(ratio), None), robust=True)
    assert solution.objective.upper_bound <= 1.04 * solution.details.robust.guaranteed
    assert solution.status == "certified" or "most cells" in solution.reason
    assert solution.scenario == erring(paper(ratio), None)
    nodes_only = erring(paper(ratio), None).to_dict()
    del nodes_only["jammers"][0]["antenna"]
    isotropic = solve(Scenario.from_dict(nodes_only), robust=True)
    assert solution.details.robust.guaranteed >= isotropic.details.robust.guaranteed  # a whip jams less
