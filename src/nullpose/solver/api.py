"""The verbs: solve one scheme, compare several, the best axis at one position."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import UsageError
from nullpose.objectives import Quantity
from nullpose.physics import Pose, evaluate
from nullpose.physics.pose import as_position
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.schemes import Scheme, as_scheme
from nullpose.scenario import Scenario, require_scenario
from nullpose.solver.by_scheme import solve_scheme
from nullpose.solver.compiling import working_clock
from nullpose.solver.options import SolveKeywords, SolveOptions
from nullpose.solver.provenance import provenance
from nullpose.solver.result import Result, Results, Stats, objective_of, status_of
from nullpose.solver.rigour import Rigour
from nullpose.solver.solve_and_prove import solve_and_prove


def solve(
    scenario: Scenario,
    scheme: Scheme | str = Scheme.OPTIMUM,
    *,
    null_jammer: str | None = None,
    on_progress: Callable[[float, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> Result:
    """Return the best pose for a scenario under a scheme, and a bound that no pose exceeds.

    Maximises what the scenario asks for, the smallest SINR over the nodes (paper eq. 2.2), the smallest
    margin or the smallest secrecy rate, with the axes that the scheme and the airframe allow. The value is
    re-evaluated by :mod:`nullpose.physics` from the pose that is reported; the bound comes from a branch and
    bound over positions and axes. On a limit or an interrupt the best pose and the best bound so far are
    returned, and the status says so.

    Args:
        scenario: what to solve.
        scheme: one of :class:`Scheme`, or its name.
        null_jammer: zero interference only: the jammer to null; without it, each is tried.
        on_progress: called now and then during the proof with the gap so far and the boxes examined.
        options: those of :class:`SolveOptions`: ``gap``, ``time_limit_s``, ``node_limit``, ``threads``,
            ``certify`` and ``seed``.

    Raises:
        WrongTypeError: no scenario was given, but the path of one, say.
        UsageError: unknown scheme, one that has no meaning here, an unknown jammer, a bad seed or limit.
        SolveError: no pose reaches every node.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> result = nullpose.solve(scenario)
        >>> round(result.objective.value_db, 4), round(result.objective.upper_bound, 4), str(result.status)
        (0.9837, 1.2542, 'certified')
        >>> result.pose.position_m.round(2)
        array([-2.24, 23.82,  8.  ])
    """
    require_scenario(scenario)
    scheme = as_scheme(scheme)
    scheme.require_applicable(scenario)
    record = scheme.record
    if null_jammer is not None and not record.nulls_a_jammer:
        nulling = ", ".join(each.value for each in Scheme if each.record.nulls_a_jammer)
        raise UsageError(
            f"null jammer: given {null_jammer!r} with scheme {scheme.value}; it goes with {nulling} only"
        )
    asked = SolveOptions(**options, on_progress=on_progress).of(scenario)
    began = working_clock()
    outcome, fields = solve_scheme(scenario, record, asked, null_jammer)
    pose = Pose.of_airframe(scenario, outcome.incumbent.position_m, outcome.incumbent.axis)
    links = evaluate(scenario, pose)
    rigour = Rigour.VERIFIABLE if outcome.proofs and fields is not None else Rigour.FLOATING_POINT
    objective = objective_of(scenario, Quantity.of(scenario).least(links), outcome.upper_bound, rigour)
    status, reason = status_of(objective, asked.target, outcome.reason)
    return Result(
        scenario=scenario,
        scheme=scheme,
        status=status,
        reason=reason,
        objective=objective,
        pose=pose,
        links=links,
        stats=Stats(
            wall_s=working_clock() - began,
            starts=outcome.incumbent.starts,
            evaluations=outcome.incumbent.evaluations,
            boxes=outcome.nodes,
        ),
        provenance=provenance(asked.seed) | asked.settings,
        note=record.note(scenario, tuple(fields or ()), outcome.chosen),
        null_jammer=null_jammer,
        proofs=outcome.proofs,
    )


def compare(
    scenario: Scenario,
    *,
    schemes: Sequence[Scheme | str] = tuple(Scheme),
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> Results:
    """Return the solutions of several schemes for one scenario, those without meaning here left out.

    After an interrupt during a proof the remaining schemes are solved without one.

    Args:
        scenario: nodes, jammers, receiver and airspace.
        schemes: the schemes, in order.
        on_progress: called with how many are done and how many there are.
        options: as for :func:`solve`.

    Raises:
        WrongTypeError: no scenario was given, but the path of one, say.
        UsageError: an unknown scheme, a bad seed or limit.
        SolveError: no pose reaches every node.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> for result in nullpose.compare(scenario):
        ...     print(f"{result.label:<17} {result.objective.value_db:6.3f} dB")
        Optimum            0.984 dB
        Zero interference  0.812 dB
        Maximum gain      -0.700 dB
        Vertical          -2.160 dB
    """
    require_scenario(scenario)
    applicable = [s for s in map(as_scheme, schemes) if s.not_applicable(scenario) is None]
    solutions = []
    for done, scheme in enumerate(applicable, start=1):
        solution = solve(scenario, scheme, **options)
        solutions.append(solution)
        if solution.interrupted:
            options["certify"] = False
        if on_progress is not None:
            on_progress(done, len(applicable))
    return Results(solutions)


def best_axis(scenario: Scenario, position_m: ArrayLike) -> Pose:
    """Return the pose with the best axis at a given position, of those that the airframe reaches.

    Maximises what the scenario asks for over the axis alone: by enumeration of the active sets of one, two
    and three ratios, exact for a smallest SINR or margin; within an airframe's reach by a search and a proof,
    which few positions keep from being closed.

    Args:
        scenario: what is asked for; its airspace is not consulted.
        position_m: (3,) metres, at least the keep-out radius from every ground point.

    Raises:
        WrongTypeError: no scenario was given, but the path of one, say.
        UsageError: the position is not three finite numbers, or is too close to a ground point.
    """
    from nullpose.solver.kernels.axis import best_axis as kernel

    position = as_position(position_m)
    family = build_family(scenario)
    nearest_m = float(np.min(np.linalg.norm(family.points_m - position, axis=1)))
    if nearest_m < family.keep_out_m:
        raise UsageError(
            f"position_m: {nearest_m:.3g} m from a ground point; "
            f"allowed: at least keep_out_m = {family.keep_out_m:g} m"
        )
    band = scenario.axis_band
    axis = np.empty(3)
    if band == (0.0, 1.0):
        kernel(family.arrays, position, axis)
    else:
        here = family.at(position)
        options = SolveOptions(gap=1e-8, node_limit=_AXIS_NODES)
        axis = solve_and_prove(here, [AxisField.within(*band)], options).incumbent.axis
    return Pose.of_airframe(scenario, position, axis)


_AXIS_NODES = 50_000  # of the proof at one position, which needs few if it is closed at all
