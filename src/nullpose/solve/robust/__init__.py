"""Poses under errors: what one guarantees, and the one that guarantees most."""

from nullpose.solve.result import Result
from nullpose.solve.robust.guarantee import Guarantee, guarantee
from nullpose.solve.robust.inner import RatioGuarantee
from nullpose.solve.robust.solution import GuardedPose, RobustDetails
from nullpose.solve.robust.solving import ROBUST_GAP, solve_robust

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
