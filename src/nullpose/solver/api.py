"""The verbs: solve one scheme, compare several, the best axis at one position."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import RequirementError, UsageError, checked, require_usage
from nullpose.physics import Pose
from nullpose.physics.pose import as_position
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.schemes import Scheme, as_scheme
from nullpose.scenario import Scenario
from nullpose.solver.array import solve_array
from nullpose.solver.by_scheme import solve_by_scheme
from nullpose.solver.compiling import working_clock
from nullpose.solver.hover import HOVER_GAP, solve_hover
from nullpose.solver.options import SolveKeywords, SolveOptions
from nullpose.solver.result import Result, Results, result_of
from nullpose.solver.robust.exchange import ROBUST_GAP, solve_robust
from nullpose.solver.sensitivity import ErrorSizes
from nullpose.solver.solve_and_prove import solve_and_prove


@checked
def solve(
    scenario: Scenario,
    scheme: Scheme | str = Scheme.OPTIMUM,
    *,
    robust: bool = False,
    hover: bool = False,
    null_jammer: str | None = None,
    on_progress: Callable[[float, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> Result:
    """Find the best pose for a scenario, and a bound that no pose exceeds.

    Maximises what the scenario asks for, the smallest SINR over the nodes (paper eq. 2.2), the smallest
    margin or the smallest secrecy rate, with the axes that the scheme and the airframe allow. A scenario with
    an array is solved for position and yaw of a level vehicle, each node with combining weights of its own.
    With ``robust`` the pose is found that guarantees most when the scenario's errors do their worst, with
    ``hover`` the one pose for a whole scene in motion whose smallest value over all instants is largest.

    The value is re-evaluated by :mod:`nullpose.physics` from the pose that is reported; the bound comes from
    a branch and bound over positions and axes. On a limit or an interrupt the best pose and the best bound so
    far are returned, and the status says so.

    Args:
        scenario: what to solve.
        scheme: one of :class:`Scheme`, or its name; the optimum for an array or a robust pose.
        robust: maximise over all errors together: an actual axis within ``attitude_error_deg`` and an actual
            position within ``position_error_m`` of the commanded ones, every jammer or eavesdropper anywhere
            in its set. The gap is 1e-2 unless another is given.
        hover: for a scene in motion: hold one pose at all its instants. The result is of the scene at the
            instant at which the pose is worst; its details have the values of all. The gap is 1e-4 unless
            another is given.
        null_jammer: zero interference only: the jammer to null; without it, each is tried.
        on_progress: called during the proof with the gap and the boxes examined; never for an array.
        options: those of :class:`SolveOptions`: ``gap``, ``time_limit_s``, ``node_limit``, ``threads``,
            ``certify`` and ``seed``. An array has no limits of time and boxes.

    Raises:
        WrongTypeError: no scenario was given, but the path of one, say.
        UsageError: unknown scheme, one that has no meaning here, an unknown jammer, a bad seed or limit, an
            array under another objective than min-sinr or with ``robust``.
        SolveError: no pose reaches every node.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> result = nullpose.solve(scenario)
        >>> round(result.objective.value_db, 4), round(result.objective.upper_bound, 4), str(result.status)
        (0.9837, 1.2542, 'certified')
        >>> result.pose.position_m.round(2)
        array([-2.24, 23.82,  8.  ])
        >>> unsure = nullpose.apply_overrides(scenario, ["jammers.M.uncertainty_m=1"])
        >>> nullpose.solve(unsure, robust=True, gap=0.1).objective.value < result.objective.value
        True
    """
    scheme, limits = as_scheme(scheme), SolveOptions(**options, on_progress=on_progress)
    require_usage(not (robust and hover), "solve: given robust with hover; allowed: one of them")
    is_alone = robust or hover or scenario.array is not None
    if is_alone and (scheme is not Scheme.OPTIMUM or null_jammer is not None):
        refused = f"scheme {scheme.value}" if null_jammer is None else f"null jammer {null_jammer!r}"
        kind = "a robust pose" if robust else "a hover" if hover else "a scenario with an [array]"
        raise UsageError(f"solve: given {refused} for {kind}; allowed: the scheme {Scheme.OPTIMUM.value}")
    gap = ROBUST_GAP if robust else HOVER_GAP if hover else None
    limits, began = limits.of(scenario, gap), working_clock()
    if hover:
        answer, scenario = solve_hover(scenario, limits)
    elif robust:
        answer = solve_robust(scenario, limits)
    elif scenario.array is not None:
        answer = solve_array(scenario, scenario.array, limits)
    else:
        answer = solve_by_scheme(scenario, scheme, null_jammer, limits)
    # at one instant errors tell nothing of the others
    sizes = None if hover else ErrorSizes()
    return result_of(scenario, answer, limits, began, sizes, null_jammer)


@checked
def compare(
    scenario: Scenario,
    *,
    schemes: Iterable[Scheme | str] = Scheme,
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> Results:
    """Solve a scenario under several schemes with one dipole.

    Those without meaning there are left out, and those of which no pose meets what the nodes require.
    After an interrupt during a proof the remaining schemes are solved without one.

    Args:
        scenario: nodes, jammers, receiver and airspace; an array is left out.
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
    scenario = scenario.without_array
    applicable = [s for s in map(as_scheme, schemes) if s.not_applicable(scenario) is None]
    solutions = []
    for done, scheme in enumerate(applicable, start=1):
        try:
            solutions.append(solve(scenario, scheme, **options))
        except RequirementError:
            if scheme is Scheme.OPTIMUM:  # then none meets them
                raise
        if solutions and solutions[-1].interrupted:
            options["certify"] = False
        if on_progress is not None:
            on_progress(done, len(applicable))
    return Results(solutions)


def best_axis(scenario: Scenario, position_m: ArrayLike) -> Pose:
    """Find the best axis at a position, of those that the airframe reaches.

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
    from nullpose.solver.kernels.linear_algebra.axis import best_axis as kernel

    position = as_position(position_m)
    family = build_family(scenario, any_channel=True)
    nearest_m = float(np.min(np.linalg.norm(family.ratios.points_m - position, axis=1)))
    require_usage(
        nearest_m >= family.domain.keep_out_m,
        f"position_m: {nearest_m:.3g} m from a ground point; "
        f"allowed: at least keep_out_m = {family.domain.keep_out_m:g} m",
    )
    band = scenario.axis_band
    axis = np.empty(3)
    if band == (0.0, 1.0):
        kernel(family.ratios, position, axis)
    else:
        axis = solve_and_prove(
            family.at(position), [AxisField.within(*band)], SolveOptions(gap=1e-8, node_limit=_AXIS_NODES)
        ).incumbent.axis
    return Pose.of_airframe(scenario, position, axis)


_AXIS_NODES = 50_000  # of the proof at one position, which needs few if it is closed at all
