"""A sweep as it is asked for on the command line, checked in full before any work."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from nullpose.errors import UsageError
from nullpose.files import prepare_folder
from nullpose.scenario import Scenario, apply_overrides
from nullpose.solve import NODE_LIMIT, PAPER_SCHEMES, TIME_LIMIT_S, Scheme, default_gap_of
from nullpose.solve.options import SolveOptions
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
        folder: where the results go; it exists and can be written.
        seed: the random seed of every solve.
        limits: target and limits of every proof; None proves nothing.
    """

    scenario: Scenario
    path: str
    values: tuple[float, ...]
    schemes: tuple[Scheme, ...]
    folder: Path
    seed: int
    limits: SolveOptions | None

    def run(self, on_progress: Callable[[int, int], None] | None = None) -> SweepTable:
        """Return what the sweep finds.

        Args:
            on_progress: called after each solve with how many are done and how many there are.
        """
        limits = self.limits
        return sweep(
            self.scenario,
            self.path,
            self.values,
            schemes=self.schemes,
            gap=None if limits is None else limits.target,
            time_limit_s=TIME_LIMIT_S if limits is None else limits.time_limit_s,
            node_limit=NODE_LIMIT if limits is None else limits.node_limit,
            certify=limits is not None,
            seed=self.seed,
            on_progress=on_progress,
        )


def plan_sweep(
    scenario: Scenario,
    settings: Sequence[str],
    *,
    start: float,
    stop: float,
    points: int,
    out: Path,
    log: bool = False,
    schemes: Sequence[str] | None = None,
    gap: float | None = None,
    time_limit_s: float = TIME_LIMIT_S,
    node_limit: int = NODE_LIMIT,
    certify: bool = True,
    seed: int = 0,
) -> SweepPlan:
    """Return the plan of a sweep, its output folder made.

    Args:
        scenario: the scenario to start from.
        settings: one path to vary, and any number of ``path=value`` to fix.
        start: the first value.
        stop: the last value.
        points: how many values.
        out: where the results go.
        log: space the values by a constant ratio.
        schemes: the cases to solve, each of which must apply; without it all of the paper's that do.
        gap: relative gap at which each proof is done; without it, by the number of nodes.
        time_limit_s: seconds after which each proof stops.
        node_limit: boxes after which each proof stops.
        certify: whether to prove anything.
        seed: the random seed of every solve.

    Raises:
        UsageError: not exactly one path to vary, a bad range or limit, or a scheme that does not apply.
        ScenarioError: a fixed setting is at fault.
        OutputError: the folder cannot be written.
    """
    varied = [setting for setting in settings if "=" not in setting]
    if len(varied) != 1:
        given = ", ".join(settings)
        raise UsageError(f"--set: exactly one path to vary is needed, without a value; given {given}")
    values = spaced(start, stop, points, log=log)
    base = apply_overrides(scenario, [setting for setting in settings if "=" in setting])
    wanted = PAPER_SCHEMES if schemes is None else tuple(Scheme(name) for name in schemes)
    target = default_gap_of(base) if gap is None else gap
    limits = SolveOptions(gap=target, time_limit_s=time_limit_s, node_limit=node_limit)
    path = varied[0].strip()
    scenarios = scenarios_along(base, path, values)  # a fault shows before a folder is made
    if schemes is not None:
        for scheme in wanted:
            for _, at_value in scenarios:
                scheme.require_applicable(at_value)
    return SweepPlan(base, path, values, wanted, prepare_folder(out), seed, limits if certify else None)
