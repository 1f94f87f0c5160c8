"""How far a proof is to go."""

from __future__ import annotations

import math
from dataclasses import dataclass

from nullpose.errors import UsageError
from nullpose.objectives import LEAST_RATE_BPS_HZ
from nullpose.scenario import Scenario

__all__ = ["NODE_LIMIT", "TIME_LIMIT_S", "Limits", "default_gap", "default_gap_of"]

TIME_LIMIT_S = 60.0
NODE_LIMIT = 10**9


def default_gap(n_nodes: int) -> float:
    """Return the relative gap asked for unless another is given: 1e-6 to 3 nodes, 1e-4 to 20, then 1e-3.

    Args:
        n_nodes: how many nodes the scenario has.
    """
    if n_nodes <= 3:
        return 1e-6
    return 1e-4 if n_nodes <= 20 else 1e-3


def default_gap_of(scenario: Scenario) -> float:
    """Return the default gap of a scenario, by its nodes, each counted once for every eavesdropper.

    Args:
        scenario: what is to be solved.
    """
    return default_gap(len(scenario.nodes) * max(1, len(scenario.eavesdroppers)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """The target of a proof and what it may cost.

    Args:
        gap: relative gap between bound and value at which it is done; of a rate, see ``of_rate``.
        time_limit_s: seconds after which it stops with the bound reached.
        node_limit: nodes after which it stops.
        threads: threads of a long proof at most; None for one for each processor. One thread gives the same
            bounds and poses on any machine, as long as no time limit ends it.
        of_rate: whether the gap is one of the rate, ``log2`` of the ratio: relative to a rate between
            ``LEAST_RATE_BPS_HZ`` and 1 bit/s/Hz, and to those beyond.

    Raises:
        UsageError: a limit that cannot be met.
    """

    gap: float
    time_limit_s: float = TIME_LIMIT_S
    node_limit: int = NODE_LIMIT
    threads: int | None = None
    of_rate: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.gap) and 1e-8 <= self.gap <= 10.0):
            raise UsageError(f"gap: given {self.gap!r}; allowed: 1e-8 to 10, relative")
        if math.isnan(self.time_limit_s) or not self.time_limit_s > 0.0:
            raise UsageError(f"time limit: given {self.time_limit_s!r}; allowed: more than 0 seconds")
        if isinstance(self.node_limit, bool) or not isinstance(self.node_limit, int) or self.node_limit < 1:
            raise UsageError(f"node limit: given {self.node_limit!r}; allowed: a whole number of at least 1")
        whole = isinstance(self.threads, int) and not isinstance(self.threads, bool)
        if self.threads is not None and not (whole and self.threads >= 1):
            raise UsageError(
                f"threads: given {self.threads!r}; allowed: a whole number of at least 1, or None"
            )

    def ratio_gap(self, value: float) -> float:
        """Return the relative gap of the smallest ratio that closes the gap asked for.

        Args:
            value: the smallest ratio reached.
        """
        if not self.of_rate:
            return self.gap
        rate = math.log2(max(1.0, value))
        return math.expm1(math.log(2.0) * self.gap * min(1.0, max(LEAST_RATE_BPS_HZ, rate)))
