"""The workload "certified": the paper's optimum case proved to a gap, beside SCIP and MAiNGO."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.metric import EXACT, TIMING, Direction, Metric, Tolerance
from benchmarks.provers import PROVERS
from benchmarks.workload import Progress, Row, Section
from benchmarks.workloads.certified.describing import section
from benchmarks.workloads.certified.judging import is_true, ratios, times_faster, with_best_known
from benchmarks.workloads.certified.record import Record
from benchmarks.workloads.certified.running import NULLPOSE, missing, run_nullpose, run_prover
from benchmarks.workloads.certified.wording import TIMES_FASTER

__all__ = ["CAP_S", "Certified"]

JAMMING_RATIOS = (1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6)
QUICK_RATIOS = (1.0, 100.0)
CAP_S = 100.0
QUICK_CAP_S = 5.0
REPEATS = 3


@dataclass(frozen=True, slots=True)
class Certified:
    """One scene, many jamming powers.

    Args:
        cap_s: seconds that each solver has for each jamming power; None for the workload's own.
    """

    cap_s: float | None = None

    name = "certified"
    title = "The paper's scene proved, beside global solvers"

    def measure(self, *, quick: bool, progress: Progress) -> list[Row]:
        """Return a row per jamming power and method."""
        cap_s = (QUICK_CAP_S if quick else CAP_S) if self.cap_s is None else self.cap_s
        asked = QUICK_RATIOS if quick else JAMMING_RATIOS
        provers = []
        for prover in PROVERS:
            reason = missing(prover)
            if reason:
                print(f"benchmarks: {reason}", file=sys.stderr)
            else:
                provers.append(prover)
        progress.begin(len(asked) * (1 + len(provers)))
        repeats = 1 if quick else REPEATS
        rows: list[Row] = []
        for ratio in asked:
            ours, pose = run_nullpose(ratio)
            records = [ours]
            progress.step(f"P_M/P = {ratio:g}: nullpose")
            for prover in provers:
                records.append(run_prover(prover, ratio, pose, cap_s=cap_s, repeats=repeats))
                progress.step(f"P_M/P = {ratio:g}: {prover.label}")
            rows += [record.to_row() for record in with_best_known(records)]
        return rows

    def metrics(self, rows: Sequence[Row]) -> tuple[Metric, ...]:
        """Return how many proofs close and are true, nullpose's times, and its lead."""
        records = [Record.from_row(row) for row in rows]
        ours = [record for record in records if record.method == NULLPOSE]
        lead = min(times_faster(records, ratio) for ratio in ratios(records))
        metrics = [
            _closed_metric(NULLPOSE, ours, limit=1.0, tolerance=EXACT),
            Metric(
                key="certified.nullpose.slowest_ms",
                value=1e3 * max(record.seconds for record in ours),
                unit="ms",
                direction=Direction.LOWER,
                tolerance=TIMING,
                about="longest of the median times from scenario to certified result, over jamming powers",
            ),
        ]
        if lead < float("inf"):
            metrics.append(_lead_metric(lead))
        for prover in PROVERS:
            theirs = [record for record in records if record.method == prover.name]
            if theirs:
                # a fall below it would mean that we broke the peer; a true claim more is no fault
                metrics.append(_closed_metric(prover.name, theirs, tolerance=Tolerance(absolute=0.15)))
        return tuple(metrics)

    def section(self, rows: Sequence[Row], images: Path) -> Section:
        """Return the tables, the false claims and the figure."""
        return section([Record.from_row(row) for row in rows], images)


def _lead_metric(lead: float) -> Metric:
    return Metric(
        key="certified.times_faster",
        value=lead,
        unit="1",
        direction=Direction.HIGHER,
        tolerance=Tolerance(relative=0.5),
        limit=TIMES_FASTER,
        about="time of the faster of SCIP and MAiNGO over nullpose's for a proof of the paper's scene, "
        "smallest over jamming powers",
    )


def _closed_metric(
    method: str, records: Sequence[Record], *, tolerance: Tolerance, limit: float | None = None
) -> Metric:
    return Metric(
        key=f"certified.{method}.closed",
        value=sum(map(is_true, records)) / len(records),
        unit="1",
        direction=Direction.HIGHER,
        tolerance=tolerance,
        limit=limit,
        about=f"share of jamming powers at which {method} closes the gap in time with a true claim",
    )
