"""Poses under errors: what one guarantees, and the one that guarantees most."""

from nullpose.solver.result import Result
from nullpose.solver.robust.guarantee import Guarantee, guarantee
from nullpose.solver.robust.inner import RatioGuarantee
from nullpose.solver.robust.solution import GuardedPose, RobustDetails
from nullpose.solver.robust.solving import ROBUST_GAP, solve_robust

RobustSolution = Result
"""An older name of what a solve returns."""

__all__ = [
    "ROBUST_GAP",
    "Guarantee",
    "GuardedPose",
    "RatioGuarantee",
    "RobustDetails",
    "RobustSolution",
    "guarantee",
    "solve_robust",
]
