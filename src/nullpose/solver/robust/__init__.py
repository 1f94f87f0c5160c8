"""Poses under errors: what one guarantees, and the one that guarantees most."""

from nullpose.solver.robust.guarantee import Guarantee, guarantee
from nullpose.solver.robust.inner import RatioGuarantee
from nullpose.solver.robust.solution import GuardedPose, RobustDetails
from nullpose.solver.robust.solving import ROBUST_GAP

__all__ = [
    "ROBUST_GAP",
    "Guarantee",
    "GuardedPose",
    "RatioGuarantee",
    "RobustDetails",
    "guarantee",
]
