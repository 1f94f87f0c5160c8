"""Many solves along one setting of a scenario."""

from __future__ import annotations

import math
import re
import time
from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import product
from types import MappingProxyType
from typing import Unpack

import numpy as np

from nullpose.errors import Fault, ScenarioError, UsageError, checked, require_usage
from nullpose.objectives import Quantity
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Override, Scenario, apply_overrides
from nullpose.scenario.faults import raise_all
from nullpose.solver import Result, SolveKeywords, SolveOptions, Status, solve
from nullpose.solver.objective import status_of
from nullpose.solver.result import Stats
from nullpose.study.case import SHARE, Case, OnProgress, report_steps
from nullpose.study.evaluation import evaluated
from nullpose.study.least_tilt import tilt_search, uninterrupted
from nullpose.study.table import ResultRow, ResultTable

_FREER = {
    r"airframe\.tilt_max_(deg|rad)": 1.0,
    r"jammers(\.\w+|\[\d+\])\.power_(w|dbm)": -1.0,
    r"receiver\.noise_(w|dbm)": -1.0,
}
"""Settings, and in which direction no pose gets worse and none is lost."""


def freedom(path: str, scenario: Scenario) -> float:
    """Return 1 if the best value can only grow with a setting, -1 if it can only fall, 0 if neither is known.

    Where tilt limits grow, the attitudes of the smaller one are among those of the larger. Less jamming and
    less noise raise every SINR, but also an eavesdropper's.

    Args:
        path: the setting, as in ``jammers.M.power_w``.
        scenario: what is swept.
    """
    sign = next((sign for pattern, sign in _FREER.items() if re.fullmatch(pattern, path)), 0.0)
    at_every_pose = path.startswith("airframe") or not Quantity.of(scenario).is_rate
    return sign if at_every_pose and scenario.array is None else 0.0


def from_freer(scenario: Scenario, freer: Sequence[Result], options: SolveOptions) -> Result | None:
    """Return the certified result that results of freer points imply, or None.

    Their least upper bound holds here, too; if one of their poses is allowed here and comes near to that
    bound, nothing is left to solve. The proof of the bound holds here as it is.

    Args:
        scenario: the point.
        freer: results of one scheme at points where every pose is as good or better.
        options: with the gap that is asked for.
    """
    began, solve_options = time.perf_counter(), options.of(scenario)
    bounds = ((result.objective.upper_bound, result) for result in freer)
    proved = [(bound, result) for bound, result in bounds if bound is not None]
    bound, best = min(proved, key=lambda pair: pair[0], default=(0.0, None))
    airframe = scenario.airframe
    if best is None or (airframe is not None and best.pose.tilt_rad > airframe.tilt_max_rad):
        return None
    reused = evaluated(best, scenario, best.pose, bound)
    status, _ = status_of(reused.objective, solve_options.target, "not solved by itself")
    if status is not Status.CERTIFIED:
        return None
    return replace(
        reused,
        scheme=best.scheme,
        note=best.note,
        status=status,
        proofs=best.proofs,
        stats=Stats(wall_s=time.perf_counter() - began, evaluations=1),
    )


_DIGITS = 12  # significant digits kept, so that a decade lands on 0.01 and not on 0.009999999999999998


