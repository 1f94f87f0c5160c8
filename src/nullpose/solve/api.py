"""The verbs: solve one scheme, compare several, the best axis at one position."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import UsageError
from nullpose.family import build_family
from nullpose.physics import Link, Pose, evaluate, maximum_gain_sinr_as_printed, to_db
from nullpose.scenario import Scenario
from nullpose.solve.found import Found
from nullpose.solve.provenance import provenance
from nullpose.solve.scheme import PAPER_SCHEMES, Scheme, as_scheme, not_applicable, require_applicable
from nullpose.solve.schemes import maximum_gain, maximum_gain_printed, optimum, vertical, zero_interference
from nullpose.solve.solution import Objective, Solution, Stats, Status

__all__ = ["best_axis", "compare", "solve"]


def solve(
    scenario: Scenario,
    scheme: Scheme | str = Scheme.OPTIMUM,
    *,
    seed: int = 0,
    null_jammer: str | None = None,
) -> Solution:
    """Return the best pose found for a scenario under a scheme.

    Maximises the smallest SINR over the nodes (paper eq. 2.2) with the axes that the scheme allows. The
    value is re-evaluated by :mod:`nullpose.physics` from the pose that is reported.

    Args:
        scenario: nodes, jammers, receiver and airspace.
        scheme: one of :class:`Scheme`, or its name.
        seed: seed of the multistart, a whole number of at least 0; equal seeds give equal answers.
        null_jammer: zero interference only: the jammer to null; without it, each is tried.

    Raises:
        UsageError: unknown scheme, one that has no meaning here, an unknown jammer, or a bad seed.
        SolveError: no pose reaches every node.
    """
    scheme = as_scheme(scheme)
    require_applicable(scenario, scheme)
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise UsageError(f"seed: given {seed!r}; allowed: a whole number of at least 0")
    if null_jammer is not None and scheme is not Scheme.ZERO_INTERFERENCE:
        raise UsageError(
            f"null jammer: given {null_jammer!r} with scheme {scheme.value}; "
            "it goes with zero-interference only"
        )
    began = time.perf_counter()
    found = _find(scenario, scheme, seed, null_jammer)
    pose = Pose.from_axis(found.position_m, found.axis)
    links = _links(scenario, scheme, pose)
    value = min(link.sinr for link in links)
    return Solution(
        scenario=scenario,
        scheme=scheme,
        status=Status.BEST_FOUND,
        objective=Objective(name="min_sinr", value=value, value_db=float(to_db(value))),
        pose=pose,
        links=links,
        stats=Stats(wall_s=time.perf_counter() - began, starts=found.starts, evaluations=found.evaluations),
        provenance=provenance(seed),
        note=found.note,
    )


def compare(
    scenario: Scenario,
    *,
    seed: int = 0,
    schemes: Sequence[Scheme | str] = PAPER_SCHEMES,
    on_progress: Callable[[int, int], None] | None = None,
) -> tuple[Solution, ...]:
    """Return the solutions of several schemes for one scenario, those without meaning here left out.

    Args:
        scenario: nodes, jammers, receiver and airspace.
        seed: seed of each multistart.
        schemes: the schemes, in order.
        on_progress: called with how many are done and how many there are.

    Raises:
        UsageError: an unknown scheme.
        SolveError: no pose reaches every node.
    """
    applicable = [s for s in map(as_scheme, schemes) if not_applicable(scenario, s) is None]
    solutions = []
    for done, scheme in enumerate(applicable, start=1):
        solutions.append(solve(scenario, scheme, seed=seed))
        if on_progress is not None:
            on_progress(done, len(applicable))
    return tuple(solutions)


def best_axis(scenario: Scenario, position_m: ArrayLike) -> Pose:
    """Return the pose with the best axis at a given position: exact, for any number of nodes.

    Maximises the smallest SINR over the axis alone, by enumeration of the active sets of one, two and three
    nodes.

    Args:
        scenario: nodes, jammers and receiver; its airspace is not consulted.
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
    axis = np.empty(3)
    kernel(family.arrays, position, axis)
    return Pose.from_axis(position, axis)


def _find(scenario: Scenario, scheme: Scheme, seed: int, null_jammer: str | None) -> Found:
    if scheme is Scheme.ZERO_INTERFERENCE:
        return zero_interference.find(scenario, seed=seed, null_jammer=null_jammer)
    finders = {
        Scheme.OPTIMUM: optimum.find,
        Scheme.MAXIMUM_GAIN: maximum_gain.find,
        Scheme.VERTICAL: vertical.find,
        Scheme.MAXIMUM_GAIN_PRINTED: maximum_gain_printed.find,
    }
    return finders[scheme](scenario, seed=seed)


def _links(scenario: Scenario, scheme: Scheme, pose: Pose) -> tuple[Link, ...]:
    if scheme is not Scheme.MAXIMUM_GAIN_PRINTED:
        return evaluate(scenario, pose)
    ratios = maximum_gain_sinr_as_printed(scenario, pose.position_m)
    return tuple(
        Link(node=name, sinr=float(ratio), sinr_db=float(to_db(ratio)))
        for name, ratio in zip(scenario.node_names, ratios, strict=True)
    )
