"""The verb: the pose that guarantees most under errors, with a bound on what any pose guarantees."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nullpose.physics import Pose, evaluate
from nullpose.physics.gain import worst_polarised
from nullpose.problem.axis_field import AxisField
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.by_scheme import solve_by_scheme
from nullpose.solver.compiling import limit_clock, precompile, working_clock
from nullpose.solver.objective import objective_of, status_of
from nullpose.solver.options import SolveOptions
from nullpose.solver.result import Result, Stats, provenance
from nullpose.solver.rigour import Rigour
from nullpose.solver.robust.exchange import Exchange
from nullpose.solver.robust.guarantee import guarantee_of, require_dipole
from nullpose.solver.robust.inner import Inner
from nullpose.solver.robust.solution import GuardedPose, RobustDetails

ROBUST_GAP = 1e-2
"""The relative gap asked for unless another is."""

POLARISATION = (
    "jammers and eavesdroppers whose dipole has a null depth count as isotropic, and what leaks through a "
    "node's null counts as lost: the worst that they could be"
)
"""The note of a solution whose scenario states such."""
_MOST_CELLS_REACHED = "limit of the proof of what the pose guarantees: most cells of errors"


def solve_robust(scenario: Scenario, options: SolveOptions) -> Result:
    """Find the pose whose objective is largest when the scenario's errors do their worst.

    What the pose guarantees is proved; that no pose guarantees much more is proved with ``certify``. On a
    limit or an interrupt the best so far is returned.

    Args:
        scenario: with errors or without, which makes the guaranteed value the nominal one.
        options: as given by the user; the gap is ``ROBUST_GAP`` unless another is given.

    Raises:
        UsageError: an array in place of the dipole.
        SolveError: no pose reaches every node.
    """
    limits = options.of(scenario, ROBUST_GAP)
    original, scenario = scenario, worst_polarised(require_dipole(scenario))
    inner = Inner(scenario)
    began = working_clock()
    search = SolveOptions(certify=False, seed=limits.seed)
    nominal = solve_by_scheme(original, Scheme.OPTIMUM, None, search).pose
    field = AxisField.within(*scenario.axis_band)
    exchange = Exchange(inner, field, limits, nominal.position_m, nominal.antenna_axis)
    if limits.certify:
        precompile(inner.family.ground_axes is not None)  # compiling must not count against the time limit
    clock = limit_clock()
    robust = None
    try:
        again = True
        while again:
            exchange.search(clock + limits.time_limit_s)
            robust = _best(original, exchange, robust)
            again = limits.certify and exchange.prove(exchange.level(robust.guarantee.lower), clock)
    except KeyboardInterrupt:
        exchange.reason = INTERRUPT
    robust = _best(original, exchange, robust)
    objective = objective_of(scenario, robust.guaranteed, exchange.upper_bound)
    is_close = robust.guarantee.worst <= exchange.level(robust.guarantee.lower)
    unsettled = "error cases that the search did not settle" if is_close else _MOST_CELLS_REACHED
    status, reason = status_of(objective, limits.target, exchange.reason or unsettled * limits.certify)
    return Result(
        scenario=original,
        scheme="robust",
        status=status,
        # what is guaranteed rests on a floating-point proof, whether a bound is asked for or not
        objective=replace(objective, rigour=Rigour.FLOATING_POINT),
        pose=robust.pose,
        links=evaluate(original, robust.pose),
        reason=reason,
        stats=Stats(
            wall_s=working_clock() - began,
            starts=exchange.starts,
            evaluations=exchange.evaluations,
            boxes=exchange.boxes,
        ),
        provenance=provenance(limits.seed) | {"gap": limits.target},
        note="" if scenario is original else POLARISATION,
        details=RobustDetails(
            robust=robust, nominal=_guarded(original, exchange, nominal), cases=len(exchange.cases)
        ),
    )


def _best(scenario: Scenario, exchange: Exchange, before: GuardedPose | None) -> GuardedPose:
    """Return the best pose so far with its proof, the one from before if it is still the best."""
    best = exchange.best
    same = (best.position_m, best.axis)
    if before is not None and np.allclose((before.guarantee.position_m, before.guarantee.axis), same, 1e-12):
        return before
    pose = Pose.of_airframe(exchange.inner.scenario, best.position_m, best.axis)
    return _guarded(scenario, exchange, pose)


def _guarded(scenario: Scenario, exchange: Exchange, pose: Pose) -> GuardedPose:
    proved = guarantee_of(exchange.inner, pose.position_m, pose.antenna_axis, exchange.accuracy())
    return GuardedPose(scenario=scenario, pose=pose, guarantee=proved)
