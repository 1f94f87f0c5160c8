"""Zero interference (paper eqs. 3.1 and 3.2): the null always on a jammer."""

from __future__ import annotations

from dataclasses import replace

from nullpose.errors import UsageError
from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.effort import Effort
from nullpose.solve.settle import Settled, settle

__all__ = ["find"]


def find(scenario: Scenario, effort: Effort, *, null_jammer: str | None = None) -> Settled:
    """Return the best position with the null on one jammer.

    Args:
        scenario: what to solve; at least one jammer.
        effort: what it may cost.
        null_jammer: name of the jammer to null; without it each is tried and the best kept.

    Raises:
        UsageError: no jammer has that name.
    """
    known = scenario.jammer_names
    if null_jammer is not None and null_jammer not in known:
        raise UsageError(f"null jammer: given {null_jammer!r}; the scenario's jammers are {', '.join(known)}")
    names = known if null_jammer is None else (null_jammer,)
    positions_m = dict(zip(known, scenario.jammer_positions_m, strict=True))
    fields = [AxisField.towards(positions_m[name]) for name in names]
    settled = settle(build_family(scenario), fields, effort)
    note = f"null on jammer {names[settled.chosen]}"
    if len(names) > 1:
        note += f", the best of {len(names)}"
    return replace(settled, found=replace(settled.found, note=note))