@checked
def sweep(
    scenario: Scenario,
    path: str,
    values: Sequence[float],
    *,
    schemes: Sequence[str] | None = None,
    mounts_deg: Sequence[float] | None = None,
    share: float = SHARE,
    on_progress: OnProgress = None,
    **options: Unpack[SolveKeywords],
) -> ResultTable:
    """Return the best pose of every scheme at every value of one setting, each with its upper bound.

    Where the best value can only fall along the setting, a point takes the bound of a freer one, with its
    proof, if a pose of that one reaches it.

    Every value is checked before the first solve. An interrupt ends the sweep, during a proof as anywhere
    else.

    Args:
        scenario: the scenario whose setting is varied; an array is left out.
        path: the setting, as in ``jammers.M.power_w``.
        values: what to set it to, in its own unit.
        schemes: which cases to solve, each of which must have a meaning at every value; without it all that
            have, the others being left out with the reason in the table.
        mounts_deg: in place of schemes, mounts of the antenna, of each of which the least tilt is found as by
            ``nullpose.least_tilt``.
        share: of the omnidirectional value that suffices for the least tilt.
        on_progress: called after each solve with how many are done and how many there are.
        options: as for :func:`nullpose.solver.solve`.

    Raises:
        ScenarioError: the path does not exist, or a value makes no valid scenario.
        UsageError: a scheme does not apply, a bad limit, or mounts with schemes or along the airframe.
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
    chosen, sign = SolveOptions(**options), freedom(path, scenario)
    scenarios = _scenarios_along(scenario, path, values)
    if mounts_deg is not None:
        require_usage(
            mounts_deg and schemes is None and not path.startswith("airframe"),
            f"mounts: given {[*mounts_deg] or 'best'} along {path}; allowed: angles in degrees, without "
            "schemes, along a setting other than the airframe's",
        )
        return ResultTable(
            path, tuple(_least_tilts(scenarios, dict.fromkeys(mounts_deg), share, on_progress, options))
        )
    every = Scheme if schemes is None else map(Scheme, schemes)
    reasons = {scheme: _meaningless(scheme, scenarios) for scheme in every}
    left_out = {scheme.value: reason for scheme, reason in reasons.items() if reason}
    if left_out and schemes is not None:
        raise UsageError("scheme {}: {}; try another scheme".format(*next(iter(left_out.items()))))
    cases = [Case(name=scheme.value, scheme=scheme) for scheme, reason in reasons.items() if not reason]
    found: dict[str, list[Result]] = defaultdict(list)
    rows: dict[tuple[float, str], ResultRow] = {}
    # a point that bounds others comes first; without a direction the order is that of the values
    order = sorted(scenarios, key=lambda point: -sign * point[0])
    for (value, varied), case in report_steps([*product(order, cases)], on_progress):
        implied = from_freer(varied, found[case.name], chosen) if sign else None
        result = implied or uninterrupted(solve(varied, case.name, **options))
        found[case.name].append(result)
        rows[value, case.name] = ResultRow.of(value, result, case)
    in_order = (rows[value, case.name] for value, _ in scenarios for case in cases)
    return ResultTable(path, tuple(in_order), MappingProxyType(left_out))


def _meaningless(scheme: Scheme, scenarios: Sequence[tuple[float, Scenario]]) -> str:
    """Give the reason for which a scheme has no meaning at the first such value; empty if it has."""
    reasons = ((value, scheme.not_applicable(varied)) for value, varied in scenarios)
    return next((f"{reason} (at {value:g})" for value, reason in reasons if reason), "")


def _least_tilts(
    scenarios: Sequence[tuple[float, Scenario]],
    mounts_deg: Collection[float],
    share: float,
    on_progress: OnProgress,
    options: SolveKeywords,
) -> Iterator[ResultRow]:
    """Find the least tilt of every mount at every value.

    Raises:
        ScenarioError: a share or a mount that is not allowed, before the first solve.
    """
    cases = [
        Case.from_dict(
            {
                "name": f"mount {mount_deg:.9g}",
                "airframe": {"tilt_max_deg": "least", "mount_deg": mount_deg},
                "reach": share,
            }
        )
        for mount_deg in mounts_deg
    ]
    search_at = lru_cache(maxsize=1)(lambda point: tilt_search(scenarios[point][1], share, options))
    steps = product(range(len(scenarios)), zip(mounts_deg, cases, strict=True))
    for point, (mount_deg, case) in report_steps([*steps], on_progress):
        search = search_at(point)
        mount = search.sides(mount_deg)
        yield ResultRow.of(scenarios[point][0], search.result_of(mount), case, tilt=mount)


def _scenarios_along(
    scenario: Scenario, path: str, values: Sequence[float]
) -> tuple[tuple[float, Scenario], ...]:
    """Pair each value of a setting with the scenario that has it.

    Raises:
        ScenarioError: the path does not exist, or values make no valid scenario; every fault once, so that a
            long sweep gives a short message.
    """
    varied: list[tuple[float, Scenario]] = []
    faults: dict[str, list[tuple[float, str]]] = defaultdict(list)
    for value in map(float, values):
        try:
            varied.append((value, apply_overrides(scenario, [Override(path, value)]).without_array))
        except ScenarioError as error:
            for fault in error.faults:
                faults[fault.path].append((value, fault.message))
    raise_all([_first(place, wrong) for place, wrong in faults.items()], f"sweep of {path}")
    return tuple(varied)


def _first(place: str, wrong: Sequence[tuple[float, str]]) -> Fault:
    (value, message), *others = wrong
    more = f" and {len(others)} other value{'s' * (len(others) > 1)}" if others else ""
    return Fault(place, f"{message} (at {value:g}{more})")


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
