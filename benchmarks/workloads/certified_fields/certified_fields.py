"""The workload "certified-fields": random fields with their proofs, from two nodes to a hundred."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmarks.metric import EXACT, TIMING, Direction, Metric, Tolerance
from benchmarks.workload import Progress, Row, Section
from benchmarks.workloads.certified_fields.describing import section
from benchmarks.workloads.certified_fields.figures import PROMISED_EXPONENT
from benchmarks.workloads.certified_fields.judging import cell, false_bounds, growth, jammers, of
from benchmarks.workloads.certified_fields.record import Memory, Purpose, Record, from_rows
from benchmarks.workloads.certified_fields.running import FULL, measure_apart

__all__ = ["CertifiedFields"]

PEAK_MB = 500.0
HURRIED_S = 0.5


class CertifiedFields:
    """Nodes and jammers at random in a square of 100 m, the drone free to go anywhere above."""

    name = "certified-fields"
    title = "Random fields proved"

    def measure(self, *, quick: bool, progress: Progress) -> list[Row]:
        """Return a row per solve, and one for the memory."""
        return measure_apart(quick=quick, progress=progress)

    def metrics(self, rows: Sequence[Row]) -> tuple[Metric, ...]:
        """Return what closes, times, their growth with the number of nodes, memory and false bounds."""
        records, memory = from_rows(list(rows))
        fields = of(records, Purpose.FIELD)
        each = [
            _growth_metric(f"k{k}", growth(r for r in fields if r.scene.jammers == k), f"with K = {k}")
            for k in jammers(fields)
        ]
        return (
            Metric(
                key="certified-fields.closed",
                value=cell(fields).closed / len(fields),
                unit="1",
                direction=Direction.HIGHER,
                tolerance=Tolerance(absolute=0.01),
                about=f"share of random fields proved to {FULL.gap:g} within {FULL.cap_s:g} s",
            ),
            *_tight_metrics(of(records, Purpose.TIGHT)),
            _growth_metric("all", growth(fields), "over all K"),
            *each,
            *_hurried_metrics(records),
            _memory_metric(memory),
        )

    def section(self, rows: Sequence[Row], images: Path) -> Section:
        """Return the tables, what did not close, and the figure."""
        records, memory = from_rows(list(rows))
        return section(records, memory, images)


def _tight_metrics(records: Sequence[Record]) -> list[Metric]:
    short = cell(records)
    size = f"N = {FULL.tight_nodes}, K = 1, to {FULL.tight_gap:g}"
    return [
        Metric(
            key=f"certified-fields.tight.{name}_ms",
            value=1e3 * seconds,
            unit="ms",
            direction=Direction.LOWER,
            tolerance=TIMING,
            about=f"{name} wall time of a proof with {size}",
        )
        for name, seconds in (("median", short.median_s), ("worst", short.worst_s))
    ]


def _growth_metric(key: str, exponent: float, which: str) -> Metric:
    return Metric(
        key=f"certified-fields.growth.{key}",
        value=exponent,
        unit="1",
        direction=Direction.LOWER,
        tolerance=Tolerance(absolute=0.3),
        limit=PROMISED_EXPONENT,
        about=f"exponent of the growth of a proof's median time with the number of nodes, {which}",
    )


def _hurried_metrics(records: Sequence[Record]) -> list[Metric]:
    hurried = of(records, Purpose.HURRIED)
    asked = f"`solve(..., time_limit_s={FULL.hurry_s:g})` with the most nodes and jammers"
    return [
        Metric(
            key="certified-fields.hurried.worst_s",
            value=cell(hurried).worst_s,
            unit="s",
            direction=Direction.LOWER,
            tolerance=TIMING,
            limit=HURRIED_S,
            about=f"longest wall time of {asked}",
        ),
        Metric(
            key="certified-fields.false_bounds",
            value=float(len(false_bounds(records))),
            unit="1",
            direction=Direction.LOWER,
            tolerance=EXACT,
            limit=0.0,
            about="bounds below the value of a pose that another solve of the scene found",
        ),
    ]


def _memory_metric(memory: Memory) -> Metric:
    return Metric(
        key="certified-fields.peak_mb",
        value=memory.peak_mb,
        unit="MB",
        direction=Direction.LOWER,
        tolerance=Tolerance(relative=0.25),
        limit=PEAK_MB,
        about="peak resident memory of the process that proves all random fields",
    )
