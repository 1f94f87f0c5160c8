"""Schemes or vehicles compared, and which vehicles suffice in place of an omnidirectional one."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from types import MappingProxyType
from typing import Unpack

from nullpose.errors import SolveError, checked
from nullpose.files import PlainTable
from nullpose.objectives import USUAL, Quantity
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Airframe, Array, Scenario
from nullpose.solver import TIME_LIMIT_S, Result, SolveKeywords, SolveOptions, solve
from nullpose.solver.result import provenance
from nullpose.solver.robust import guarantee
from nullpose.study.case import (
    AIRFRAME_CASES,
    FILE_VEHICLE,
    OMNIDIRECTIONAL,
    TILTS_DEG,
    Case,
    OnProgress,
    report_steps,
)
from nullpose.study.least_tilt import TiltSearch
from nullpose.study.table import Guaranteed, ResultRow, ResultTable
from nullpose.study.vehicle_search import Sufficiency, judged

BEST_MOUNT = "-best"  # how the names of vehicles with the best mount end
TOLERANCE = 0.01  # a vehicle suffices if it reaches what the omnidirectional one can, but for this share
_ROBUST_S = 10.0  # for each vehicle's robust pose, at most


ARRAY_SIZES = (2, 4, 8)  # of the arrays that every comparison tries


def cases_of(scenario: Scenario) -> Sequence[Case]:
    """List the vehicles to try for a scenario: its own among the usual ones, if it is none of them.

    Two vehicles are the same if they reach the same axes. Arrays are for hearing nodes only, with the paper's
    antennas at both ends; their layout and spacing are those that the scenario states, or a line with half a
    wavelength from one to the next.

    Args:
        scenario: with or without an airframe or an array.
    """
    array, of_file = (
        scenario.array or Array(elements=ARRAY_SIZES[0], layout="linear", spacing_wavelengths=0.5),
        Case(name=FILE_VEHICLE, airframe=scenario.airframe),
    )
    is_another = of_file.airframe is not None and not of_file.usual
    vehicles = _placed(AIRFRAME_CASES, of_file) if is_another else AIRFRAME_CASES
    if scenario.objective != USUAL or scenario.states_antennas or scenario.has_channels:
        return vehicles
    sized = (array.model_copy(update={"elements": size}) for size in sorted({*ARRAY_SIZES, array.elements}))
    return (*vehicles, *(Case(name=f"array-{each.elements}-digital", array=each) for each in sized))


def compare_schemes(
    scenario: Scenario,
    *,
    on_progress: OnProgress = None,
    **options: Unpack[SolveKeywords],
) -> ResultTable:
    """Solve a scenario under the paper's schemes with one dipole; those without meaning there are left out.

    After an interrupt during a proof the remaining schemes are solved without one.

    Args:
        scenario: what to solve; an array is left out.
        on_progress: called after each scheme with how many are done and how many there are.
        options: as for :func:`nullpose.solver.solve`.

    Raises:
        UsageError: a bad seed or limit.
        SolveError: no pose reaches every node.
    """
    scenario = scenario.without_array
    reasons = {scheme: scheme.not_applicable(scenario) for scheme in Scheme}
    cases = [Case(name=scheme.value, scheme=scheme) for scheme in Scheme if not reasons[scheme]]
    left_out = {scheme.value: reason for scheme, reason in reasons.items() if reason}
    options["gap"] = SolveOptions(**options).of(scenario).target
    return _table(
        scenario,
        cases,
        lambda case, options: solve(scenario, case.name, **options),
        options,
        on_progress,
        left_out,
    )


@checked
def compare_airframes(
    scenario: Scenario,
    *,
    cases: Sequence[Case] | None = None,
    on_progress: OnProgress = None,
    **options: Unpack[SolveKeywords],
) -> ResultTable:
    """Solve a scenario for vehicles that differ in tilt and in the dipole's mount, and for arrays.

    The scenario's own airframe is tried as well if it states one that is none of the others. The best mount
    of the dipole is that of ``nullpose.least_tilt``. Unless a gap is stated, the others are proved
    only as near as it takes to tell whether they suffice. Where the scenario states errors, what each
    dipole guarantees is worked out at the pose that is best without them, and at the pose that guarantees
    most. After an interrupt during a proof the remaining vehicles are solved without one.

    Args:
        scenario: what to solve.
        cases: the vehicles, by the tilt that they take, the omnidirectional one among them; without it
            those of :func:`cases_of`, and those with the best mount where an antenna has an axis.
        on_progress: called after each vehicle with how many are done and how many there are.
        options: as for :func:`nullpose.solver.solve`.

    Raises:
        UsageError: a bad seed or limit.
        SolveError: no pose of the omnidirectional vehicle reaches every node.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> found = nullpose.compare_airframes(scenario)
        >>> nullpose.study.least_sufficient(found).name
        'level-best'
    """
    is_stated = options.get("gap") is not None
    options["gap"] = SolveOptions(**options).of(scenario).target
    search = TiltSearch(AIRFRAME_CASES[-1].on(scenario), 1.0 - TOLERANCE, options)
    if cases is None:
        cases = cases_of(scenario)
        if scenario.antenna_record.is_axisymmetric:
            cases = _with_best_mount(cases, search.best().mount_deg)

    def solve_case(case: Case, options: SolveKeywords) -> Result:
        search.options["certify"] = options.get("certify", True)
        if case.name == OMNIDIRECTIONAL:
            return search.whole
        if case.airframe is None or is_stated:
            return solve(case.on(scenario), **options)
        return search.solved(case.airframe)

    return _table(scenario, cases, solve_case, options, on_progress, {})


def _with_best_mount(cases: Sequence[Case], mount_deg: float) -> Sequence[Case]:
    """Add each tilt with the dipole at a mount, unless that is upright or flat."""
    for tilt_deg in TILTS_DEG if 0.0 < mount_deg < 90.0 else ():
        case = Case(
            name=f"{f'tilt-{tilt_deg}' if tilt_deg else 'level'}{BEST_MOUNT}",
            airframe=Airframe(tilt_max_deg=tilt_deg, mount_deg=mount_deg),
        )
        cases = _placed(cases, case)
    return cases


def _placed(cases: Sequence[Case], case: Case) -> Sequence[Case]:
    """Put a vehicle behind those that take no more tilt."""
    place = bisect_right(
        [math.inf if each.airframe is None else each.airframe.tilt_max_rad for each in cases],
        case.airframe.tilt_max_rad if case.airframe else math.inf,
    )
    return (*cases[:place], case, *cases[place:])


def _table(
    scenario: Scenario,
    cases: Sequence[Case],
    solve_case: Callable[[Case, SolveKeywords], Result],
    options: SolveKeywords,
    on_progress: OnProgress,
    left_out: dict[str, str],
) -> ResultTable:
    """Solve a scenario in each case; leave out those without a pose, but not the one that has any pose."""
    chosen = SolveOptions(**options).of(scenario)
    rows: list[ResultRow] = []
    for case in report_steps(cases, on_progress):
        try:
            result = solve_case(case, options)
        except SolveError as error:
            if case.array is not None or case.name in (OMNIDIRECTIONAL, Scheme.OPTIMUM.value):
                raise
            left_out[case.name] = str(error)
        else:
            options["certify"] = options.get("certify", True) and not result.interrupted
            is_usual = case.airframe is not None and not case.name.endswith(BEST_MOUNT)
            allowed = None if any(row.interrupted for row in (*rows, result)) else options
            kept = _guaranteed(result, allowed) if is_usual and scenario.is_uncertain else None
            rows.append(ResultRow.of(math.nan, result, case, kept))
    settings = MappingProxyType(provenance(chosen.seed) | chosen.settings)
    return ResultTable("", tuple(rows), MappingProxyType(left_out), scenario, settings)


def dipoles(table: ResultTable) -> tuple[ResultRow, ...]:
    """Select the vehicles with one dipole, by the tilt that they take."""
    return tuple(row for row in table.rows if row.case.array is None)


def difference(table: ResultTable, row: ResultRow) -> float:
    """Subtract the omnidirectional vehicle's value from a vehicle's, in dB or bits/s/Hz."""
    quantity, whole = row.objective.quantity, table.of(OMNIDIRECTIONAL)[0]
    return quantity.in_unit(row.objective.value) - quantity.in_unit(whole.objective.value)


def verdict_on(table: ResultTable, row: ResultRow, tolerance: float = TOLERANCE) -> Sufficiency:
    """Decide whether a vehicle reaches what the omnidirectional one can, but for a relative tolerance."""
    whole = table.of(OMNIDIRECTIONAL)[0]
    if row is whole and row.objective.value > 0.0 and row.objective.upper_bound is not None:
        return Sufficiency.SUFFICES
    return judged(row.objective, whole.objective, 1.0 - tolerance)


def least_sufficient(table: ResultTable) -> ResultRow | None:
    """Find the vehicle with one dipole and the least tilt that is proved to suffice; None if none is."""
    return next((row for row in dipoles(table) if verdict_on(table, row) is Sufficiency.SUFFICES), None)


def verdicts(table: ResultTable) -> PlainTable:
    """List what the table answers, as plain data: differences, verdicts and the least tilt that suffices."""
    least = least_sufficient(table)
    return {
        "difference_from_omnidirectional": {row.name: difference(table, row) for row in table.rows},
        "tolerance": TOLERANCE,
        "suffices": {row.name: verdict_on(table, row).value for row in table.rows},
        "least_sufficient": None if least is None else least.name,
    }


def _guaranteed(result: Result, options: SolveKeywords | None) -> Guaranteed:
    """Bound the guarantees of the pose that was found and, but after an interrupt, of the robust pose."""
    scenario, pose = result.scenario, result.pose
    nominal = Quantity.of(scenario).of_ratio(guarantee(scenario, pose.position_m, pose.antenna_axis).lower)
    if options is None:
        return Guaranteed(nominal_pose=nominal, robust_pose=None, upper_bound=None)
    limit_s = min(_ROBUST_S, options.get("time_limit_s", TIME_LIMIT_S))
    robust = solve(scenario, robust=True, **options | {"gap": None, "time_limit_s": limit_s})
    return Guaranteed(
        nominal_pose=nominal,
        robust_pose=max(nominal, robust.objective.value),
        upper_bound=robust.objective.upper_bound,
    )
