"""Poses under errors: what one guarantees, and the one that guarantees most."""

from nullpose.solve.robust.guarantee import Guarantee, RatioGuarantee, guarantee
from nullpose.solve.robust.solution import GuardedPose, RobustSolution
from nullpose.solve.robust.solving import ROBUST_GAP, solve_robust

__all__ = [
    "ROBUST_GAP",
    "Guarantee",
    "GuardedPose",
    "RatioGuarantee",
    "RobustSolution",
    "guarantee",
    "solve_robust",
]
