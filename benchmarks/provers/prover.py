"""What a prover is."""

from __future__ import annotations

from typing import Protocol

from benchmarks.provers.claim import Claim
from benchmarks.provers.problem import Problem

__all__ = ["Prover"]


class Prover(Protocol):
    """A global solver with a formulation.

    Args:
        name: in keys and files.
        label: in tables and figures.
        package: the Python package that it needs.
        settings: its formulation and its options, in words.
    """

    name: str
    label: str
    package: str
    settings: str

    def load(self) -> None:
        """Import what it needs, outside the clock."""

    def prove(self, problem: Problem) -> Claim:
        """Return what the solver claims, its time left for the caller to fill in.

        Args:
            problem: what to solve, how closely, in which time, and a start.
        """
