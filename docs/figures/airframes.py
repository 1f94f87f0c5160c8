"""Draw the figures of the page "Do I need an omnidirectional drone?": `make figures`.

From the tables that ``airframes_data.py`` keeps beside this script, into ``docs/images/airframes-*.png``.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from twins import write

from nullpose.physics.types import FloatArray
from nullpose.report.figures.style import INK, VEHICLES, Curve, house_style

FOLDER = Path(__file__).parent
DIPOLES = (
    "level-vertical",
    "level-horizontal",
    "tilt-10-horizontal",
    "tilt-30-horizontal",
    "omnidirectional",
)
LEAST_LOSS_DB = -12.0
FIELD_SIZES, SIZE_SHADES = (2, 4, 8), ("#00204d", "#7c7b78", "#d8a800")
MINUS = "\N{MINUS SIGN}"

# Dark to light, each with a marker of its own: jamming powers and sizes of arrays.
SHADES = ("#00204d", "#575d6d", "#a69d75", "#d8c03a")
MARKERS = ("o", "s", "^", "D")

Table = dict[str, FloatArray]


def read(name: str) -> Table:
    """Return a table's columns of numbers, and the names in its column ``case`` as they are.

    Args:
        name: of the table.
    """
    with (FOLDER / f"airframes-{name}.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {
        key: np.array([row[key] if key == "case" else float(row[key]) for row in rows]) for key in rows[0]
    }


def line(axes: Axes, x: FloatArray, y: FloatArray, look: Curve, *, every: int = 6, start: int = 0) -> None:
    """Draw a vehicle's curve.

    Args:
        axes: where to draw.
        x: across, shape ``(n,)``.
        y: up, shape ``(n,)``.
        look: of the curve.
        every: markers are at every so many points.
        start: the first point with one.
    """
    axes.plot(
        x,
        y,
        color=look.colour,
        linestyle=look.line,
        linewidth=look.width,
        marker=look.marker,
        markersize=4.4,
        markerfacecolor="white",
        markevery=(start, every),
        zorder=look.order,
        label=look.label,
    )


def draw_paper() -> None:
    """Draw what each vehicle reaches in the paper's scene as the jammer grows."""
    table = read("paper")
    figure = Figure(figsize=(7.0, 4.3), layout="constrained")
    axes = figure.add_subplot()
    for index, name in enumerate(DIPOLES):
        line(axes, table["jamming_ratio"], table[name], VEHICLES[name], every=8, start=index)
    axes.set_xscale("log")
    axes.set_ylim(0.0, 1.55)
    axes.margins(x=0.02)
    axes.set_xlabel("jamming-to-transmission power ratio  $P_M/P$")
    axes.set_ylabel("smallest SINR over the nodes (power ratio)")
    figure.legend(loc="outside upper center", ncols=3, frameon=False, handlelength=3.4)
    write(figure, "airframes-paper", 170)


def draw_tilt() -> None:
    """Draw what tilt is worth, a panel for each way to mount the dipole."""
    table = read("tilt")
    figure = Figure(figsize=(7.6, 3.5), layout="constrained")
    panels = figure.subplots(1, 3, sharey=True)
    mounts = {
        0.0: "dipole upright on the body (0°)",
        45.0: "mounted at 45°",
        90.0: "dipole flat on the body (90°)",
    }
    for axes, (mount_deg, title) in zip(panels, mounts.items(), strict=True):
        for level, shade, marker in zip(np.unique(table["jamming_ratio"]), SHADES, MARKERS, strict=True):
            chosen = (table["jamming_ratio"] == level) & (table["mount_deg"] == mount_deg)
            axes.plot(
                table["tilt_max_deg"][chosen],
                table["value"][chosen],
                color=shade,
                marker=marker,
                markersize=3.6,
                markevery=6,
                linewidth=1.6,
                label=f"$P_M/P$ = {level:g}",
            )
        axes.set_title(title, fontsize=9.0)
        axes.set_xticks([0, 15, 30, 45, 60, 75, 90])
        axes.set_xlabel("largest tilt (degrees)")
    panels[0].set_ylabel("smallest SINR over the nodes (power ratio)")
    panels[0].set_ylim(0.0, 1.55)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4, frameon=False)
    write(figure, "airframes-tilt", 170)


