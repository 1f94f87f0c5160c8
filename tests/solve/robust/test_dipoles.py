"""Guarantees where nodes or jammers have dipoles."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nullpose.physics.error_case import ErrorCase, ratios_under, rotation_between
from nullpose.physics.polarisation import worst_polarised
from nullpose.scenario import Scenario
from nullpose.solve.robust import guarantee, solve_robust
from nullpose.solve.robust.solving import POLARISATION


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
@settings(max_examples=10)
def test_no_error_case_is_below_the_guarantee(
    null_depth_db: float | None, seed: int, paper: Callable
) -> None:
    """Axis, position and jammer anywhere within their errors: every ratio is at least what is guaranteed."""
    rng = np.random.default_rng(seed)
    scenario = erring(paper(1.0), null_depth_db)
    position_m, axis = rng.uniform([-20.0, 5.0, 8.0], [20.0, 45.0, 20.0]), rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    held, strict = guarantee(scenario, position_m, axis), worst_polarised(scenario)
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
        there = ratios_under(strict, position_m, axis, case)
        for ratio, one in zip(there.ravel(), held.ratios, strict=True):
            assert ratio >= one.lower * (1.0 - 1e-9)
        assert np.all(ratios_under(scenario, position_m, axis, case) >= there * (1.0 - 1e-12))


@pytest.mark.parametrize("ratio", [0.1, 1.0])
def test_a_robust_pose_is_certified(ratio: float, paper: Callable) -> None:
    """The guarantee of the best pose is within the gap of a bound, and says what it counts jammers as."""
    solution = solve_robust(erring(paper(ratio), None))
    assert solution.status == "certified"
    assert solution.note == POLARISATION
    assert solution.scenario == erring(paper(ratio), None)
    nodes_only = erring(paper(ratio), None).to_dict()
    del nodes_only["jammers"][0]["antenna"]
    assert solve_robust(Scenario.from_dict(nodes_only)).note == ""
