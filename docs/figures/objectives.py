"""Draw the figure and write the tables of the page "Which objective, and does it matter?": `make figures`.

From the numbers that ``objectives_data.py`` keeps beside this script, into ``docs/images/objectives.png`` and
``objectives-*-table.csv``.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from airframes import steps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from objectives_data import OBJECTIVES, PAPER
from scipy.optimize import brentq
from twins import write

from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import INK, house_style

FOLDER = Path(__file__).parent
LABELS = dict(zip(OBJECTIVES, ("worst node", "proportional fairness", "sum rate"), strict=True))
COLOURS = dict(zip(OBJECTIVES, ("#00204d", "#7c7b78", "#d8a800"), strict=True))
LINES = dict(zip(OBJECTIVES, ("-", (0, (5, 1.5)), (0, (1.5, 1.2))), strict=True))
SHOWN = {0.01: "o", 1.0: "s", 100.0: "^"}
CLOSE = 10.0**1e-3  # 0.01 dB, as a ratio

Rows = list[dict[str, str]]


def read(name: str) -> Rows:
    """Return the rows of a table of numbers.

    Args:
        name: of the table.
    """
    with (FOLDER / f"objectives-{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def column(rows: Rows, key: str, **chosen: str) -> FloatArray:
    """Return a column of numbers, of the rows with some cells.

    Args:
        rows: of a table.
        key: of the column.
        chosen: cells by key.
    """
    return np.array([float(row[key]) for row in rows if all(row[k] == cell for k, cell in chosen.items())])


def gains_db(rows: Rows, objective: str) -> FloatArray:
    """Return what any attitude gains in the paper's scene, in dB of the nodes' power, at each jamming power.

    Args:
        rows: of the paper's scene.
        objective: its name.
    """
    best, level = (
        column(rows, f"{objective}-here", objective=objective, scheme=scheme)
        for scheme in ("optimum", "vertical")
    )
    if objective != "sum-rate":
        return best - level
    # of two nodes the smallest SINR and the mean in dB tell both
    worst, mean = (
        column(rows, f"{name}-here", objective=objective, scheme="vertical") for name in OBJECTIVES[:2]
    )
    sinr = 10.0 ** (0.1 * np.stack([worst, 2.0 * mean - worst], axis=-1))
    return np.array([power_db(each, rate) for each, rate in zip(sinr, best, strict=True)])


def power_db(sinr: FloatArray, mean_rate: float) -> float:
    """Return by how many dB SINRs have to rise for a mean rate.

    Args:
        sinr: of every node.
        mean_rate: bits/s/Hz.
    """
    return float(
        brentq(lambda db: float(np.mean(np.log2(1.0 + sinr * 10.0 ** (0.1 * db)))) - mean_rate, -1, 99)
    )


def losses(fields: Rows, objective: str, at: str) -> FloatArray:
    """Return what an objective loses in each field at the best pose of another: dB, or per cent of the rate.

    Args:
        fields: the table.
        objective: what is lost.
        at: the other objective.
    """
    here, own = (column(fields, f"{objective}-here", objective=name) for name in (at, objective))
    return 100.0 * (1.0 - here / own) if objective == "sum-rate" else own - here


def loss_table(fields: Rows) -> list[list[str]]:
    """Return the medians of what each objective loses at the best pose of each, and the largest."""
    head = ["what is lost", *(f"at the best pose for {LABELS[name]}" for name in OBJECTIVES)]
    table = [head]
    for objective in OBJECTIVES:
        unit = "%" if objective == "sum-rate" else "dB"
        lost = [losses(fields, objective, at) for at in OBJECTIVES]
        cells = [
            "0" if at == objective else f"{np.median(each):.2f} {unit} ({each.max():.1f})"
            for at, each in zip(OBJECTIVES, lost, strict=True)
        ]
        table.append([LABELS[objective], *cells])
    return table


def attitude_table(fields: Rows) -> list[list[str]]:
    """Return what any attitude gains over an upright dipole, by the number of jammers."""
    table = [["jammers", "fields", *(LABELS[name] for name in OBJECTIVES)]]
    for name, few, many in (
        ("none", 0, 0),
        ("one", 1, 1),
        ("two", 2, 2),
        ("three", 3, 3),
        ("any number", 0, 3),
    ):
        cells = []
        for objective in OBJECTIVES:
            count = column(fields, "jammers", objective=objective)
            gain = column(fields, "power_db", objective=objective)[(count >= few) & (count <= many)]
            cells.append(f"{np.median(gain):.2f} ({gain.max():.1f})")
        table.append([name, str(len(gain)), *cells])
    return table


def position_table(paper: Rows) -> list[list[str]]:
    """Return the best poses of the paper's scene, and each objective there."""
    table = [["P_M / P", "objective", "east, north, up (m)", "worst node (dB)", "mean (dB)", "rate a node"]]
    for level in SHOWN:
        for objective in OBJECTIVES:
            (row,) = (
                row
                for row in paper
                if row["objective"] == objective
                and row["scheme"] == "optimum"
                and np.isclose(float(row["jamming_ratio"]), level)
            )
            place = ", ".join(f"{float(row[key]):z.2f}" for key in ("x_m", "y_m", "z_m"))
            here = [f"{float(row[f'{name}-here']):.3f}" for name in OBJECTIVES]
            table.append([f"{level:g}", LABELS[objective], place, *here])
    return table


