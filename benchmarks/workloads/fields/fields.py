"""The workload "fields": 200 random scenes, nullpose and its peers side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmarks.metric import EXACT, TIMING, Direction, Metric, Tolerance
from benchmarks.peers import GENERAL_PURPOSE, PEERS, TAILORED, Budget
from benchmarks.workload import Progress, Row, Section
from benchmarks.workloads.fields.describing import section
from benchmarks.workloads.fields.labels import LABELS
from benchmarks.workloads.fields.record import Record
from benchmarks.workloads.fields.running import (
    FULL,
    PROVED,
    QUICK,
    run_nullpose,
    run_peer,
    run_proved,
    run_reference,
    run_unboxed,
)
from benchmarks.workloads.fields.scenes import Scene, scenes
from benchmarks.workloads.fields.standing import (
    Standing,
    nearest_rival,
    nullpose_standing,
    rivals_within,
    standings,
)

__all__ = ["Fields"]

OWN = (
    ("nullpose", run_nullpose),
    ("nullpose, certified", run_proved),
    ("nullpose without a box", run_unboxed),
    ("reference", run_reference),
)

HIT_RATE = 0.995
TIMES_FASTER = 10.0


class Fields:
    """Nodes and jammers at random in a square of 100 m."""

    name = "fields"
    title = "Random fields against general-purpose solvers"

    def measure(self, *, quick: bool, progress: Progress) -> list[Row]:
        """Return a row per scene, method and stopping point."""
        budget = QUICK if quick else FULL
        asked = list(scenes(quick=quick))
        progress.begin(len(asked) * (len(PEERS) + len(OWN)))
        warm_up()
        records: list[Record] = []
        for scene in asked:
            for name, run in OWN:
                records += run(scene)
                progress.step(f"{scene}: {name}")
            for peer in PEERS:
                records += run_peer(peer, scene, budget)
                progress.step(f"{scene}: {peer.label}")
        return [record.to_row() for record in records]

    def metrics(self, rows: Sequence[Row]) -> tuple[Metric, ...]:
        """Return nullpose's hit rate, times and lead, and every peer's hit rate at its last stage."""
        records = [Record.from_row(row) for row in rows]
        found = standings(records)
        ours = nullpose_standing(found)
        metrics = [
            Metric(
                key="fields.nullpose.hit_rate",
                value=ours.hit_rate,
                unit="1",
                direction=Direction.HIGHER,
                tolerance=Tolerance(absolute=0.0025),
                limit=HIT_RATE,
                about="share of scenes in which the search comes within 1e-6 of the best of all methods",
            ),
            Metric(
                key="fields.nullpose.worst_shortfall",
                value=ours.worst_shortfall,
                unit="1",
                direction=Direction.LOWER,
                tolerance=Tolerance(absolute=1e-6),
                about="largest relative distance of the search from the best value any method found",
            ),
            _time_metric("fields.nullpose.median_ms", ours.median_s, "median wall time of the search"),
            _time_metric("fields.nullpose.p95_ms", ours.p95_s, "95th percentile of that wall time"),
            Metric(
                key="fields.rivals_within_ten_times",
                value=float(len(rivals_within(found, TIMES_FASTER, GENERAL_PURPOSE))),
                unit="1",
                direction=Direction.LOWER,
                tolerance=EXACT,
                limit=0.0,
                about="general-purpose solvers, at any stage, that hit as often as nullpose in less than ten "
                "times its median time",
            ),
            _tailored_metric(found),
        ]
        last_stages = {standing.method: standing for standing in found if standing != ours}
        proved = last_stages.pop(PROVED, None)
        if proved is not None:
            about = "median wall time of `solve` with its proof"
            metrics.append(_time_metric("fields.nullpose-certified.median_ms", proved.median_s, about))
        return (*metrics, *(_peer_metric(last) for last in last_stages.values()))

    def section(self, rows: Sequence[Row], images: Path) -> Section:
        """Return the tables, the misses and the figures."""
        return section([Record.from_row(row) for row in rows], images)


def _time_metric(key: str, seconds: float, about: str) -> Metric:
    return Metric(
        key=key, value=1e3 * seconds, unit="ms", direction=Direction.LOWER, tolerance=TIMING, about=about
    )


def _tailored_metric(found: Sequence[Standing]) -> Metric:
    ours, rival = nullpose_standing(found), nearest_rival(found, TAILORED)
    often = "hits as often as nullpose" if rival.hit_rate >= ours.hit_rate else "hits most often"
    return Metric(
        key="fields.times_faster_than_tailored",
        value=rival.median_s / ours.median_s,
        unit="1",
        direction=Direction.HIGHER,
        tolerance=Tolerance(relative=0.5),
        about=f"median time over nullpose's of {LABELS[rival.method]} ({rival.stage}), where it {often}",
    )


def _peer_metric(last: Standing) -> Metric:
    return Metric(
        key=f"fields.{last.method}.hit_rate",
        value=last.hit_rate,
        unit="1",
        direction=Direction.HIGHER,
        tolerance=Tolerance(absolute=0.1),  # a fall below it would mean that we broke the peer
        about=f"share of scenes in which the peer hits, stage: {last.stage}",
    )


def warm_up() -> None:
    """Compile or load every kernel, and import what the peers import, outside the clock."""
    scene = Scene(nodes=2, jammers=1, jamming_ratio=1.0, seed=0)
    for _, run in OWN:
        list(run(scene))
    for peer in PEERS:
        list(run_peer(peer, scene, Budget(evaluations=2_000, starts=16, samples=64)))
