"""From records to the numbers that the workload promises. Pure functions of the records."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.summaries import median
from benchmarks.workloads.certified_fields.record import Purpose, Record

__all__ = ["Cell", "cell", "false_bounds", "growth", "jammers", "median_by_nodes", "of", "worst_seconds"]

_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """Several solves in short.

    Args:
        total: how many there were.
        closed: how many reached their gap in time.
        median_s: median time, what ran into the cap with the time that it took.
        worst_s: longest time.
        median_boxes: median of the boxes examined.
        worst_boxes: most boxes examined.
    """

    total: int
    closed: int
    median_s: float
    worst_s: float
    median_boxes: float
    worst_boxes: int


def of(records: Iterable[Record], purpose: Purpose) -> list[Record]:
    """Return the records of one purpose."""
    return [record for record in records if record.purpose is purpose]


def jammers(records: Iterable[Record]) -> list[int]:
    """Return the numbers of jammers, fewest first."""
    return sorted({record.scene.jammers for record in records})


def cell(records: Sequence[Record]) -> Cell:
    """Return records in short."""
    return Cell(
        total=len(records),
        closed=sum(record.closed for record in records),
        median_s=median(record.seconds for record in records),
        worst_s=worst_seconds(records),
        median_boxes=median(record.boxes for record in records),
        worst_boxes=max((record.boxes for record in records), default=0),
    )


def worst_seconds(records: Iterable[Record]) -> float:
    """Return the longest time, NaN of nothing."""
    return max((record.seconds for record in records), default=math.nan)


def median_by_nodes(records: Iterable[Record]) -> dict[int, float]:
    """Return the median time in seconds for each number of nodes."""
    times: dict[int, list[float]] = {}
    for record in records:
        times.setdefault(record.scene.nodes, []).append(record.seconds)
    return {nodes: median(times[nodes]) for nodes in sorted(times)}


def growth(records: Iterable[Record], *, least_nodes: int = 0) -> float:
    """Return the exponent e of ``seconds = c N^e``, fitted to the logarithms of the median times.

    Args:
        records: of one number of jammers, or of all.
        least_nodes: smaller scenes are left out of the fit.
    """
    points = [(n, s) for n, s in median_by_nodes(records).items() if n >= least_nodes and s > 0.0]
    if len(points) < 2:
        return math.nan
    nodes, seconds = np.log(np.array(points)).T
    return float(np.polyfit(nodes, seconds, 1)[0])


def false_bounds(records: Sequence[Record]) -> list[Record]:
    """Return the records whose bound is below the value of a pose that any solve of their scene found."""
    known: dict[object, float] = {}
    for record in records:
        known[record.scene] = max(known.get(record.scene, 0.0), record.value)
    return [record for record in records if record.bound < known[record.scene] * (1.0 - _ROUNDING)]
