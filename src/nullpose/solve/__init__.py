"""From a scenario to a solution: the paper's four cases."""

from nullpose.solve.api import best_axis, compare, solve
from nullpose.solve.compiling import announce_compiling
from nullpose.solve.limits import default_gap
from nullpose.solve.scheme import PAPER_SCHEMES, Scheme, as_scheme, not_applicable
from nullpose.solve.solution import Objective, Solution, Stats, Status

__all__ = [
    "PAPER_SCHEMES",
    "Objective",
    "Scheme",
    "Solution",
    "Stats",
    "Status",
    "announce_compiling",
    "as_scheme",
    "best_axis",
    "compare",
    "default_gap",
    "not_applicable",
    "solve",
]
