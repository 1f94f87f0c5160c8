"""The search and the proof that a scheme asks for: over its axis fields, or by values alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from nullpose.errors import UsageError, require_usage
from nullpose.physics import Pose, evaluate, objective_of_links
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.problem.schemes import Scheme, SchemeRecord
from nullpose.scenario import Scenario
from nullpose.solver.multistart import Incumbent
from nullpose.solver.options import SolveOptions
from nullpose.solver.position_search import PositionSearch
from nullpose.solver.result import BoundedPose, Stats
from nullpose.solver.rigour import Rigour
from nullpose.solver.solve_and_prove import Outcome, solve_and_prove

_WIDE = 1.1  # bound over value, beyond which a proof that met a limit was not about to close


def solve_by_scheme(
    scenario: Scenario, scheme: Scheme, null_jammer: str | None, options: SolveOptions
) -> BoundedPose:
    """Solve a scenario with one antenna under a scheme.

    Args:
        scenario: what to solve; an array is not consulted.
        scheme: how the pose is chosen.
        null_jammer: for a scheme that nulls a jammer: which; without it each is tried and the best kept.
        options: those of the scenario.

    Raises:
        UsageError: the scheme has no meaning here, or no jammer has that name.
        SolveError: no pose reaches every node.
    """
    scheme.require_applicable(scenario)
    record = scheme.record
    if null_jammer is not None and not record.nulls_a_jammer:
        nulling = ", ".join(each.value for each in Scheme if each.record.nulls_a_jammer)
        raise UsageError(
            f"null jammer: given {null_jammer!r} with scheme {scheme.value}; it goes with {nulling} only"
        )
    outcome, fields = solve_scheme(scenario, record, options, null_jammer)
    return answer_of(scenario, scheme, outcome, fields, options)


def answer_of(
    scenario: Scenario,
    scheme: Scheme,
    outcome: Outcome,
    fields: Mapping[str, AxisField] | None,
    options: SolveOptions,
) -> BoundedPose:
    """Turn the vehicle as an outcome says, and evaluate what that gives each node.

    Args:
        scenario: what was solved, with one antenna.
        scheme: how the pose was chosen.
        outcome: of search and proof.
        fields: the axis fields of the scheme by name; None where there are none.
        options: those of the scenario.
    """
    record = scheme.record
    pose = Pose.of_airframe(scenario, outcome.incumbent.position_m, outcome.incumbent.axis)
    links = evaluate(scenario, pose)
    is_verifiable = outcome.proofs and fields is not None and scenario.prisms is None
    return BoundedPose(
        scheme=scheme,
        pose=pose,
        links=links,
        value=objective_of_links(scenario, links),
        upper_bound=outcome.upper_bound,
        reason=outcome.reason,
        settings=options.settings,
        stats=Stats(
            starts=outcome.incumbent.starts,
            evaluations=outcome.incumbent.evaluations,
            boxes=outcome.nodes,
        ),
        rigour=Rigour.VERIFIABLE if is_verifiable else None,
        note=record.note(scenario, tuple(fields or ()), outcome.chosen) or _note_on_nulls(scenario, outcome),
        proofs=outcome.proofs,
    )


def _note_on_nulls(scenario: Scenario, outcome: Outcome) -> str:
    """Name whips whose perfect nulls keep a wide gap from closing, and what to state; empty if none do."""
    name, value = f"{scenario.interferer}s", math.exp(outcome.incumbent.log_value)
    whips = [f"{name}[{at}]" for at, point in enumerate(scenario.interferers) if point.leak == 0.0]
    is_wide = outcome.reason and (outcome.upper_bound or 0.0) > _WIDE * value
    if not (whips and is_wide) or getattr(scenario.antenna_record, "leak", 1.0) > 0.0:
        return ""
    return (
        f"polarisation lets the {name} with perfect whips vanish together with those in the drone's null, on "
        "a whole surface of positions; around it the proof hardly closes, whatever the limit. State how deep "
        f"a whip's null is, 15 to 35 dB beside a mast or a body ({', '.join(whips)}: null_depth_db = 20), or "
        "ask for the robust pose (--robust)"
    )


def family_of(scenario: Scenario) -> Family:
    """Build the family of a scenario with one antenna.

    Raises:
        UsageError: no search and proof here know its channels or its objective with its antenna.
    """
    is_dipole = scenario.antenna_record.is_quadratic
    return build_family(
        scenario,
        any_antenna=True,
        any_channel=True,
        any_function=is_dipole,
        any_objective=is_dipole and not scenario.has_custom_channels,
    )


def solve_scheme(
    scenario: Scenario, record: SchemeRecord, options: SolveOptions, null_jammer: str | None
) -> tuple[Outcome, Mapping[str, AxisField] | None]:
    """Search under a scheme and prove the result if asked to; also name the axis fields.

    Args:
        scenario: what to solve; one in which the scheme has a meaning.
        record: what the scheme states of itself.
        options: what is asked for.
        null_jammer: for a scheme that nulls a jammer: which; without it each is tried and the best kept.

    Raises:
        UsageError: no jammer has that name.
        SolveError: no pose reaches every node.
    """
    require_usage(
        null_jammer in (None, *scenario.jammer_names),
        f"null jammer: given {null_jammer!r}; the scenario's jammers are {', '.join(scenario.jammer_names)}",
    )
    if scenario.objective_record.of_nodes is not None:
        from nullpose.solver.custom_objective import solve_by_function  # and SciPy with it

        named = record.fields(scenario, null_jammer) or {}
        return solve_by_function(scenario, list(named.values()), options), named
    family = family_of(scenario)
    if not scenario.antenna_record.is_quadratic:
        from nullpose.solver.pattern import solve_pattern  # and SciPy with it

        return solve_pattern(scenario, family, options), {}
    fields = record.fields(scenario, null_jammer)
    if scenario.has_custom_channels:
        from nullpose.solver.custom_channel import solve_custom  # and SciPy with it

        if fields is None:
            raise UsageError("channel: given a function in Python; maximum gain then needs two nodes")
        return solve_custom(scenario, family, list(fields.values()), options), fields
    if fields is None:
        return _by_values(record, family, options), None
    return solve_and_prove(family, list(fields.values()), options), fields


def _by_values(record: SchemeRecord, family: Family, options: SolveOptions) -> Outcome:
    """Search by values, the axis serving the nodes best, and take the bound of a free axis."""
    from nullpose.solver.kernels.search.maximum_gain import maximum_gain_value

    axis = np.empty(3)
    log_value = partial(maximum_gain_value, family.ratios, axis=axis)
    search = PositionSearch(log_value, family, options.seed)
    search.search()
    log_value(search.state)  # fills the axis
    ratios = len(family.ratios.numerator_point)
    found = Incumbent(
        position_m=search.state,
        axis=axis,
        log_value=search.best,
        multipliers=np.full(ratios, 1.0 / ratios),
        starts=search.starts,
        evaluations=search.evaluations,
    )
    if not options.certify:
        return Outcome(incumbent=found)
    relaxed = solve_and_prove(family, [AxisField.free()], options)
    reason = relaxed.reason or record.unproved  # an interrupt or a limit comes first
    return replace(relaxed, incumbent=found, reason=reason)
