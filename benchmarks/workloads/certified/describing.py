"""The workload's section of the report."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from benchmarks.markdown import table
from benchmarks.provers import FINISHED, NOT_CLOSED
from benchmarks.workload import Section
from benchmarks.workloads.certified.figures import draw_times
from benchmarks.workloads.certified.judging import faults, is_true, ratios, rival, times_faster
from benchmarks.workloads.certified.labels import LABELS
from benchmarks.workloads.certified.record import Record
from benchmarks.workloads.certified.wording import LIMITATIONS, READING, SETTINGS, headline, opening, verdict
from benchmarks.workloads.fields.wording import duration

__all__ = ["section"]

_FIGURE = "benchmark-certified.png"


def section(records: Sequence[Record], images: Path) -> Section:
    """Return the section on the records, its figure written to a folder.

    Args:
        records: of every method and jamming power.
        images: existing folder.
    """
    draw_times(records, images / _FIGURE)
    parts = [
        opening(records),
        verdict(records),
        _times(records),
        "Median times; *not closed* and **false** are failures. *Ratio*: fastest true claim over nullpose.",
        f"![Seconds to a proof against jamming power](images/{_FIGURE})",
        "### Claims",
        READING,
        _claims(records),
    ]
    return Section(
        text="\n\n".join(parts),
        settings=SETTINGS,
        limitations=LIMITATIONS,
        headline=headline(records),
    )


def _times(records: Sequence[Record]) -> str:
    methods = [method for method in LABELS if any(record.method == method for record in records)]
    by_case = {(record.method, record.jamming_ratio): record for record in records}
    cells = [
        (f"{ratio:g}", *(_time(by_case.get((method, ratio))) for method in methods), _ratio(records, ratio))
        for ratio in ratios(records)
    ]
    return table(("$P_M / P$", *(LABELS[method] for method in methods), "ratio"), cells)


def _time(record: Record | None) -> str:
    if record is None:
        return ""
    if is_true(record):
        return duration(record.seconds)
    if record.status not in (FINISHED, NOT_CLOSED):
        return "failed"
    wrong = faults(record)
    if wrong == (NOT_CLOSED,):
        return f"not closed ({duration(record.seconds)})"
    closed = "not closed and " if NOT_CLOSED in wrong else ""
    return f"{closed}**false** ({duration(record.seconds)})"


def _ratio(records: Sequence[Record], jamming_ratio: float) -> str:
    if rival(records, jamming_ratio) is None:
        return "none true"
    return f"{times_faster(records, jamming_ratio):.1f}"


def _claims(records: Sequence[Record]) -> str:
    cells = [
        (
            f"{record.jamming_ratio:g}",
            LABELS[record.method],
            ", ".join(faults(record)) or "true",
            _number(record.claimed_value),
            _offset(record.claimed_value, record.known),
            _offset(record.value, record.known),
            _offset(record.claimed_bound, record.known),
            f"{record.nodes:,}",
            duration(record.seconds),
        )
        for record in sorted(records, key=lambda record: record.jamming_ratio)
    ]
    columns = ("claimed value", "claimed", "of its pose", "bound", "nodes", "time")
    return table(("$P_M / P$", "method", "verdict", *columns), cells, text_columns=3)


def _number(value: float) -> str:
    return "none" if math.isnan(value) else f"{value:.7f}"


def _offset(value: float, known: float) -> str:
    """Return by how much a value is above the best one known, relative."""
    if math.isnan(value):
        return "none"
    offset = value / known - 1.0
    return "0" if abs(offset) < 5e-10 else f"{offset:+.1e}".replace("e-0", "e-").replace("e+0", "e+")
