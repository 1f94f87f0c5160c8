"""The paper's Figure 2 and a figure of its poses, written to a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.files import check_outputs, write_csv
from nullpose.paper.printed import (
    JAMMER_POWER,
    JAMMING_LEVELS,
    POSE_LEVELS,
    PRINTED_LEVELS,
    PrintedPoint,
    paper_scenario,
    search_as_printed,
)
from nullpose.problem.schemes import Scheme
from nullpose.report.answer import certainty_lines, counted
from nullpose.report.document import View, document
from nullpose.report.figures.poses import draw_poses
from nullpose.report.figures.style import CURVES, Curve, draw_curve, house_figure, write_figure
from nullpose.report.figures.sweep import draw_caption, draw_curves
from nullpose.report.numbers import MINUS
from nullpose.study import ResultTable, sweep

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_SINR_DB = (-3.0, 2.15)
_LABELS = ((0.3, 1.38), (3e2, 0.53), (3e2, -0.97), (3e2, -2.02))
"""P_M/P and smallest SINR [dB] of the left end of each case's label, beside its own curve alone."""
_POWERS = "jamming-to-transmission power ratio  $P_M/P$"
_PRINTED = Curve("eq. 3.5 as printed", "#9a6060", (0, (1.2, 1.8)), "v", 1.6, 2.0)


def draw_figure2(table: ResultTable) -> Figure:
    """Draw the paper's Figure 2: the four curves of a sweep."""
    with house_figure((7.0, 4.4)) as figure:
        axes = figure.add_subplot()
        draw_curves(axes, table)
        axes.set(xscale="log", ylim=_SINR_DB, xlabel=_POWERS, ylabel="smallest SINR over the nodes (dB)")
        axes.set_xlim(0.8 * table.values[0], 1.25 * table.values[-1])  # no marker is cut in half
        for scheme, place in zip(Scheme, _LABELS, strict=True):
            axes.text(*place, CURVES[scheme].label, color=CURVES[scheme].colour, fontweight="bold")
        draw_caption(figure, [f"{line}." for line in certainty_lines(table)])
    return figure


def draw_printed(table: ResultTable, printed: Sequence[PrintedPoint]) -> Figure:
    """Draw maximum gain with its axis normalised, from a sweep, and as eq. 3.5 is printed."""
    rows, look = table.of(Scheme.MAXIMUM_GAIN), CURVES[Scheme.MAXIMUM_GAIN]
    with house_figure((7.0, 4.0)) as figure:
        axes = figure.add_subplot()
        values_db = [row.min_sinr_db for row in rows]
        whole = replace(look, label=f"{look.label}, axis normalised")
        draw_curve(axes, whole, [row.value for row in rows], values_db, every=12)
        draw_curve(axes, _PRINTED, [at.level for at in printed], [at.min_sinr_db for at in printed])
        axes.set(xscale="log", xlabel=_POWERS, ylabel="smallest SINR over the nodes (dB)")
        last_db = f"{printed[-1].min_sinr_db:.0f} dB".replace("-", MINUS)
        axes.set_title(
            f"As printed, eq. 3.5 falls without end, here to {last_db}", loc="left", fontsize="medium"
        )
        axes.legend(frameon=False, loc="lower left")
        draw_caption(figure, ["As printed: the best found by search, no upper bound."])
    return figure


_KINDS = (".png", ".svg")
_FILES = (
    *("figure2.png", "figure2.svg", "figure2.csv"),
    *("figure2-printed.png", "figure2-printed.svg", "figure2-printed.csv", "poses.png", "poses.svg"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduction:
    """What a reproduction found and wrote.

    Args:
        table: the four curves of Figure 2.
        printed: maximum gain as eq. 3.5 is printed.
        files: what was written.
    """

    table: ResultTable
    printed: tuple[PrintedPoint, ...]
    files: tuple[Path, ...]

    def to_dict(self) -> dict[str, object]:
        """Return the certainty of each curve as plain data."""
        return {
            "scenario": self.table.rows[0].scenario.name,
            "levels_are": "P_M/P, the jamming-to-transmission power ratio",
            "figure2": {name: counted(self.table.of(name)) for name in self.table.names},
            "provenance": dict(self.table.rows[0].provenance),
        }


def reproduce(
    folder: Path,
    *,
    seed: int = 0,
    levels: Sequence[float] = JAMMING_LEVELS,
    printed_levels: Sequence[float] = PRINTED_LEVELS,
    on_progress: Callable[[int, int], None] | None = None,
) -> Reproduction:
    """Compute the paper's section 4 and write its figures and tables to a folder.

    Every point of the four curves comes with an upper bound.

    Args:
        folder: where the files go; made if it is missing.
        seed: the random seed of every solve.
        levels: P_M/P of the four curves, ascending; those of the poses among them.
        printed_levels: P_M/P of maximum gain as eq. 3.5 is printed, ascending.
        on_progress: called with how many points of the four curves are done, and how many there are.

    Raises:
        OutputError: the folder or a file cannot be written; the folder is tried before any work.
    """
    check_outputs({}, [(name, folder / name) for name in _FILES])
    scenario = paper_scenario()
    table = sweep(scenario, JAMMER_POWER, levels, seed=seed, on_progress=on_progress)
    printed = tuple(search_as_printed(scenario, level, seed=seed) for level in printed_levels)
    poses = [row for row in table.of(Scheme.OPTIMUM) if row.value in POSE_LEVELS]
    heading = (JAMMER_POWER, "min_sinr", "min_sinr_db", "x_m", "y_m", "z_m")
    files = (
        *write_figure(draw_figure2(table), *(folder / f"figure2{kind}" for kind in _KINDS)),
        table.write_csv(folder / "figure2.csv"),
        write_csv(
            folder / "figure2-printed.csv",
            [heading, *[(at.level, at.min_sinr, at.min_sinr_db, *at.position_m.tolist()) for at in printed]],
        ),
        *write_figure(draw_printed(table, printed), *(folder / f"figure2-printed{kind}" for kind in _KINDS)),
        *write_figure(draw_poses(scenario, poses), *(folder / f"poses{kind}" for kind in _KINDS)),
    )
    return Reproduction(table=table, printed=printed, files=files)


def reproduction_view(reproduction: Reproduction) -> View:
    """Write how certain the curves of Figure 2 are."""
    return document("\n".join(f"Figure 2: {line}." for line in certainty_lines(reproduction.table)))
