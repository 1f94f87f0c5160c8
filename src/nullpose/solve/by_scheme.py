"""The search and the proof that a scheme asks for: over its axis fields, or by values alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from nullpose.antenna import PatternAntenna
from nullpose.errors import UsageError
from nullpose.family import AxisField, Family, build_family
from nullpose.objectives import FloatArray
from nullpose.scenario import Scenario
from nullpose.schemes import SchemeRecord
from nullpose.solve.incumbent import Incumbent
from nullpose.solve.options import SolveOptions
from nullpose.solve.position_search import search_positions
from nullpose.solve.solve_and_prove import Outcome, solve_and_prove


def solve_scheme(
    scenario: Scenario, record: SchemeRecord, options: SolveOptions, null_jammer: str | None
) -> tuple[Outcome, Mapping[str, AxisField] | None]:
    """Return the best pose under a scheme, with a proof if one is asked for, and the fields it is over.

    Args:
        scenario: what to solve; one in which the scheme has a meaning.
        record: what the scheme states of itself.
        options: what is asked for.
        null_jammer: for a scheme that nulls a jammer: which; without it each is tried and the best kept.

    Raises:
        UsageError: no jammer has that name.
        SolveError: no pose reaches every node.
    """
    known = scenario.jammer_names
    if null_jammer is not None and null_jammer not in known:
        raise UsageError(f"null jammer: given {null_jammer!r}; the scenario's jammers are {', '.join(known)}")
    if isinstance(scenario.antenna_record, PatternAntenna):
        from nullpose.solve.pattern import solve_pattern  # and SciPy's optimisers with it

        return solve_pattern(scenario, options), {}
    family, fields = build_family(scenario), record.fields(scenario, null_jammer)
    if fields is None:
        return _by_values(scenario, record, family, options), None
    return solve_and_prove(family, list(fields.values()), options), fields


def _by_values(scenario: Scenario, record: SchemeRecord, family: Family, options: SolveOptions) -> Outcome:
    """Return what a search by values finds, under the bound of a free axis if the scheme's poses have one."""
    axis_at, log_value = _measures(scenario, record, family)
    position_m, value, starts, evaluations = search_positions(log_value, family, seed=options.seed)
    ratios = len(family.numerator_point)
    found = Incumbent(
        position_m=position_m,
        axis=axis_at(position_m),
        log_value=value,
        multipliers=np.full(ratios, 1.0 / ratios),
        starts=starts,
        evaluations=evaluations,
    )
    if record.ratios_at is not None:
        return Outcome(incumbent=found, reason=record.unproved)
    if not options.certify:
        return Outcome(incumbent=found)
    relaxed = solve_and_prove(family, [AxisField.free()], options)
    reason = relaxed.reason or record.unproved  # an interrupt or a limit comes first
    return replace(relaxed, incumbent=found, reason=reason)


def _measures(
    scenario: Scenario, record: SchemeRecord, family: Family
) -> tuple[Callable[[FloatArray], FloatArray], Callable[[FloatArray], float]]:
    """Return the axis that a scheme prescribes at a position, and the logarithm of its value there."""
    from nullpose.solve.kernels.links import min_log_ratio
    from nullpose.solve.kernels.maximum_gain import maximum_gain_value

    logs, f = np.empty(len(family.denominator_isotropic)), np.empty(len(family.numerator_point))

    def axis_at(position_m: FloatArray) -> FloatArray:
        if record.axis_at is not None:
            return record.axis_at(scenario, position_m)
        axis = np.empty(3)
        maximum_gain_value(family.arrays, position_m, axis)
        return axis

    def log_value(position_m: FloatArray) -> float:
        if record.ratios_at is not None:
            with np.errstate(divide="ignore", invalid="ignore"):  # a node on the axis is not heard
                value = float(np.log(np.min(record.ratios_at(scenario, position_m))))
            return value if np.isfinite(value) else -np.inf
        if record.axis_at is None:
            return float(maximum_gain_value(family.arrays, position_m, np.empty(3)))
        return float(min_log_ratio(family.arrays, position_m, axis_at(position_m), logs, f))

    return axis_at, log_value
