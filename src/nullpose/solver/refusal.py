"""Which scenarios the solver refuses, in its own words, before it is asked to solve them."""

from __future__ import annotations

from nullpose.errors import UsageError
from nullpose.physics.gain import worst_polarised
from nullpose.scenario import Scenario
from nullpose.solver.by_scheme import family_of
from nullpose.solver.robust.guarantee import Inner, require_dipole


def refusal(scenario: Scenario, *, robust: bool = False) -> str | None:
    """Say why one antenna has no optimum in a scenario, or no robust pose; None if it has.

    The solver's own problem is built, which refuses what it cannot hold: no second list of it is kept.

    Args:
        scenario: any; what a scheme allows is for :meth:`Scheme.not_applicable` to say.
        robust: whether the pose is to guarantee most under errors.

    Raises:
        ScenarioError: an interferer is too strong for floating-point numbers.

    Example:
        >>> import nullpose
        >>> town = nullpose.load("examples/town.toml")
        >>> refusal(town) is None, refusal(town, robust=True) is None
        (True, False)
    """
    try:
        if robust:
            Inner(worst_polarised(require_dipole(scenario)))
        else:
            family_of(scenario)
    except UsageError as error:
        return str(error)
    return None