def draw_arrays() -> None:
    """Draw arrays against a tilted dipole: in the paper's scene, and over the random fields."""
    table = read("arrays")
    figure = Figure(figsize=(7.6, 3.9), layout="constrained")
    axes, *panels = figure.subplots(1, 3, width_ratios=[1.1, 1.0, 1.0])
    shown = table["jamming_ratio"] == 100.0
    values_db, whole_db = (10.0 * np.log10(table[name][shown]) for name in ("digital", "omnidirectional"))
    axes.plot(table["elements"][shown], values_db, color=INK, marker="o", linewidth=1.5)
    whole = VEHICLES["omnidirectional"].colour
    axes.axhline(whole_db[0], color=whole, linewidth=1.5)
    axes.set_xscale("log", base=2)
    axes.set_xlim(0.9, 8.9)
    axes.set_ylim(-3.0, 12.0)
    axes.set_xticks([1, 2, 3, 4, 6, 8], ["1", "2", "3", "4", "6", "8"])
    axes.set_yticks([-3, 0, 3, 6, 9, 12], [f"{MINUS}3", "0", "3", "6", "9", "12"])
    axes.minorticks_off()
    axes.set_xlabel("elements of the array")
    axes.set_ylabel("smallest SINR (dB)")
    axes.set_title("paper's scene, $P_M/P$ = 100", fontsize=9.0)
    draw_array_shares(panels)
    looks = {"omnidirectional dipole": whole}
    looks |= {f"{size} elements": shade for size, shade in zip(FIELD_SIZES, SIZE_SHADES, strict=True)}
    handles = [Line2D([], [], color=shade, linewidth=1.8, label=label) for label, shade in looks.items()]
    figure.legend(handles=handles, loc="outside upper center", ncols=4, frameon=False, handlelength=3.0)
    write(figure, "airframes-arrays", 170)


def draw_array_shares(panels: list[Axes]) -> None:
    """Draw the CDF over the random fields of an array's gain over the omnidirectional dipole.

    Args:
        panels: one for each number of jammers.
    """
    arrays = read("field-arrays")
    whole = dict(zip(field_names(read("fields")), read("fields")["omnidirectional"], strict=True))
    dipole = np.array([whole[name] for name in field_names(arrays)])
    for axes, jammers in zip(panels, (1, 3), strict=True):
        chosen = arrays["jammers"] == jammers
        for size, shade in zip(FIELD_SIZES, SIZE_SHADES, strict=True):
            gain_db = 10.0 * np.log10(arrays[f"array-{size}"][chosen] / dipole[chosen])
            steps(axes, gain_db, color=shade, linewidth=1.5)
        axes.axvline(0.0, color=VEHICLES["omnidirectional"].colour, linewidth=1.5)
        axes.set_xlabel("gain over the\nomnidirectional dipole (dB)")
        axes.set_title(f"{chosen.sum()} fields, {jammers} jammer{'s' * (jammers > 1)}", fontsize=9.0)
        axes.set_xlim(left=-0.06 * axes.get_xlim()[1])  # the dipole's line stands off the axis
        axes.set_ylim(0.0, 1.02)
        axes.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25 %", "50 %", "75 %", "100 %"])
    panels[0].set_ylabel("CDF over fields")


def field_names(table: Table) -> list[tuple[float, ...]]:
    """Return what tells each field of a table from the others: its nodes, its jammers and its number.

    Args:
        table: with a row for each field.
    """
    return list(zip(table["nodes"], table["jammers"], table["index"], strict=True))


