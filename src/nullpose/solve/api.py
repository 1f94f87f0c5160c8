"""The verbs: solve one scheme, compare several, the best axis at one position."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nullpose.certificate import claimed_axes
from nullpose.errors import UsageError
from nullpose.family import AxisField, build_family
from nullpose.objectives import Quantity
from nullpose.physics import Link, Pose, evaluate, to_db
from nullpose.scenario import Scenario
from nullpose.schemes import PAPER_SCHEMES, Scheme, as_scheme
from nullpose.solve.by_scheme import solve_scheme
from nullpose.solve.effort import Effort
from nullpose.solve.limits import NODE_LIMIT, TIME_LIMIT_S, Limits, default_gap_of
from nullpose.solve.objective import objective_of
from nullpose.solve.proof import INTERRUPT
from nullpose.solve.provenance import provenance
from nullpose.solve.rigour import Rigour
from nullpose.solve.solution import Solution, Stats, Status
from nullpose.solve.solve_and_prove import Outcome, solve_and_prove

__all__ = ["best_axis", "compare", "solve"]


def solve(
    scenario: Scenario,
    scheme: Scheme | str = Scheme.OPTIMUM,
    *,
    gap: float | None = None,
    time_limit_s: float = TIME_LIMIT_S,
    node_limit: int = NODE_LIMIT,
    threads: int | None = None,
    certify: bool = True,
    seed: int = 0,
    null_jammer: str | None = None,
    on_progress: Callable[[float, int], None] | None = None,
) -> Solution:
    """Return the best pose for a scenario under a scheme, and a bound that no pose exceeds.

    Maximises what the scenario asks for, the smallest SINR over the nodes (paper eq. 2.2), the smallest
    margin or the smallest secrecy rate, with the axes that the scheme and the airframe allow. The value is
    re-evaluated by :mod:`nullpose.physics` from the pose that is reported; the bound comes from a branch and
    bound over positions and axes. On a limit or an interrupt the best pose and the best bound so far are
    returned, and the status says so.

    Args:
        scenario: what to solve.
        scheme: one of :class:`Scheme`, or its name.
        gap: relative gap between bound and value at which the proof is done; without it
            :func:`default_gap` of the number of nodes, each counted once for every eavesdropper. A rate
            below 1 bit/s/Hz is proved to so much of itself, one beyond to so many bits/s/Hz.
        time_limit_s: seconds after which the proof stops.
        node_limit: boxes after which the proof stops.
        threads: of a long proof at most; None for one for each processor. With one, and no time limit in the
            way, the answer is the same on every machine.
        certify: whether to prove anything; without it the search alone is run, more thoroughly.
        seed: seed of the multistart, a whole number of at least 0; equal seeds give equal answers.
        null_jammer: zero interference only: the jammer to null; without it, each is tried.
        on_progress: called now and then during the proof with the gap so far and the boxes examined.

    Raises:
        UsageError: unknown scheme, one that has no meaning here, an unknown jammer, a bad seed or limit.
        SolveError: no pose reaches every node.
    """
    scheme = as_scheme(scheme)
    scheme.require_applicable(scenario)
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise UsageError(f"seed: given {seed!r}; allowed: a whole number of at least 0")
    if null_jammer is not None and not scheme.record.nulls_a_jammer:
        nulling = ", ".join(each.value for each in Scheme if each.record.nulls_a_jammer)
        raise UsageError(
            f"null jammer: given {null_jammer!r} with scheme {scheme.value}; it goes with {nulling} only"
        )
    target = default_gap_of(scenario) if gap is None else gap
    limits = Limits(
        gap=target,
        time_limit_s=time_limit_s,
        node_limit=node_limit,
        threads=threads,
        of_rate=Quantity.of(scenario).is_rate,
    )
    effort = Effort(seed=seed, limits=limits if certify else None, on_progress=on_progress)
    began = time.perf_counter()
    outcome = solve_scheme(scenario, scheme.record, effort, null_jammer)
    pose = Pose.of_airframe(scenario, outcome.incumbent.position_m, outcome.incumbent.axis)
    links = _links(scenario, scheme, pose)
    objective = objective_of(scenario, links, outcome.upper_bound)
    if outcome.proofs and claimed_axes(scenario, scheme, null_jammer) is not None:
        objective = replace(objective, rigour=Rigour.VERIFIABLE)
    status = _status(outcome)
    return Solution(
        scenario=scenario,
        scheme=scheme,
        status=status,
        reason=outcome.reason if status is not Status.CERTIFIED else "",
        objective=objective,
        pose=pose,
        links=links,
        stats=Stats(
            wall_s=time.perf_counter() - began,
            starts=outcome.incumbent.starts,
            evaluations=outcome.incumbent.evaluations,
            boxes=outcome.nodes,
        ),
        provenance=provenance(seed) | ({"gap": target} if certify else {}),
        note=outcome.incumbent.note,
        null_jammer=null_jammer,
        proofs=outcome.proofs,
    )


def compare(
    scenario: Scenario,
    *,
    schemes: Sequence[Scheme | str] = PAPER_SCHEMES,
    gap: float | None = None,
    time_limit_s: float = TIME_LIMIT_S,
    node_limit: int = NODE_LIMIT,
    certify: bool = True,
    seed: int = 0,
    on_progress: Callable[[int, int], None] | None = None,
) -> tuple[Solution, ...]:
    """Return the solutions of several schemes for one scenario, those without meaning here left out.

    After an interrupt during a proof the remaining schemes are solved without one.

    Args:
        scenario: nodes, jammers, receiver and airspace.
        schemes: the schemes, in order.
        gap: as for :func:`solve`.
        time_limit_s: seconds after which each proof stops.
        node_limit: boxes after which each proof stops.
        certify: whether to prove anything.
        seed: seed of each multistart.
        on_progress: called with how many are done and how many there are.

    Raises:
        UsageError: an unknown scheme, a bad seed or limit.
        SolveError: no pose reaches every node.
    """
    applicable = [s for s in map(as_scheme, schemes) if s.not_applicable(scenario) is None]
    solutions = []
    for done, scheme in enumerate(applicable, start=1):
        solution = solve(
            scenario,
            scheme,
            gap=gap,
            time_limit_s=time_limit_s,
            node_limit=node_limit,
            certify=certify,
            seed=seed,
        )
        solutions.append(solution)
        certify = certify and solution.reason != INTERRUPT
        if on_progress is not None:
            on_progress(done, len(applicable))
    return tuple(solutions)


def best_axis(scenario: Scenario, position_m: ArrayLike) -> Pose:
    """Return the pose with the best axis at a given position, of those that the airframe reaches.

    Maximises what the scenario asks for over the axis alone: by enumeration of the active sets of one, two
    and three ratios, exact for a smallest SINR or margin; within an airframe's reach by a search and a proof,
    which few positions keep from being closed.

    Args:
        scenario: what is asked for; its airspace is not consulted.
        position_m: (3,) metres, at least the keep-out radius from every ground point.

    Raises:
        UsageError: the position is not three finite numbers, or is too close to a ground point.
    """
    from nullpose.solve.kernels.axis import best_axis as kernel

    position = np.array(position_m, dtype=float)
    if position.shape != (3,) or not np.all(np.isfinite(position)):
        raise UsageError(f"position_m: given {position_m!r}; allowed: three finite numbers, metres")
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
        here = replace(family, low_m=position, high_m=position, **_NO_BORDERS)
        limits = Limits(gap=1e-8, node_limit=_AXIS_NODES)
        axis = solve_and_prove(here, [AxisField.within(*band)], Effort(limits=limits)).incumbent.axis
    return Pose.of_airframe(scenario, position, axis)


_AXIS_NODES = 50_000  # of the proof at one position, which needs few if it is closed at all

_NO_BORDERS: dict[str, Any] = {
    "keep_out_points_m": np.zeros((0, 3)),
    "piece_start": np.zeros(1, dtype=np.int64),
    "piece_sides": np.zeros((0, 5)),
    "zone_kind": np.zeros(0, dtype=np.int64),
    "zone_start": np.zeros(1, dtype=np.int64),
    "zone_edges": np.zeros((0, 4)),
    "zone_range_m": np.zeros((0, 2)),
}


def _status(outcome: Outcome) -> Status:
    if outcome.upper_bound is None:
        return Status.BEST_FOUND
    return Status.GAP_NOT_REACHED if outcome.reason else Status.CERTIFIED


def _links(scenario: Scenario, scheme: Scheme, pose: Pose) -> tuple[Link, ...]:
    ratios_at = scheme.record.ratios_at
    if ratios_at is None:
        return evaluate(scenario, pose)
    ratios = ratios_at(scenario, pose.position_m)
    return tuple(
        Link(node=name, sinr=float(ratio), sinr_db=float(to_db(ratio)))
        for name, ratio in zip(scenario.node_names, ratios, strict=True)
    )
