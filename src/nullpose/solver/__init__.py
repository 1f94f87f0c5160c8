"""From a scenario to a solution: the paper's four cases."""

from nullpose.problem.schemes import Scheme, as_scheme
from nullpose.solver.api import best_axis, compare, solve
from nullpose.solver.array import ArrayDetails
from nullpose.solver.compiling import announce_compiling
from nullpose.solver.hover import HoverDetails
from nullpose.solver.many import ManySolutions, solve_many
from nullpose.solver.objective import Objective
from nullpose.solver.options import (
    NODE_LIMIT,
    TIME_LIMIT_S,
    SolveKeywords,
    SolveOptions,
    default_gap,
    default_gap_of,
)
from nullpose.solver.result import Result, Results, Stats
from nullpose.solver.rigour import Rigour, Status
from nullpose.solver.sensitivity import ErrorSizes, Sensitivity, sensitivity
from nullpose.solver.tracker import Tracker

__all__ = [
    "NODE_LIMIT",
    "TIME_LIMIT_S",
    "ArrayDetails",
    "ErrorSizes",
    "HoverDetails",
    "ManySolutions",
    "Objective",
    "Result",
    "Results",
    "Rigour",
    "Scheme",
    "Sensitivity",
    "SolveKeywords",
    "SolveOptions",
    "Stats",
    "Status",
    "Tracker",
    "announce_compiling",
    "as_scheme",
    "best_axis",
    "compare",
    "default_gap",
    "default_gap_of",
    "sensitivity",
    "solve",
    "solve_many",
]
