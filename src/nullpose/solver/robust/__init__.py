"""Poses under errors: what one guarantees, and the one that guarantees most."""

from nullpose.solver.robust.exchange import ROBUST_GAP
from nullpose.solver.robust.guarantee import guarantee
from nullpose.solver.robust.solution import Guarantee, GuardedPose, RatioGuarantee, RobustDetails

__all__ = [
    "ROBUST_GAP",
    "Guarantee",
    "GuardedPose",
    "RatioGuarantee",
    "RobustDetails",
    "guarantee",
]
