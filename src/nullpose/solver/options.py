"""What a solve may be asked for: how near the bound is to come, what that may cost, and the seed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypedDict

from nullpose.errors import require_number, require_usage
from nullpose.objectives import LEAST_RATE_BPS_HZ, Quantity
from nullpose.scenario import Scenario

TIME_LIMIT_S = 60.0
NODE_LIMIT = 10**9


def default_gap(n_nodes: int) -> float:
    """Choose the relative gap unless another is given: 1e-6 to 3 nodes, 1e-4 to 20, then 1e-3.

    Args:
        n_nodes: how many nodes the scenario has.
    """
    return 1e-6 if n_nodes <= 3 else 1e-4 if n_nodes <= 20 else 1e-3


def default_gap_of(scenario: Scenario) -> float:
    """Choose the default gap of a scenario, by its nodes, each counted once for every eavesdropper.

    For an antenna with a pattern 1e-3 to 3 nodes, and 2e-2 beyond.

    Args:
        scenario: what is to be solved.
    """
    if not scenario.antenna_record.is_quadratic:
        return 1e-3 if len(scenario.nodes) <= 3 else 2e-2
    return default_gap(len(scenario.nodes) * max(1, len(scenario.eavesdroppers)))


class SolveKeywords(TypedDict, total=False):
    """The options of :class:`SolveOptions` that every verb takes by keyword."""

    gap: float | None
    time_limit_s: float
    node_limit: int
    threads: int | None
    certify: bool
    seed: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SolveOptions:
    """What a solve is asked for.

    Args:
        gap: relative gap between bound and value at which the proof is done; None for
            :func:`default_gap_of` the scenario. A rate below 1 bit/s/Hz is proved to so much of itself, one
            beyond to so many bits/s/Hz.
        time_limit_s: seconds after which the proof stops with the bound reached.
        node_limit: boxes after which it stops.
        threads: threads of a long proof at most; None for one for each processor. Boxes, pose and
            bound do not depend on them.
        certify: whether to prove anything; without it the search alone is run, more thoroughly.
        seed: seed of the searches, a whole number of at least 0; equal seeds give equal answers.
        on_progress: called now and then during a proof with the gap so far and the boxes examined.
        of_rate: whether the gap is one of the rate, ``log2`` of the ratio.

    Raises:
        UsageError: a bad seed, or a limit that cannot be met.
    """

    gap: float | None = None
    time_limit_s: float = TIME_LIMIT_S
    node_limit: int = NODE_LIMIT
    threads: int | None = None
    certify: bool = True
    seed: int = 0
    on_progress: Callable[[float, int], None] | None = None
    of_rate: bool = False

    def __post_init__(self) -> None:
        require_usage(
            self.gap is None or 1e-8 <= self.gap <= 10.0,
            f"gap: given {self.gap!r}; allowed: 1e-8 to 10, relative",
        )
        require_usage(
            self.time_limit_s > 0.0, f"time limit: given {self.time_limit_s!r}; allowed: more than 0 seconds"
        )
        require_number("node limit", self.node_limit, 1)
        require_number("seed", self.seed, 0)
        if self.threads is not None:
            require_number("threads", self.threads, 1)

    def of(self, scenario: Scenario, gap: float | None = None) -> SolveOptions:
        """Fill in what the options leave to a scenario: the gap, and whether it is one of a rate.

        Args:
            scenario: what is to be solved.
            gap: the gap unless one is asked for; without it the scenario's default.
        """
        target = (default_gap_of(scenario) if gap is None else gap) if self.gap is None else self.gap
        return replace(self, gap=target, of_rate=Quantity.of(scenario).is_rate)

    @property
    def target(self) -> float:
        """The gap, once it is known."""
        assert self.gap is not None, "a scenario or a caller states it"
        return self.gap

    def ratio_gap(self, value: float) -> float:
        """Convert the gap asked for into a relative gap of the smallest ratio.

        Of a rate it is relative to a rate between ``LEAST_RATE_BPS_HZ`` and 1 bit/s/Hz, and to those beyond.

        Args:
            value: the smallest ratio reached.
        """
        if not self.of_rate:
            return self.target
        rate = math.log2(max(1.0, value))
        return math.expm1(math.log(2.0) * self.target * min(1.0, max(LEAST_RATE_BPS_HZ, rate)))

    @property
    def settings(self) -> dict[str, float]:
        """The gap for a result's provenance; nothing without a proof."""
        return {"gap": self.target} if self.certify else {}
