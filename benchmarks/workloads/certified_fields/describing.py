"""The workload's section of the report."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from benchmarks.markdown import table
from benchmarks.workload import Section
from benchmarks.workloads.certified_fields.figures import draw_growth
from benchmarks.workloads.certified_fields.judging import cell, false_bounds, growth, jammers, of
from benchmarks.workloads.certified_fields.record import Memory, Purpose, Record
from benchmarks.workloads.certified_fields.running import FULL
from benchmarks.workloads.fields.wording import duration

__all__ = ["section"]

_FIGURE = "benchmark-proof-growth.png"
_LARGE = 10

SETTINGS = (
    (
        "nullpose, random fields proved",
        f"`solve(scenario, gap={FULL.gap:g}, time_limit_s={FULL.cap_s:g})`, kernels loaded, the whole Python "
        "call, one call per scene; beyond its first 20,000 boxes a proof uses every core",
    ),
)

LIMITATIONS = (
    "The random fields are proved once each: a time of a few milliseconds may be off by half of it.",
    "That a bound holds is checked here against the poses of nullpose's own solves only; "
    "`python -m benchmarks.soundness` and the verifier of certificates check it apart.",
)


def section(records: Sequence[Record], memory: Memory, images: Path) -> Section:
    """Return the section on the records, its figure written to a folder.

    Args:
        records: of every solve.
        memory: of the process that ran them.
        images: existing folder.
    """
    fields = of(records, Purpose.FIELD)
    draw_growth(fields, images / _FIGURE)
    parts = [
        _opening(fields),
        _by_size(fields),
        "Medians and worst over jamming powers and seeds; what did not close counts with its time.",
        _not_closed(records),
        f"![Median time to a proof against the number of nodes](images/{_FIGURE})",
        _growth(fields),
        "### One jammer, ten times closer",
        _tight(of(records, Purpose.TIGHT)),
        "### Short time limit",
        _hurried(records),
        "### Memory",
        _memory(memory),
    ]
    return Section(text="\n\n".join(parts), settings=SETTINGS, limitations=LIMITATIONS)


def _opening(fields: Sequence[Record]) -> str:
    scenes = [record.scene for record in fields]
    nodes, numbers = _listed({s.nodes for s in scenes}), _listed({s.jammers for s in scenes})
    powers = _listed({s.jamming_ratio for s in scenes})
    short = cell(fields)
    return (
        f"{short.total} scenes made like those of the searches: N = {nodes} nodes; K = {numbers} jammers; "
        f"$P_M / P$ of {powers}; seeds {_listed({s.seed for s in scenes})}. The drone may go anywhere "
        f"horizontally. Each is solved and proved to a relative gap of {FULL.gap:g}, in at most "
        f"{FULL.cap_s:g} s.\n\n"
        f"**{short.closed} of {short.total} close, in {duration(short.median_s)} in the median and "
        f"{duration(short.worst_s)} at worst.**"
    )


def _by_size(fields: Sequence[Record]) -> str:
    sizes = sorted({(record.scene.nodes, record.scene.jammers) for record in fields})
    cells = []
    for size in sizes:
        short = cell([r for r in fields if (r.scene.nodes, r.scene.jammers) == size])
        cells.append(
            (
                *map(str, size),
                f"{short.closed} of {short.total}",
                duration(short.median_s),
                duration(short.worst_s),
                f"{short.median_boxes:,.0f}",
                f"{short.worst_boxes:,}",
            )
        )
    columns = ("closed", "median time", "worst time", "median boxes", "worst boxes")
    return table(("N", "K", *columns), cells, text_columns=0)


def _not_closed(records: Sequence[Record]) -> str:
    failed = [r for r in records if r.purpose is not Purpose.HURRIED and not r.closed]
    if not failed:
        return "Every one of them closed."
    cells = [
        (
            str(record.scene),
            f"{record.gap:g}",
            record.status,
            _gap(record.gap_reached),
            f"{record.boxes:,}",
            duration(record.seconds),
        )
        for record in failed
    ]
    columns = ("gap asked for", "status", "gap reached", "boxes", "time")
    return "Failures, which did not reach the gap asked for in time:\n\n" + table(("scene", *columns), cells)


def _growth(fields: Sequence[Record]) -> str:
    cells = []
    for number in (*jammers(fields), None):
        chosen = [record for record in fields if number in (None, record.scene.jammers)]
        cells.append(
            (
                "all" if number is None else str(number),
                _exponent(growth(chosen)),
                _exponent(growth(chosen, least_nodes=_LARGE)),
            )
        )
    return (
        "Exponent of the median time against N, a straight line fitted to the logarithms; the last column "
        f"leaves out scenes of fewer than {_LARGE} nodes, in which what every call costs weighs most:\n\n"
        + table(("K", "all N", f"N from {_LARGE} on"), cells)
    )


def _tight(records: Sequence[Record]) -> str:
    short = cell(records)
    return (
        f"N = {FULL.tight_nodes}, K = 1, to a gap of {FULL.tight_gap:g}, all jamming powers and seeds: "
        f"{short.closed} of {short.total} close, median {duration(short.median_s)}, worst "
        f"{duration(short.worst_s)}; boxes {short.median_boxes:,.0f} in the median, {short.worst_boxes:,} at "
        "most."
    )


def _hurried(records: Sequence[Record]) -> str:
    hurried = of(records, Purpose.HURRIED)
    scene = hurried[0].scene
    false = false_bounds(records)
    gaps = sorted(record.gap_reached for record in hurried)
    times = cell(hurried)
    verdict = (
        "no bound of any solve is below the value of a pose that another solve of its scene found"
        if not false
        else f"**{len(false)} bounds are below the value of a pose**: "
        + "; ".join(f"{record.scene}, {record.purpose}" for record in false)
    )
    return (
        f"`solve` with `time_limit_s={FULL.hurry_s:g}` on {len(hurried)} scenes of {scene.nodes} nodes and "
        f"{scene.jammers} jammers comes back after {duration(times.median_s)} in the median and "
        f"{duration(times.worst_s)} at worst, with a relative gap of {_gap(gaps[len(gaps) // 2])} in the "
        f"median and {_gap(gaps[-1])} at worst. {times.closed} of them "
        f"close. Beside the poses of the solves above, which had {FULL.cap_s:g} s, {verdict}."
    )


def _memory(memory: Memory) -> str:
    if math.isnan(memory.peak_mb):
        return "Not measured: the system does not tell."
    return (
        f"The process that ran all of this section, and nothing else, had at most {memory.peak_mb:.0f} MB "
        "(1e6 bytes) resident. The interpreter with its libraries and the kernels loaded takes "
        f"{memory.loaded_mb:.0f} MB of that, before the first of these scenes."
    )


def _exponent(value: float) -> str:
    return "too few" if math.isnan(value) else f"{value:.2f}"


def _gap(value: float) -> str:
    if math.isinf(value):
        return "none"
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.2g}".replace("e-0", "e-")


def _listed(values: set[int] | set[float]) -> str:
    return ", ".join(f"{value:g}" for value in sorted(values))
