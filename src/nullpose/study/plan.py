"""A sweep as it is asked for on the command line, checked in full before any work."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Unpack

from nullpose.errors import UsageError
from nullpose.scenario import Scenario, apply_overrides
from nullpose.schemes import PAPER_SCHEMES, Scheme
from nullpose.solve import SolveKeywords, SolveOptions
from nullpose.study.spacing import spaced
from nullpose.study.sweep import scenarios_along, sweep
from nullpose.study.table import SweepTable

__all__ = ["SweepPlan", "plan_sweep"]


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

    def run(self, on_progress: Callable[[int, int], None] | None = None) -> SweepTable:
        """Return what the sweep finds.

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
        schemes: the cases to solve, each of which must apply; without it all of the paper's that do.
        options: as for :func:`nullpose.solve`.

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
    wanted = PAPER_SCHEMES if schemes is None else tuple(Scheme(name) for name in schemes)
    scenarios = scenarios_along(base, varied[0], values)
    for scheme in wanted if schemes is not None else ():
        for _, at_value in scenarios:
            scheme.require_applicable(at_value)
    return SweepPlan(base, varied[0], values, wanted, options)
