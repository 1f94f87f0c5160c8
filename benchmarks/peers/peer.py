"""What a peer is: it hands over answers, each at a point where it could have been stopped."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from benchmarks.peers.five_pose import FivePose

__all__ = ["Answer", "Budget", "Peer"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """How much a peer may spend on one scene.

    Args:
        evaluations: of the objective, for those that count evaluations.
        starts: for those that count starts.
        samples: for those that lay out a fixed sample.
    """

    evaluations: int
    starts: int
    samples: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answer:
    """The best pose in a peer's hand at a named stopping point.

    Args:
        stage: the stopping point, the same in every scene.
        x: (5,) scaled numbers.
    """

    stage: str
    x: NDArray[np.float64]


class Peer(Protocol):
    """A solver of the five-dimensional problem.

    Args:
        name: in keys and files.
        label: in tables and figures.
        general_purpose: whether it searches on values alone, as it would any function; if not, it was made
            for this problem, and is reported beside the others without counting among them.
        settings: what it is run with, a sentence.
    """

    name: str
    label: str
    general_purpose: bool
    settings: str

    def answers(self, problem: FivePose, budget: Budget, seed: int) -> Iterator[Answer]:
        """Yield the best pose in hand at each stopping point; the clock runs only while the peer works.

        Args:
            problem: what to minimise.
            budget: what it may cost.
            seed: of whatever is random in it.
        """
