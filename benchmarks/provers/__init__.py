"""Global solvers that give a bound besides a pose, each with a formulation made for it, one file each."""

from benchmarks.provers.maingo import Maingo
from benchmarks.provers.problem import FINISHED, NOT_CLOSED, Claim, Problem, Prover
from benchmarks.provers.scip import Scip

PROVERS: tuple[Prover, ...] = (Scip(), Maingo())

__all__ = ["FINISHED", "NOT_CLOSED", "PROVERS", "Claim", "Problem", "Prover"]