def claim_table(paper: Rows) -> list[list[str]]:
    """Return where each claim of the paper holds under each objective, of the jamming powers looked at."""
    claims = {
        "Weak jamming: maximum gain is the optimum": (_shortfall("maximum-gain"), CLOSE, "up to"),
        "Strong jamming: zero interference is the optimum": (_shortfall("zero-interference"), CLOSE, "from"),
        "Zero interference is the same at any jamming power": (_change("zero-interference"), 1e-9, "from"),
        "Strong jamming: the null of maximum gain is on the jammer": (_off_null_deg, 1.0, "from"),
        "The vertical dipole moves to above the jammer": (_beside_jammer_m, 0.1, "from"),
        "Maximum gain is equally far from both nodes": (_unequal_m, 1e-2, "up to"),
        "Any attitude is worth 1 dB or more": (lambda rows, name: -gains_db(rows, name), -1.0, "from"),
        "All solutions saturate": (_unsaturated, CLOSE, "from"),
    }
    table = [["claim", *(LABELS[name] for name in OBJECTIVES)]]
    levels = column(paper, "jamming_ratio", objective=OBJECTIVES[0], scheme="optimum")
    for claim, (measure, most, kind) in claims.items():
        holds = [measure(paper, name) <= most for name in OBJECTIVES]
        table.append([claim, *(_range(levels, each, kind) for each in holds)])
    return table


def _range(levels: FloatArray, holds: FloatArray, kind: str) -> str:
    """Say up to or from which level something holds at every level looked at."""
    ordered = holds if kind == "up to" else holds[::-1]
    count = len(holds) if ordered.all() else int(np.argmin(ordered))
    if count in (0, len(holds)):
        return "at all" if count else "at none"
    return f"{kind} {(levels if kind == 'up to' else levels[::-1])[count - 1]:.3g}"


def _of(rows: Rows, key: str, name: str, scheme: str) -> FloatArray:
    return column(rows, key, objective=name, scheme=scheme)


def _shortfall(scheme: str):
    return lambda rows, name: _of(rows, "value", name, "optimum") / _of(rows, "value", name, scheme)


def _change(scheme: str):
    return lambda rows, name: np.abs(
        _of(rows, "value", name, scheme) / _of(rows, "value", name, scheme)[0] - 1.0
    )


def _places_m(rows: Rows, name: str, scheme: str) -> FloatArray:
    return np.stack([_of(rows, key, name, scheme) for key in ("x_m", "y_m", "z_m")], axis=-1)


def _off_null_deg(rows: Rows, name: str) -> FloatArray:
    tilt, azimuth = (np.radians(_of(rows, key, name, "maximum-gain")) for key in ("tilt_deg", "azimuth_deg"))
    axis = np.stack([np.sin(tilt) * np.sin(azimuth), np.sin(tilt) * np.cos(azimuth), np.cos(tilt)], axis=-1)
    away_m = PAPER.jammer_positions_m[0] - _places_m(rows, name, "maximum-gain")
    cosine = np.abs(np.sum(axis * away_m, axis=-1)) / np.linalg.norm(away_m, axis=-1)
    return np.degrees(np.arccos(np.minimum(1.0, cosine)))


