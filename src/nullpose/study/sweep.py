"""Many solves along one setting of a scenario."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from types import MappingProxyType
from typing import Unpack

from nullpose.errors import Fault, ScenarioError, UsageError
from nullpose.scenario import Override, Scenario, apply_overrides
from nullpose.schemes import PAPER_SCHEMES, Scheme
from nullpose.solve import SolveKeywords, solve
from nullpose.study.grid import solved_grid
from nullpose.study.table import SweepRow, SweepTable

__all__ = ["scenarios_along", "sweep"]


def sweep(
    scenario: Scenario,
    path: str,
    values: Sequence[float],
    *,
    schemes: Sequence[str] = PAPER_SCHEMES,
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> SweepTable:
    """Return the best pose of every scheme at every value of one setting, each with its upper bound.

    Schemes that have no meaning at some value are left out, with the reason in the table. Every value is
    checked before the first solve. An interrupt ends the sweep, during a proof as anywhere else.

    Args:
        scenario: the scenario whose setting is varied.
        path: the setting, as in ``jammers.M.power_w``.
        values: what to set it to, in its own unit.
        schemes: which cases to solve.
        on_progress: called after each solve with how many are done and how many there are.
        options: as for :func:`nullpose.solve`.

    Raises:
        ScenarioError: the path does not exist, or a value makes no valid scenario.
        UsageError: no scheme applies, or a bad limit.
        KeyboardInterrupt: Ctrl-C ended a proof.
    """
    scenarios = scenarios_along(scenario, path, values)
    reasons = {scheme: _not_applicable_along(scenarios, scheme) for scheme in map(Scheme, schemes)}
    left_out = {scheme.value: reason for scheme, reason in reasons.items() if reason}
    applicable = [scheme for scheme, reason in reasons.items() if not reason]
    if not applicable:
        raise UsageError("\n".join(f"{scheme}: {reason}" for scheme, reason in left_out.items()))

    def solved(point: tuple[float, Scenario], scheme: Scheme) -> SweepRow:
        value, varied = point
        result = solve(varied, scheme, **options)
        if result.interrupted:
            raise KeyboardInterrupt
        return SweepRow.of(value, result)

    rows = tuple(solved_grid(scenarios, applicable, solved, on_progress))
    return SweepTable(path, rows, MappingProxyType(left_out))


def scenarios_along(
    scenario: Scenario, path: str, values: Sequence[float]
) -> tuple[tuple[float, Scenario], ...]:
    """Return each value of a setting with the scenario that has it.

    Args:
        scenario: the scenario whose setting is varied.
        path: the setting, as in ``jammers.M.power_w``.
        values: what to set it to, in its own unit.

    Raises:
        ScenarioError: the path does not exist, or values make no valid scenario; every fault once.
    """
    varied: list[tuple[float, Scenario]] = []
    faults: dict[str, list[tuple[float, Fault]]] = defaultdict(list)
    for value in map(float, values):
        try:
            varied.append((value, apply_overrides(scenario, [Override(path, value)])))
        except ScenarioError as error:
            for fault in error.faults:
                faults[fault.path].append((value, fault))
    if faults:
        raise ScenarioError([_summary(found) for found in faults.values()], source=f"sweep of {path}")
    return tuple(varied)


def _not_applicable_along(scenarios: Sequence[tuple[float, Scenario]], scheme: Scheme) -> str:
    """Return why a scheme has no meaning at some value, and at which; empty if it has at all of them."""
    reasons = {value: reason for value, varied in scenarios if (reason := scheme.not_applicable(varied))}
    value, reason = next(iter(reasons.items()), (0.0, ""))
    return reason if len(reasons) in (0, len(scenarios)) else f"{reason} (at {value:g})"


def _summary(found: Sequence[tuple[float, Fault]]) -> Fault:
    """Return one fault for all the values that have it, so that a long sweep gives a short message."""
    value, fault = found[0]
    others = len(found) - 1
    more = f" and {others} other value{'s' * (others > 1)}" if others else ""
    return Fault(fault.path, f"{fault.message} (at {value:g}{more})")
