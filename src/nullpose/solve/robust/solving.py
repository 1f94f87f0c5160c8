"""The verb: the pose that guarantees most under errors, with a bound on what any pose guarantees."""

from __future__ import annotations

import time
from collections.abc import Callable

from nullpose.family import AxisField
from nullpose.objectives import Quantity
from nullpose.physics import Pose
from nullpose.scenario import Scenario
from nullpose.solve.api import solve
from nullpose.solve.limits import NODE_LIMIT, TIME_LIMIT_S, Limits
from nullpose.solve.precompile import ready
from nullpose.solve.proof import INTERRUPT
from nullpose.solve.provenance import provenance
from nullpose.solve.robust.exchange import Exchange
from nullpose.solve.robust.guarantee import guarantee_of, require_dipole
from nullpose.solve.robust.inner import Inner
from nullpose.solve.robust.solution import GuardedPose, RobustSolution
from nullpose.solve.solution import Stats, Status

__all__ = ["ROBUST_GAP", "solve_robust"]

ROBUST_GAP = 1e-2
"""The relative gap asked for unless another is."""


def solve_robust(
    scenario: Scenario,
    *,
    gap: float = ROBUST_GAP,
    time_limit_s: float = TIME_LIMIT_S,
    node_limit: int = NODE_LIMIT,
    certify: bool = True,
    seed: int = 0,
    on_progress: Callable[[float, int], None] | None = None,
) -> RobustSolution:
    """Return the pose whose objective is largest when the scenario's errors do their worst.

    Maximises the smallest margin or secrecy rate over all errors together: an actual axis within
    ``attitude_error_deg`` and an actual position within ``position_error_m`` of the commanded ones, every
    jammer or eavesdropper anywhere in its set. What the pose guarantees is proved; that no pose guarantees
    much more is proved with ``certify``. On a limit or an interrupt the best so far is returned.

    Args:
        scenario: with errors or without, which makes the guaranteed value the nominal one.
        gap: relative gap between bound and guaranteed value that is aimed at.
        time_limit_s: seconds after which the search and the proof stop.
        node_limit: boxes after which the proof stops.
        certify: whether to bound what any pose guarantees.
        seed: seed of the searches, a whole number of at least 0; equal seeds give equal answers.
        on_progress: called now and then during the proof with the gap so far and the boxes examined.

    Raises:
        UsageError: an array in place of the dipole, a bad seed or limit.
        SolveError: no pose reaches every node.
    """
    limits = Limits(
        gap=gap,
        time_limit_s=time_limit_s,
        node_limit=node_limit,
        of_rate=scenario.objective == "secrecy-rate",
    )
    inner = Inner(require_dipole(scenario))
    began = time.perf_counter()
    nominal = solve(scenario, certify=False, seed=seed).pose
    field = AxisField.within(*scenario.axis_band)
    exchange = Exchange(inner, field, seed, limits)
    exchange.add(exchange.visit(nominal.position_m, nominal.antenna_axis))
    if certify:
        ready(exchange.family, field)  # compiling must not count against the time limit
    clock = time.perf_counter()
    try:
        again = True
        while again:
            exchange.search(clock + limits.time_limit_s)
            level = exchange.level(_best(exchange).guarantee.lower)
            again = certify and exchange.prove(level, clock, on_progress)
    except KeyboardInterrupt:
        exchange.reason = INTERRUPT
    robust = _best(exchange)
    upper_bound = (
        None if exchange.upper_bound is None else Quantity.of(scenario).of_ratio(exchange.upper_bound)
    )
    status, reason = _status(exchange, robust.guarantee.lower)
    return RobustSolution(
        scenario=scenario,
        status=status,
        robust=robust,
        nominal=_guarded(exchange, nominal),
        upper_bound=upper_bound,
        reason=reason,
        cases=len(exchange.cases),
        stats=Stats(
            wall_s=time.perf_counter() - began,
            starts=exchange.starts,
            evaluations=exchange.evaluations,
            boxes=exchange.boxes,
        ),
        provenance=provenance(seed) | {"gap": gap},
    )


def _best(exchange: Exchange) -> GuardedPose:
    assert exchange.best is not None, "the nominal pose was visited"
    pose = Pose.of_airframe(exchange.inner.scenario, exchange.best.position_m, exchange.best.axis)
    return _guarded(exchange, pose)


def _guarded(exchange: Exchange, pose: Pose) -> GuardedPose:
    proved = guarantee_of(exchange.inner, pose.position_m, pose.antenna_axis, exchange.accuracy())
    return GuardedPose(scenario=exchange.inner.scenario, pose=pose, guarantee=proved)


def _status(exchange: Exchange, guaranteed: float) -> tuple[Status, str]:
    if exchange.upper_bound is None:
        return Status.BEST_FOUND, exchange.reason
    if exchange.upper_bound <= exchange.level(guaranteed):
        return Status.CERTIFIED, ""
    return Status.GAP_NOT_REACHED, exchange.reason or "error cases that the search did not settle"
