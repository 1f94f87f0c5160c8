"""From a scenario to a solution: the paper's four cases."""

from nullpose.schemes import Scheme, as_scheme
from nullpose.solve.api import best_axis, compare, solve
from nullpose.solve.array import ArrayDetails, solve_array
from nullpose.solve.compiling import announce_compiling
from nullpose.solve.many import ManySolutions, solve_many
from nullpose.solve.options import (
    NODE_LIMIT,
    TIME_LIMIT_S,
    SolveKeywords,
    SolveOptions,
    default_gap,
    default_gap_of,
)
from nullpose.solve.result import Objective, Result, Results, Stats, Status
from nullpose.solve.rigour import Rigour
from nullpose.solve.sensitivity import ErrorSizes, Sensitivity, sensitivity

Solution = Result
"""An older name of what a solve returns."""

ArraySolution = Result
"""Likewise, of an array."""

__all__ = [
    "NODE_LIMIT",
    "TIME_LIMIT_S",
    "ArrayDetails",
    "ArraySolution",
    "ErrorSizes",
    "ManySolutions",
    "Objective",
    "Result",
    "Results",
    "Rigour",
    "Scheme",
    "Sensitivity",
    "Solution",
    "SolveKeywords",
    "SolveOptions",
    "Stats",
    "Status",
    "announce_compiling",
    "as_scheme",
    "best_axis",
    "compare",
    "default_gap",
    "default_gap_of",
    "sensitivity",
    "solve",
    "solve_array",
    "solve_many",
]
