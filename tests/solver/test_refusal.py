"""What the solver refuses is known before it is asked."""

import pytest

from nullpose import Scenario, apply_overrides, load, solve
from nullpose.errors import UsageError
from nullpose.solver.refusal import refusal
from scenes import EXAMPLES


def _scene(name: str) -> Scenario:
    scenario = apply_overrides(load(EXAMPLES / f"{name}.toml"), ["receiver.attitude_error_deg=1"])
    if name == "frame":  # a pattern that nobody can solve beside a channel
        return scenario.model_copy(update={"channel": load(EXAMPLES / "urban.toml").channel})
    return scenario


@pytest.mark.parametrize("robust", [False, True])
@pytest.mark.parametrize("name", ["paper", "town", "urban", "frame"])
def test_it_is_the_solvers_own_refusal(name: str, robust: bool) -> None:
    """In the solver's words where it refuses to solve, and nothing where it solves."""
    scenario, said = _scene(name), None
    try:
        solve(scenario, robust=robust, certify=False)
    except UsageError as error:
        said = str(error)
    assert refusal(scenario, robust=robust) == said
