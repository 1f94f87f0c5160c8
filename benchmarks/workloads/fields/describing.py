"""The workload's section of the report."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from benchmarks.markdown import table
from benchmarks.workload import Section
from benchmarks.workloads.fields.figures import draw_growth, draw_profile
from benchmarks.workloads.fields.labels import LABELS
from benchmarks.workloads.fields.record import OK, Record
from benchmarks.workloads.fields.running import NULLPOSE, REFERENCE, UNBOXED
from benchmarks.workloads.fields.scenes import Scene
from benchmarks.workloads.fields.standing import (
    HIT,
    Standing,
    best_values,
    is_hit,
    nullpose_standing,
    standings,
)
from benchmarks.workloads.fields.wording import (
    LIMITATIONS,
    READING,
    SETTINGS,
    duration,
    opening,
    proof,
    verdict,
)

__all__ = ["section"]


def section(records: Sequence[Record], images: Path) -> Section:
    """Return the section on the records, its figures written to a folder.

    Args:
        records: of every method and scene.
        images: existing folder.
    """
    draw_profile(records, images / "benchmark-profile.png")
    draw_growth(records, images / "benchmark-growth.png")
    found = standings(records)
    parts = [
        opening(records),
        verdict(found),
        proof(records, found),
        _overall(found),
        READING,
        "![Share of scenes with the best answer in hand against time](images/benchmark-profile.png)",
        "### By number of nodes",
        _by_nodes(records),
        "Hit rate and median time of each method at its last stage.",
        "![Median time against the number of nodes](images/benchmark-growth.png)",
        "### Misses and failures",
        _misses(records),
        _failures(records),
        _unboxed(records),
    ]
    return Section(
        text="\n\n".join(part for part in parts if part), settings=SETTINGS, limitations=LIMITATIONS
    )


def _overall(found: Sequence[Standing]) -> str:
    ours = nullpose_standing(found)
    columns = ("hits", "failures", "median", "95th percentile", "mean", "worst shortfall", "ratio")
    cells = [
        (
            LABELS[s.method],
            s.stage,
            f"{s.hits} of {s.scenes} ({100 * s.hit_rate:.1f} %)",
            str(s.failures),
            duration(s.median_s),
            duration(s.p95_s),
            duration(s.mean_s),
            _shortfall(s.worst_shortfall),
            f"{s.median_s / ours.median_s:.1f}",
        )
        for s in found
    ]
    return table(("method", "stage", *columns), cells, text_columns=2)


def _by_nodes(records: Sequence[Record]) -> str:
    """Return hit rate and median time per number of nodes, of every method at its last stage."""
    sizes = sorted({record.scene.nodes for record in records})
    per_size: list[Mapping[str, Standing]] = [
        {s.method: s for s in standings([record for record in records if record.scene.nodes == size])}
        for size in sizes
    ]
    methods = dict.fromkeys(method for found in per_size for method in found)
    cells = [(LABELS[method], *(_in_short(found.get(method)) for found in per_size)) for method in methods]
    return table(("method", *(f"N = {size}" for size in sizes)), cells)


def _in_short(standing: Standing | None) -> str:
    if standing is None or standing.failures == standing.scenes:
        return "no answer"
    return f"{100 * standing.hit_rate:.0f} %, {duration(standing.median_s)}"


def _misses(records: Sequence[Record]) -> str:
    best = best_values(records)
    missed = [record for record in records if record.method == NULLPOSE and not is_hit(record, best)]
    if not missed:
        return "nullpose misses in no scene."
    cells = [
        (
            str(record.scene),
            ", ".join(_finders(records, record.scene, best)),
            f"{record.value:.10g}",
            f"{best[record.scene]:.10g}",
            _shortfall(1.0 - record.value / best[record.scene]),
        )
        for record in missed
    ]
    columns = ("scene", "best found by", "nullpose", "best known", "shortfall")
    return "nullpose misses in:\n\n" + table(columns, cells, text_columns=2)


def _finders(records: Iterable[Record], scene: Scene, best: Mapping[Scene, float]) -> list[str]:
    methods = [r.method for r in records if r.scene == scene and r.method != UNBOXED and is_hit(r, best)]
    return [LABELS[method] for method in dict.fromkeys(methods)]


def _failures(records: Sequence[Record]) -> str:
    failed = [record for record in records if record.status != OK]
    if not failed:
        return "No method failed to answer."
    cells = [(LABELS[record.method], str(record.scene), record.status) for record in failed]
    return table(("method", "scene", "reason"), cells, text_columns=3)


def _unboxed(records: Sequence[Record]) -> str:
    best = best_values(records)
    free = [record for record in records if record.method == UNBOXED]
    outside = [record for record in free if record.value > best[record.scene] * (1.0 + HIT)]
    short = [record for record in free if not is_hit(record, best)]
    reference = [record for record in records if record.method == REFERENCE]
    alone = [r for r in reference if _best_of_others(records, r.scene) < r.value * (1.0 - HIT)]
    return (
        "With x and y unbounded, which is how nullpose is usually asked, the search finds a pose better than "
        f"the best in the box in {len(outside)} of {len(free)} scenes, and falls short of the best in the "
        f"box in {len(short)}. The reference search alone finds the best pose in {len(alone)}."
    )


def _best_of_others(records: Iterable[Record], scene: Scene) -> float:
    return max(r.value for r in records if r.scene == scene and r.method not in (REFERENCE, UNBOXED))


def _shortfall(value: float) -> str:
    return "0" if value <= 1e-12 else f"{value:.1e}".replace("e-0", "e-")
