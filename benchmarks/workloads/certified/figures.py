"""The figure of the workload: seconds to a proof against jamming power."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.provers import NOT_CLOSED
from benchmarks.workloads.certified.judging import is_true
from benchmarks.workloads.certified.labels import LABELS, LOOKS
from benchmarks.workloads.certified.record import Record
from benchmarks.workloads.certified.running import NULLPOSE
from nullpose.report.figures.style import GREY, house_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw_times"]

_DPI = 160


def draw_times(records: Sequence[Record], file: Path) -> None:
    """Write the time of every method against jamming power, both logarithmic; false claims are hollow.

    Args:
        records: of every method and jamming power.
        file: to write.
    """
    from matplotlib.figure import Figure

    with house_style():
        figure = Figure(figsize=(8.4, 4.2), layout="constrained")
        axes = figure.add_subplot()
        for method in LOOKS:
            own = [record for record in records if record.method == method and record.seconds > 0.0]
            if own:
                _draw_method(axes, method, sorted(own, key=lambda record: record.jamming_ratio))
        caps = {record.cap_s for record in records if record.status == NOT_CLOSED and record.cap_s > 0.0}
        for cap_s in caps:
            axes.axhline(cap_s, color=GREY, linestyle=":", linewidth=1.0, zorder=1)
            axes.annotate(
                f"{cap_s:g} s allowed",
                (0.01, cap_s),
                xycoords=("axes fraction", "data"),
                va="bottom",
                fontsize=8,
            )
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("jamming power over a node's, $P_M / P$")
        axes.set_ylabel("wall time (s)")
        axes.legend(
            loc="center left",
            bbox_to_anchor=(1.0, 0.5),
            fontsize=8,
            frameon=False,
            title="filled: true\nhollow: false\ncross: not closed",
            title_fontsize=8,
        )
        figure.savefig(file, dpi=_DPI, facecolor="white")


def _draw_method(axes: Axes, method: str, records: Sequence[Record]) -> None:
    colour, line, marker = LOOKS[method]
    axes.plot(
        [record.jamming_ratio for record in records],
        [record.seconds for record in records],
        color=colour,
        linestyle=line,
        linewidth=2.4 if method == NULLPOSE else 1.4,
    )
    for record in records:
        axes.plot(
            record.jamming_ratio,
            record.seconds,
            marker="x" if record.status == NOT_CLOSED else marker,
            markersize=6.5,
            color=colour,
            markerfacecolor=colour if is_true(record) else "white",
            zorder=3,
        )
    axes.plot([], [], color=colour, linestyle=line, marker=marker, label=LABELS[method])
