"""The figure of the workload: median seconds to a proof against the number of nodes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmarks.workloads.certified_fields.judging import jammers, median_by_nodes
from benchmarks.workloads.certified_fields.record import Record
from nullpose.report.figures.style import GREY, house_style

__all__ = ["draw_growth"]

_DPI = 160
_LOOKS = (("#0a3fd6", "-", "o"), ("#D55E00", "--", "s"), ("#009E73", "-.", "^"), ("#CC79A7", ":", "D"))
PROMISED_EXPONENT = 1.5


def draw_growth(records: Sequence[Record], file: Path) -> None:
    """Write the median time against the number of nodes, a line for each number of jammers.

    Args:
        records: proofs to the same gap.
        file: to write.
    """
    from matplotlib.figure import Figure

    every = median_by_nodes(records)
    sizes = list(every)
    with house_style():
        figure = Figure(figsize=(7.2, 4.0), layout="constrained")
        axes = figure.add_subplot()
        for i, number in enumerate(jammers(records)):
            colour, line, marker = _LOOKS[i % len(_LOOKS)]
            times = median_by_nodes(record for record in records if record.scene.jammers == number)
            label = f"{number} jammer{'s' if number > 1 else ''}"
            axes.plot(
                list(times), list(times.values()), color=colour, linestyle=line, marker=marker, label=label
            )
        first = every[sizes[0]]
        axes.plot(
            sizes,
            [first * (size / sizes[0]) ** PROMISED_EXPONENT for size in sizes],
            color=GREY,
            linestyle=(0, (1.5, 2.0)),
            linewidth=1.4,
            label="slope of $N^{1.5}$,\nthe most promised",
        )
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xticks(sizes, [str(size) for size in sizes])
        axes.minorticks_off()
        axes.set_xlabel("nodes $N$")
        axes.set_ylabel("median wall time to a proof (s)")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
        figure.savefig(file, dpi=_DPI, facecolor="white")
