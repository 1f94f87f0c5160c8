"""Many solves along one setting of a scenario, as asked for in Python or on the command line."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from types import MappingProxyType
from typing import Unpack

import numpy as np

from nullpose.errors import Fault, ScenarioError, UsageError
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Override, Scenario, apply_overrides, require_scenario
from nullpose.solver import Result, SolveKeywords, SolveOptions, solve
from nullpose.study.case import Case
from nullpose.study.neighbours import freedom, from_freer
from nullpose.study.table import ResultRow, ResultTable

_DIGITS = 12  # significant digits kept, so that a decade lands on 0.01 and not on 0.009999999999999998


def sweep(
    scenario: Scenario,
    path: str,
    values: Sequence[float],
    *,
    schemes: Sequence[str] = tuple(Scheme),
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> ResultTable:
    """Return the best pose of every scheme at every value of one setting, each with its upper bound.

    Where the best value can only fall along the setting, a point takes the bound of a freer one if a pose of
    that one reaches it; such a row has no certificate.

    Schemes that have no meaning at some value are left out, with the reason in the table. Every value is
    checked before the first solve. An interrupt ends the sweep, during a proof as anywhere else.

    Args:
        scenario: the scenario whose setting is varied.
        path: the setting, as in ``jammers.M.power_w``.
        values: what to set it to, in its own unit.
        schemes: which cases to solve.
        on_progress: called after each solve with how many are done and how many there are.
        options: as for :func:`nullpose.solver.solve`.

    Raises:
        ScenarioError: the path does not exist, or a value makes no valid scenario.
        UsageError: no scheme applies, or a bad limit.
        KeyboardInterrupt: Ctrl-C ended a proof.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> cases = ["optimum", "maximum-gain"]
        >>> table = nullpose.sweep(scenario, "jammers.M.power_w", [1.0, 100.0], schemes=cases)
        >>> for row in table.rows:
        ...     print(f"{row.value:5g} W  {row.scheme:<13} {row.min_sinr_db:6.3f} dB")
            1 W  optimum        0.984 dB
            1 W  maximum-gain  -0.700 dB
          100 W  optimum        0.815 dB
          100 W  maximum-gain  -1.116 dB
    """
    require_scenario(scenario)
    scenarios = _scenarios_along(scenario, path, values)
    reasons = {scheme: _not_applicable_along(scenarios, scheme) for scheme in map(Scheme, schemes)}
    left_out = {scheme.value: reason for scheme, reason in reasons.items() if reason}
    applicable = [scheme for scheme, reason in reasons.items() if not reason]
    if not applicable:
        raise UsageError("\n".join(f"{scheme}: {reason}" for scheme, reason in left_out.items()))

    solve_options, sign = SolveOptions(**options), freedom(path, scenario)
    found: dict[Scheme, list[Result]] = defaultdict(list)
    rows: dict[tuple[float, Scheme], ResultRow] = {}
    # a point that bounds others comes first; without a direction the order is that of the values
    order = sorted(scenarios, key=lambda point: -sign * point[0])
    for (value, varied), scheme in product(order, applicable):
        implied = from_freer(varied, found[scheme], solve_options) if sign else None
        result = implied or solve(varied, scheme, **options)
        if result.interrupted:
            raise KeyboardInterrupt
        found[scheme].append(result)
        case = Case(name=scheme.value, scheme=scheme)
        rows[value, scheme] = ResultRow.of(value, result, case)
        if on_progress is not None:
            on_progress(len(rows), len(order) * len(applicable))
    in_order = (rows[value, scheme] for value, _ in scenarios for scheme in applicable)
    return ResultTable(path, tuple(in_order), MappingProxyType(left_out))


def _scenarios_along(
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
            varied.append((value, apply_overrides(scenario, [Override(path, value)]).without_array))
        except ScenarioError as error:
            for fault in error.faults:
                faults[fault.path].append((value, fault))
    if faults:
        raise ScenarioError([_summary(found) for found in faults.values()], source=f"sweep of {path}")
    return tuple(varied)


def _not_applicable_along(scenarios: Sequence[tuple[float, Scenario]], scheme: Scheme) -> str:
    """Give the reason for which a scheme has no meaning at a value; empty if it has at all of them."""
    reasons = {value: reason for value, varied in scenarios if (reason := scheme.not_applicable(varied))}
    value, reason = next(iter(reasons.items()), (0.0, ""))
    return reason if len(reasons) in (0, len(scenarios)) else f"{reason} (at {value:g})"


def _summary(found: Sequence[tuple[float, Fault]]) -> Fault:
    """Return one fault for all the values that have it, so that a long sweep gives a short message."""
    value, fault = found[0]
    others = len(found) - 1
    more = f" and {others} other value{'s' * (others > 1)}" if others else ""
    return Fault(fault.path, f"{fault.message} (at {value:g}{more})")


def spaced(start: float, stop: float, points: int, *, log: bool = False) -> tuple[float, ...]:
    """Return evenly spaced values, both ends included.

    Evenly in the value, or in its logarithm (a constant ratio from one to the next).

    Args:
        start: the first value, finite; positive if ``log``.
        stop: the last value, finite and other than ``start``; positive if ``log``.
        points: how many, at least 2.
        log: space the logarithms evenly.

    Raises:
        UsageError: any of these does not hold; the message lists all that do not.
    """
    needed = "a finite number above 0" if log else "a finite number"
    faults = [
        f"{name}: {value:g} given; {'a logarithmic' if log else 'a'} sweep needs {needed}"
        for name, value in (("from", start), ("to", stop))
        if not math.isfinite(value) or (log and value <= 0.0)
    ]
    if start == stop:
        faults.append(f"to: {stop:g} given, the same as from; a sweep needs two different ends")
    if points < 2:
        faults.append(f"points: {points} given; a sweep needs at least 2")
    if faults:
        count = "1 fault" if len(faults) == 1 else f"{len(faults)} faults"
        raise UsageError("\n  ".join([f"range of the sweep: {count}", *faults]))
    values = (np.geomspace if log else np.linspace)(start, stop, points)
    return (start, *(float(f"{value:.{_DIGITS}g}") for value in values[1:-1]), stop)


@dataclass(frozen=True, slots=True)
class SweepPlan:
    """A sweep that can be run.

    Args:
        scenario: the scenario, fixed settings applied.
        path: the setting that is varied.
        values: what it is set to.
        schemes: the cases to solve.
        options: of every solve.
    """

    scenario: Scenario
    path: str
    values: tuple[float, ...]
    schemes: tuple[Scheme, ...]
    options: SolveKeywords

    def run(self, on_progress: Callable[[int, int], None] | None = None) -> ResultTable:
        """Run the sweep.

        Args:
            on_progress: called after each solve with how many are done and how many there are.
        """
        return sweep(
            self.scenario,
            self.path,
            self.values,
            schemes=self.schemes,
            on_progress=on_progress,
            **self.options,
        )


def plan_sweep(
    scenario: Scenario,
    settings: Sequence[str],
    *,
    start: float,
    stop: float,
    points: int,
    log: bool = False,
    schemes: Sequence[str] | None = None,
    **options: Unpack[SolveKeywords],
) -> SweepPlan:
    """Return the plan of a sweep, in which every value and scheme was looked at.

    Args:
        scenario: the scenario to start from.
        settings: one path to vary, and any number of ``path=value`` to fix.
        start: the first value.
        stop: the last value.
        points: how many values.
        log: space the values by a constant ratio.
        schemes: the cases to solve, each of which must apply; without it all that do.
        options: as for :func:`nullpose.solver.solve`.

    Raises:
        UsageError: not exactly one path to vary, a bad range or limit, or a scheme that does not apply.
        ScenarioError: a fixed setting is at fault.
    """
    varied = [setting.strip() for setting in settings if "=" not in setting]
    if len(varied) != 1:
        raise UsageError(
            f"--set: exactly one path to vary is needed, without a value; given {', '.join(settings)}"
        )
    SolveOptions(**options)
    values = spaced(start, stop, points, log=log)
    base = apply_overrides(scenario, [setting for setting in settings if "=" in setting])
    wanted = tuple(Scheme if schemes is None else map(Scheme, schemes))
    scenarios = _scenarios_along(base, varied[0], values)
    for scheme in wanted if schemes is not None else ():
        for _, at_value in scenarios:
            scheme.require_applicable(at_value)
    return SweepPlan(base, varied[0], values, wanted, options)
