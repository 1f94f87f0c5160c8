"""From records to hits, times and the comparison that the issue asks for. Pure functions of the records."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from benchmarks.summaries import median, percentile_95, shifted_geometric_mean
from benchmarks.workloads.fields.record import OK, Record
from benchmarks.workloads.fields.running import NULLPOSE, REFERENCE, UNBOXED
from benchmarks.workloads.fields.scenes import Scene

__all__ = [
    "HIT",
    "NOT_RANKED",
    "SHIFT_S",
    "Standing",
    "best_values",
    "first_hit_s",
    "is_hit",
    "nearest_rival",
    "nullpose_standing",
    "rivals_within",
    "standings",
]

HIT = 1e-6
"""Relative distance from the best value known within which an answer is a hit."""

SHIFT_S = 0.01

NOT_RANKED = (REFERENCE, UNBOXED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Standing:
    """How one method, stopped at one of its stages, did over some scenes.

    Args:
        method: name.
        stage: stopping point.
        scenes: how many it was asked, failures included.
        hits: in how many it came within 1e-6 of the best value known.
        failures: in how many it gave no answer.
        median_s: of the time of its answers.
        p95_s: 95th percentile of the same.
        mean_s: shifted geometric mean of the same.
        worst_shortfall: largest ``1 - value / best`` over its scenes; 1 with a failure.
    """

    method: str
    stage: str
    scenes: int
    hits: int
    failures: int
    median_s: float
    p95_s: float
    mean_s: float
    worst_shortfall: float

    @property
    def hit_rate(self) -> float:
        """Hits over scenes, failures counting as misses."""
        return self.hits / self.scenes


def best_values(records: Iterable[Record]) -> dict[Scene, float]:
    """Return the best value that any method found in each scene, the box being the same for all."""
    best: dict[Scene, float] = {}
    for record in records:
        if record.method != UNBOXED and record.status == OK:
            best[record.scene] = max(best.get(record.scene, 0.0), record.value)
    return best


def is_hit(record: Record, best: Mapping[Scene, float]) -> bool:
    """Return whether a record comes within 1e-6, relative, of the best value known."""
    return record.status == OK and record.value >= best[record.scene] * (1.0 - HIT)


def standings(records: Sequence[Record]) -> list[Standing]:
    """Return how each ranked method and stage did, in the order of the records.

    A method that failed in a scene is counted as failing there at each of its stages.
    """
    best = best_values(records)
    stages: dict[str, dict[str, list[Record]]] = defaultdict(lambda: defaultdict(list))
    failed: dict[str, list[Record]] = defaultdict(list)
    for record in records:
        if record.method in NOT_RANKED:
            continue
        if record.status == OK:
            stages[record.method][record.stage].append(record)
        else:
            failed[record.method].append(record)
    for method in failed:
        if method not in stages:
            stages[method]["failed"] = []
    return [
        _standing(method, stage, answers, failed[method], best)
        for method, by_stage in stages.items()
        for stage, answers in by_stage.items()
    ]


def _standing(
    method: str, stage: str, answers: list[Record], failed: list[Record], best: Mapping[Scene, float]
) -> Standing:
    answered = {record.scene for record in answers}
    failures = [record for record in failed if record.scene not in answered]
    times = [record.seconds for record in answers]
    shortfalls = [1.0 - record.value / best[record.scene] for record in answers] + [1.0] * len(failures)
    return Standing(
        method=method,
        stage=stage,
        scenes=len(answers) + len(failures),
        hits=sum(is_hit(record, best) for record in answers),
        failures=len(failures),
        median_s=median(times),
        p95_s=percentile_95(times),
        mean_s=shifted_geometric_mean(times, SHIFT_S),
        worst_shortfall=max(shortfalls),
    )


def nullpose_standing(found: Iterable[Standing]) -> Standing:
    """Return nullpose's own standing."""
    return next(standing for standing in found if standing.method == NULLPOSE)


def rivals_within(found: Sequence[Standing], times: float, among: Collection[str]) -> list[Standing]:
    """Return the peers that hit at least as often as nullpose in less than so many times its median time.

    Args:
        found: nullpose's standing and the peers'.
        times: the factor.
        among: names of the peers to choose from.
    """
    ours = nullpose_standing(found)
    return [
        peer
        for peer in found
        if peer.method in among and peer.hits >= ours.hits and peer.median_s < times * ours.median_s
    ]


def nearest_rival(found: Sequence[Standing], among: Collection[str]) -> Standing:
    """Return the fastest peer, at the best of its stopping points, that hits at least as often as nullpose.

    If none does, the fastest of those that hit most often.

    Args:
        found: nullpose's standing and the peers'.
        among: names of the peers to choose from.
    """
    ours = nullpose_standing(found)
    peers = [standing for standing in found if standing.method in among]
    bar = min(ours.hit_rate, max(peer.hit_rate for peer in peers))
    return min((peer for peer in peers if peer.hit_rate >= bar), key=lambda peer: peer.median_s)


def first_hit_s(records: Iterable[Record], best: Mapping[Scene, float]) -> dict[tuple[str, Scene], float]:
    """Return, per method and scene with a hit, the time of the first stopping point at which it had one."""
    first: dict[tuple[str, Scene], float] = {}
    for record in records:
        if is_hit(record, best):
            key = (record.method, record.scene)
            first[key] = min(first.get(key, math.inf), record.seconds)
    return first
