"""Which claims are true, by the values of the poses that all methods found."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from benchmarks.provers import FINISHED, NOT_CLOSED
from benchmarks.workloads.certified.record import Record
from benchmarks.workloads.certified.running import NULLPOSE

__all__ = ["SLACK", "faults", "is_true", "ratios", "rival", "times_faster", "with_best_known"]

SLACK = 0.1
"""Share of the gap by which a value may be off and still count: solvers hold constraints to a tolerance."""

_ROUNDING = 1e-9


def faults(record: Record) -> tuple[str, ...]:
    """Return what is wrong with a claim, in words; nothing if it is closed and true."""
    found = []
    slack = SLACK * record.gap
    if record.status == NOT_CLOSED:
        found.append(NOT_CLOSED)
    elif record.status != FINISHED:
        return (record.status,)
    if record.claimed_value > record.known * (1.0 + slack):
        found.append("value above the optimum")
    if not math.isnan(record.claimed_value) and not record.claimed_value <= record.value * (1.0 + slack):
        found.append("pose does not reach the value")
    if record.claimed_bound < record.known * (1.0 - _ROUNDING):
        found.append("bound below a pose's value")
    if record.status == FINISHED and not record.claimed_bound <= record.value * (1.0 + record.gap + slack):
        found.append("pose farther from the bound than the gap")
    return tuple(found)


def with_best_known(records: Sequence[Record]) -> list[Record]:
    """Return the records of one jamming power, each with the best value that any method's pose has."""
    known = max(record.value for record in records if not math.isnan(record.value))
    return [replace(record, known=known) for record in records]


def is_true(record: Record) -> bool:
    """Return whether a claim is closed and true."""
    return not faults(record)


def ratios(records: Iterable[Record]) -> list[float]:
    """Return the jamming powers, weakest first."""
    return sorted({record.jamming_ratio for record in records})


def rival(records: Iterable[Record], jamming_ratio: float) -> Record | None:
    """Return the fastest true claim by another solver at a jamming power; None if there is none."""
    others = [
        record
        for record in records
        if record.method != NULLPOSE and record.jamming_ratio == jamming_ratio and is_true(record)
    ]
    return min(others, key=lambda record: record.seconds, default=None)


def times_faster(records: Sequence[Record], jamming_ratio: float) -> float:
    """Return the fastest rival's time over nullpose's; infinite without a rival, NaN without a proof.

    Args:
        records: of every method.
        jamming_ratio: jamming power over the power of a node.
    """
    ours = [r for r in records if r.method == NULLPOSE and r.jamming_ratio == jamming_ratio and is_true(r)]
    best = rival(records, jamming_ratio)
    if not ours:
        return float("nan")
    return best.seconds / ours[0].seconds if best is not None else float("inf")
