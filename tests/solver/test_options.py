"""SolveOptions of a proof: what they may be."""

import math

import pytest

from nullpose.errors import UsageError
from nullpose.solver.options import NODE_LIMIT, TIME_LIMIT_S, SolveOptions, default_gap


def test_gaps_asked_for_by_default() -> None:
    """Up to 3 nodes a millionth, up to 20 a ten-thousandth, a thousandth beyond."""
    gaps = {1: 1e-6, 3: 1e-6, 4: 1e-4, 20: 1e-4, 21: 1e-3, 1000: 1e-3}
    assert {nodes: default_gap(nodes) for nodes in gaps} == gaps


def test_defaults_are_the_documented_ones() -> None:
    """Left out, the time and the boxes are those of the command line."""
    limits = SolveOptions(gap=1e-3)
    assert (limits.time_limit_s, limits.node_limit) == (TIME_LIMIT_S, NODE_LIMIT) == (60.0, 10**9)


@pytest.mark.parametrize("gap", [0.0, 0.99e-9, 10.01, -1.0, math.nan, math.inf, -math.inf])
def test_gaps_that_cannot_be_met(gap: float) -> None:
    """Below rounding, above ten, or no number."""
    with pytest.raises(UsageError, match="gap: given"):
        SolveOptions(gap=gap)


@pytest.mark.parametrize("time_limit_s", [0.0, -1.0, math.nan, -math.inf])
def test_times_that_cannot_be_met(time_limit_s: float) -> None:
    """No time at all, or no number; endless time is allowed."""
    with pytest.raises(UsageError, match="time limit: given"):
        SolveOptions(gap=1e-3, time_limit_s=time_limit_s)
    assert SolveOptions(gap=1e-3, time_limit_s=math.inf).time_limit_s == math.inf


@pytest.mark.parametrize("node_limit", [0, -1, 1.5, 1.0, True, "9", None])
def test_node_limits_that_cannot_be_met(node_limit: object) -> None:
    """Fewer than one, or no whole number."""
    with pytest.raises(UsageError, match="node limit: given"):
        SolveOptions(gap=1e-3, node_limit=node_limit)


@pytest.mark.parametrize("gap", [1e-8, 1e-6, 1.0, 10.0])
def test_gaps_that_can(gap: float) -> None:
    """The ends of the range belong to it."""
    assert SolveOptions(gap=gap, node_limit=1).gap == gap
