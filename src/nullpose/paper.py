"""The paper's Figure 2 and its poses, recomputed. Nothing else in the library knows them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nullpose.files import check_outputs, write_csv
from nullpose.physics import to_db
from nullpose.physics.types import FloatArray
from nullpose.problem.build import build_family
from nullpose.problem.schemes import Scheme
from nullpose.report.answer import certainty_lines, counted
from nullpose.report.document import View, document
from nullpose.report.figures.poses import draw_poses
from nullpose.report.figures.style import CURVES, Curve, draw_curve, house_figure, write_figure
from nullpose.report.figures.sweep import draw_caption, draw_curves
from nullpose.report.numbers import MINUS
from nullpose.scenario import Override, Scenario, apply_overrides
from nullpose.solver.position_search import PositionSearch
from nullpose.study import ResultTable, spaced, sweep

if TYPE_CHECKING:
    from matplotlib.figure import Figure

JAMMER_POWER = "jammers.M.power_w"
"""The swept setting: with nodes of 1 W it equals the paper's ratio P_M/P."""

JAMMING_LEVELS = spaced(1e-3, 1e6, 109, log=True)
"""P_M/P of Figure 2, twelve to a decade."""

PRINTED_LEVELS = (*JAMMING_LEVELS[:48:3], *JAMMING_LEVELS[48::12])
"""P_M/P at which eq. 3.5 as printed is solved, for comparison: four to a decade up to 10, then one."""

POSE_LEVELS = (1e-2, 1.0, 1e2)
"""P_M/P of the pose figure: weak, medium and strong jamming."""


def paper_scenario() -> Scenario:
    """Return the paper's scenario: two nodes 50 m apart, one jammer, altitudes from 8 m to 30 m.

    Source: paper section 4, with unit transmission power, so that sigma^2 = 1 mW.
    """
    return Scenario.from_dict(
        {
            "name": "Bonilla Licea et al., ICASSP 2024, section 4",
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [
                {"name": "S1", "position_m": [0.0, 0.0, 0.0], "power_w": 1.0},
                {"name": "S2", "position_m": [0.0, 50.0, 0.0], "power_w": 1.0},
            ],
            "jammers": [{"name": "M", "position_m": [17.0, 15.0, 4.0], "power_w": 1.0}],
        }
    )


class PrintedPoint(NamedTuple):
    """The best position found at a jamming power. Nothing is proved of it.

    Args:
        level: P_M/P, a power ratio.
        position_m: (3,) metres.
        min_sinr: the smaller of both nodes' ratios, a power ratio.
    """

    level: float
    position_m: FloatArray
    min_sinr: float

    @property
    def min_sinr_db(self) -> float:
        """The same, dB."""
        return float(to_db(self.min_sinr))


def sinr_as_printed(scenario: Scenario, position_m: ArrayLike) -> FloatArray:
    """Evaluate eq. 3.5 to the letter.

    ``Gamma_i = (P_i / d_i^2) / (sum_j (1 - <d_j, d_1 x d_2>^2) J_j / d_j^2 + sigma^2)``. The gain towards the
    jammer comes out too large unless the nodes are seen at right angles; no antenna receives this.

    Source: paper eq. 3.5, as printed.

    Args:
        scenario: a scenario with exactly two nodes, and the paper's antennas.
        position_m: the drone's position, shape ``(..., 3)``, metres.

    Returns:
        Array of shape ``(..., 2)``, ratios.
    """
    p = np.asarray(position_m, dtype=float)
    to_nodes = scenario.node_positions_m - p[..., None, :]
    directions = to_nodes / np.linalg.norm(to_nodes, axis=-1, keepdims=True)
    product = np.cross(directions[..., 0, :], directions[..., 1, :])
    to_jammers = scenario.jammer_positions_m - p[..., None, :]
    jammer_distance_sq = np.sum(to_jammers**2, axis=-1)  # m^2
    cosine_sq = np.sum(to_jammers * product[..., None, :], axis=-1) ** 2 / jammer_distance_sq
    g0 = scenario.reference_gain
    jamming_w = np.sum(g0 * (1.0 - cosine_sq) * scenario.jammer_powers_w / jammer_distance_sq, axis=-1)
    signal_w = g0 * scenario.node_powers_w / np.sum(to_nodes**2, axis=-1)
    return np.asarray(signal_w / (jamming_w[..., None] + scenario.receiver.noise_power_w))


def search_as_printed(scenario: Scenario, level: float, *, seed: int = 0) -> PrintedPoint:
    """Search the position with the largest smaller ratio by eq. 3.5 as printed, by values.

    Args:
        scenario: the paper's scenario, in any airspace.
        level: P_M/P, a power ratio.
        seed: of the coarse positions.
    """
    varied = apply_overrides(scenario, [Override(JAMMER_POWER, level)])

    def min_sinr(position_m: FloatArray) -> float:
        return float(np.min(sinr_as_printed(varied, position_m)))

    search = PositionSearch(lambda at_m: math.log(min_sinr(at_m)), build_family(varied), seed)
    search.search()
    return PrintedPoint(level, search.state, min_sinr(search.state))


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
