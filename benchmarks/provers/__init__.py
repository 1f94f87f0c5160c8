"""Global solvers that give a bound besides a pose, each with a formulation made for it, one file each."""

from benchmarks.provers.claim import FINISHED, NOT_CLOSED, Claim
from benchmarks.provers.maingo import MaingoAim, MaingoAxis
from benchmarks.provers.problem import Problem
from benchmarks.provers.prover import Prover
from benchmarks.provers.scip import Scip, ScipPlain

PROVERS: tuple[Prover, ...] = (Scip(), MaingoAxis(), MaingoAim(), ScipPlain())

__all__ = ["FINISHED", "NOT_CLOSED", "PROVERS", "Claim", "Problem", "Prover"]