def steps(axes: Axes, values: FloatArray, **style: object) -> list[Line2D]:
    """Return the line of the empirical distribution function (CDF) of some values.

    Args:
        axes: where to draw.
        values: shape ``(n,)``.
        style: of the line.
    """
    ordered = np.sort(values)
    shares = np.arange(1, len(ordered) + 1) / len(ordered)
    return axes.plot(
        np.concatenate([ordered[:1], ordered]),
        np.concatenate([[0.0], shares]),
        drawstyle="steps-post",
        **style,
    )


def draw_errors() -> None:
    """Draw what uncertainty costs, for the pose that is best without it and for the robust one."""
    table = read("errors")
    figure = Figure(figsize=(7.6, 3.9), layout="constrained")
    panels = figure.subplots(1, 2, sharey=True)
    kinds = {
        "attitude_error_deg": "attitude error (degrees)",
        "jammer_radius_m": "radius of the ball that the jammer is in (m)",
    }
    for axes, (kind, words) in zip(panels, kinds.items(), strict=True):
        other = next(name for name in kinds if name != kind)
        for name in ("omnidirectional", "tilt-10-horizontal"):
            look = VEHICLES[name]
            chosen = (table["case"] == name) & (table[other] == 0.0)
            x = table[kind][chosen]
            axes.fill_between(
                x,
                table["robust_pose"][chosen],
                table["upper_bound"][chosen],
                color=look.colour,
                alpha=0.25,
                linewidth=0,
            )
            axes.plot(
                x,
                table["robust_pose"][chosen],
                color=look.colour,
                linewidth=look.width,
                marker=look.marker,
                markersize=4.0,
                markerfacecolor="white",
                label=f"{look.label}, robust pose",
            )
            axes.plot(
                x,
                table["nominal_pose"][chosen],
                color=look.colour,
                linewidth=1.3,
                linestyle=(0, (4, 2)),
                marker=look.marker,
                markersize=3.4,
                label=f"{look.label}, best pose without errors",
            )
        axes.set_xlabel(words)
        axes.margins(x=0.02)
        axes.set_ylim(0.0, 1.3)
    panels[0].set_ylabel("guaranteed smallest SINR (power ratio)")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2, frameon=False, handlelength=3.4)
    write(figure, "airframes-errors", 170)


def draw_fields() -> None:
    """Draw how much each vehicle loses against the omnidirectional one over the random fields."""
    table = read("fields")
    figure = Figure(figsize=(7.6, 4.9), layout="constrained")
    panels = figure.subplots(2, 3, sharex=True, sharey=True)
    for row, jammers in zip(panels, (1, 3), strict=True):
        for axes, nodes in zip(row, (2, 5, 10), strict=True):
            chosen = (table["jammers"] == jammers) & (table["nodes"] == nodes)
            for name in DIPOLES[:-1]:
                look = VEHICLES[name]
                share = table[name][chosen] / table["omnidirectional"][chosen]
                loss_db = np.maximum(10.0 * np.log10(share), LEAST_LOSS_DB)
                (drawn,) = steps(axes, loss_db, color=look.colour, linestyle=look.line, linewidth=1.8)
                drawn.set_label(look.label)
                drawn.set_zorder(look.order)
            axes.set_title(f"{nodes} nodes, {jammers} jammer{'s' * (jammers > 1)}", fontsize=9.0)
    axes = panels[0][0]
    axes.set_xlim(LEAST_LOSS_DB, 0.3)
    axes.set_ylim(0.0, 1.02)
    axes.set_xticks([-12, -9, -6, -3, 0], [f"{MINUS}12\nor less", f"{MINUS}9", f"{MINUS}6", f"{MINUS}3", "0"])
    axes.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25 %", "50 %", "75 %", "100 %"])
    figure.supxlabel("against the omnidirectional vehicle (dB)", fontsize=9.5)
    figure.supylabel("CDF over fields", fontsize=9.5)
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4, frameon=False, handlelength=3.4)
    write(figure, "airframes-fields", 170)


if __name__ == "__main__":
    with house_style():
        for draw in (draw_paper, draw_tilt, draw_arrays, draw_errors, draw_fields):
            draw()
