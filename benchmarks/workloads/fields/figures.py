"""The two figures of the workload: who has the answer when, and how time grows with the number of nodes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.workloads.fields.labels import LABELS, LOOKS
from benchmarks.workloads.fields.record import Record
from benchmarks.workloads.fields.running import NULLPOSE
from benchmarks.workloads.fields.standing import best_values, first_hit_s, standings
from nullpose.report.figures.style import house_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw_growth", "draw_profile"]

_DPI = 160


def draw_profile(records: Sequence[Record], file: Path) -> None:
    """Write the share of scenes in which each method has the best answer in hand, against time."""
    from matplotlib.figure import Figure

    best = best_values(records)
    first = first_hit_s(records, best)
    methods = [method for method in LOOKS if any(record.method == method for record in records)]
    longest = max(record.seconds for record in records if record.method in LOOKS)
    with house_style():
        figure = Figure(figsize=(8.4, 4.2), layout="constrained")
        axes = figure.add_subplot()
        for method in methods:
            times = np.sort([seconds for (name, _), seconds in first.items() if name == method])
            share = np.arange(1, len(times) + 1) / len(best)
            colour, line, marker = LOOKS[method]
            axes.step(
                np.append(times, max(longest, times[-1] if len(times) else 0.0)),
                np.append(share, share[-1] if len(share) else 0.0),
                where="post",
                color=colour,
                linestyle=line,
                marker=marker,
                markersize=5,
                markevery=max(1, len(times) // 6),
                linewidth=2.4 if method == NULLPOSE else 1.4,
                label=_plain(method),
                zorder=3 if method == NULLPOSE else 2,
            )
        axes.set_xscale("log")
        axes.set_ylim(0.0, 1.02)
        axes.set_xlabel("wall time (s)")
        axes.set_ylabel("share of scenes with the best answer in hand")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
        figure.savefig(file, dpi=_DPI, facecolor="white")


def draw_growth(records: Sequence[Record], file: Path) -> None:
    """Write the median time of each method's last stage against the number of nodes, misses marked."""
    from matplotlib.figure import Figure

    sizes = sorted({record.scene.nodes for record in records})
    by_size = [_last([record for record in records if record.scene.nodes == size]) for size in sizes]
    with house_style():
        figure = Figure(figsize=(8.4, 4.2), layout="constrained")
        axes = figure.add_subplot()
        for method in LOOKS:
            points = [
                (size, *found[method]) for size, found in zip(sizes, by_size, strict=True) if method in found
            ]
            if points:
                _draw_method(axes, method, points)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xticks(sizes, [str(size) for size in sizes])
        axes.minorticks_off()
        axes.set_xlabel("nodes")
        axes.set_ylabel("median wall time (s)")
        axes.legend(
            loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False, title="filled: all hit"
        )
        figure.savefig(file, dpi=_DPI, facecolor="white")


def _last(records: Sequence[Record]) -> dict[str, tuple[float, bool]]:
    """Return the median time and whether every scene was hit, per method at its last stage."""
    return {found.method: (found.median_s, found.hits == found.scenes) for found in standings(records)}


def _draw_method(axes: Axes, method: str, points: Sequence[tuple[int, float, bool]]) -> None:
    colour, line, marker = LOOKS[method]
    sizes = [size for size, _, _ in points]
    axes.plot(
        sizes,
        [seconds for _, seconds, _ in points],
        color=colour,
        linestyle=line,
        linewidth=2.4 if method == NULLPOSE else 1.4,
    )
    for size, seconds, all_hit in points:
        axes.plot(
            size,
            seconds,
            marker=marker,
            markersize=6.5,
            color=colour,
            markerfacecolor=colour if all_hit else "white",
        )
    axes.plot([], [], color=colour, linestyle=line, marker=marker, label=_plain(method))


def _plain(method: str) -> str:
    return LABELS[method].replace("`", "")