def _beside_jammer_m(rows: Rows, name: str) -> FloatArray:
    away_m = PAPER.jammer_positions_m[0] - _places_m(rows, name, "vertical")
    return np.linalg.norm(away_m[:, :2], axis=-1)


def _unequal_m(rows: Rows, name: str) -> FloatArray:
    away_m = _places_m(rows, name, "maximum-gain")[:, None] - PAPER.node_positions_m
    return np.abs(np.diff(np.linalg.norm(away_m, axis=-1), axis=-1)[:, 0])


def _unsaturated(rows: Rows, name: str) -> FloatArray:
    schemes = ("optimum", "zero-interference", "maximum-gain", "vertical")
    values = np.stack([_of(rows, "value", name, scheme) for scheme in schemes])
    return np.max(values / values[:, -1:], axis=0)


def draw_places(axes: Axes, paper: Rows) -> None:
    """Draw where the drone is best in the paper's scene."""
    for objective in OBJECTIVES:
        levels = _of(paper, "jamming_ratio", objective, "optimum")
        places_m = _places_m(paper, objective, "optimum")
        axes.plot(*places_m[:, :2].T, ".", color=COLOURS[objective], markersize=2.0, alpha=0.6)
        for level, marker in SHOWN.items():
            (at,) = np.flatnonzero(np.isclose(levels, level))
            axes.plot(
                *places_m[at, :2], marker, color=COLOURS[objective], markersize=5.5, markeredgecolor=INK,
                markeredgewidth=0.5, zorder=4,
            )  # fmt: skip
    for words, point in (("S1", PAPER.nodes[0]), ("S2", PAPER.nodes[1]), ("M", PAPER.jammers[0])):
        axes.plot(*point.position_m[:2], "x" if words == "M" else "+", color=INK, markersize=7.0)
        axes.annotate(words, point.position_m[:2], (5, -3), textcoords="offset points", fontsize=8.0)
    axes.set_aspect("equal")
    axes.set_xlim(-14.0, 24.0)
    axes.set_ylim(-6.0, 56.0)
    axes.set_xlabel("east (m)")
    axes.set_ylabel("north (m)")
    axes.set_title("best positions, paper's scene", fontsize=9.0)


def draw() -> None:
    """Draw the positions, what any attitude gains in the paper's scene, and over the fields."""
    paper, fields = read("paper"), read("fields")
    figure = Figure(figsize=(7.6, 3.7), layout="constrained")
    places, power, cdf = figure.subplots(1, 3, width_ratios=[0.8, 1.0, 1.0])
    draw_places(places, paper)
    for objective in OBJECTIVES:
        look = {"color": COLOURS[objective], "linestyle": LINES[objective], "linewidth": 1.9}
        levels = _of(paper, "jamming_ratio", objective, "optimum")
        power.plot(levels, gains_db(paper, objective), **look, label=LABELS[objective])
        steps(cdf, np.minimum(column(fields, "power_db", objective=objective), 15.0), **look)
    power.set_xscale("log")
    power.set_ylim(0.0, None)
    power.set_xlabel("$P_M/P$")
    power.set_ylabel("gain of any attitude (dB)")
    power.set_title("paper's scene", fontsize=9.0)
    cdf.set_xlim(0.0, 14.8)
    cdf.set_ylim(0.0, 1.02)
    cdf.set_xlabel("gain of any attitude (dB)")
    cdf.set_ylabel("CDF over fields")
    cdf.set_title("200 random fields", fontsize=9.0)
    for level, marker in SHOWN.items():
        places.plot([], [], marker, color="white", markeredgecolor=INK, markersize=5.5, label=f"{level:g}")
    places.legend(title="$P_M/P$", loc="center right", fontsize=7.5, title_fontsize=7.5, frameon=False)
    figure.legend(
        *power.get_legend_handles_labels(),
        loc="outside upper center",
        ncols=3,
        frameon=False,
        handlelength=3.4,
    )
    write(figure, "objectives", 170)


def main() -> None:
    """Write the tables and draw."""
    paper, fields = read("paper"), read("fields")
    tables = {
        "losses": loss_table(fields),
        "attitude": attitude_table(fields),
        "positions": position_table(paper),
        "claims": claim_table(paper),
    }
    for name, table in tables.items():
        with (FOLDER / f"objectives-{name}-table.csv").open("w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(table)
    with house_style():
        draw()


if __name__ == "__main__":
    main()
