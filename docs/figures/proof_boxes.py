"""Draw the picture of README's first screen: the boxes of a proof around the pose that they prove best.

From ``examples/field.toml`` into ``docs/images/proof-boxes.png`` and its dark twin: `make figures`.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from twins import write

import nullpose
from nullpose.certificate.boxes import boxes_of
from nullpose.report.figures.style import DRONE, INK, JAMMER, MARKS, NODE, NULL, house_style
from nullpose.solver.certificate_from_proof import certificate_of

SCENARIO = nullpose.load(Path(__file__).parents[2] / "examples" / "field.toml")
GAP, CELLS, SPAN_DB = 1e-3, 201, 15.0
ZOOM_M = 14.0  # half the side of the closer view
WORDS = {"fontsize": 8.5, "linespacing": 1.3}
HALO = [withStroke(linewidth=2.2, foreground="white")]


def boxes_m(result: nullpose.Result) -> tuple[int, np.ndarray]:
    """Count a proof's boxes, and list the corners of those at the drone's altitude from above, (n, 4, 2)."""
    (tree,) = certificate_of(result).trees
    boxes = boxes_of(tree.root_m, tree.leaves)
    low, high = boxes.centre - boxes.half, boxes.centre + boxes.half
    up_m = result.pose.position_m[2] + 1e-9
    cut = (low[:, 2] <= up_m) & (up_m <= high[:, 2])
    x, y = np.array([low[cut, 0], high[cut, 0]]), np.array([low[cut, 1], high[cut, 1]])
    return len(boxes), np.stack([np.stack([x[i], y[j]], -1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))], 1)


def draw_boxes(
    axes: Axes, result: nullpose.Result, field: nullpose.study.Field, squares_m: np.ndarray
) -> None:
    """Draw the map of the best SINR at each place, the boxes on it, the points, the drone and its null."""
    high = field.best[0]
    look = {"cmap": "Blues", "vmin": high - SPAN_DB, "vmax": high + 0.35 * SPAN_DB, "shading": "gouraud"}
    axes.pcolormesh(
        field.east_m, field.north_m, np.nan_to_num(field.values, nan=-99.0), rasterized=True, **look
    )
    axes.add_collection(PolyCollection(squares_m, facecolor="none", edgecolor=INK, linewidth=0.3, alpha=0.75))
    position, axis = result.pose.position_m[:2], result.pose.antenna_axis[:2]
    along = position + np.outer((-80.0, 400.0), axis / np.linalg.norm(axis) * -np.sign(axis[0]))
    axes.plot(
        *along.T,
        color=NULL,
        linewidth=2.0,
        zorder=4.0,
        path_effects=[withStroke(linewidth=2.8, foreground=INK)],
    )
    for kind, points, size in (("node", SCENARIO.nodes, 5.0), ("jammer", SCENARIO.jammers, 10.0)):
        colour, marker = MARKS[kind]
        places = np.array([point.position_m[:2] for point in points]).T
        axes.plot(*places, marker, color=colour, markersize=size, markeredgecolor="white", zorder=5.0)
    axes.plot(*position, "o", color=DRONE, markersize=8.0, markeredgecolor="white", zorder=6.0)
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.spines[["top", "right"]].set_visible(True)


def label(axes: Axes, words: str, at_m: tuple[float, float], colour: str, side: str = "left") -> None:
    """Write words beside a point."""
    look = {"fontsize": 9.0, "fontweight": "bold", "path_effects": HALO, "zorder": 8.0}
    axes.text(*at_m, words, color=colour, ha=side, va="center", **look)


def draw() -> Figure:
    """Draw the whole airspace from above, and beside it the surroundings of the drone."""
    result = nullpose.solve(SCENARIO, gap=GAP)
    field = nullpose.value_map(result, cells=CELLS)
    count, squares_m = boxes_m(result)
    x, y, up_m = result.pose.position_m
    (west, east), (south, north) = SCENARIO.airspace.x_m, SCENARIO.airspace.y_m
    figure = Figure(figsize=(6.0, 4.0))
    whole, near = figure.add_axes((0.095, 0.115, 0.6, 0.675)), figure.add_axes((0.735, 0.43, 0.24, 0.36))
    draw_boxes(whole, result, field, squares_m)
    whole.set(xlim=(west, east), ylim=(south, north), xlabel="East x (m)", ylabel="North y (m)")
    label(whole, "drone", (x + 6.0, y - 13.0), INK, "right")
    label(whole, "null: the antenna\nhears nothing\nalong its axis", (118.0, 76.0), INK, "right")
    for jammer in SCENARIO.jammers:
        label(whole, "jammer", (jammer.position_m[0] + 12.0, jammer.position_m[1] + 4.0), JAMMER)
    weir = SCENARIO.nodes[-1].position_m
    label(whole, "sensor", (weir[0] + 9.0, weir[1] + 1.0), NODE)
    draw_boxes(near, result, field, squares_m)
    near.set(xlim=(x - ZOOM_M, x + ZOOM_M), ylim=(y - ZOOM_M, y + ZOOM_M), xticks=[], yticks=[])
    near.set_title(f"{2.0 * ZOOM_M:.0f} m wide, at the drone", fontsize=8.5, pad=4.0)
    value_db, bound_db = result.objective.value_db, 10.0 * np.log10(result.objective.upper_bound)
    colours = figure.add_axes((0.735, 0.36, 0.24, 0.03))
    bar = figure.colorbar(whole.collections[0], cax=colours, orientation="horizontal", extend="min")
    colours.set_xlim(right=field.best[0])
    bar.set_ticks([-10, -5, 0], labels=["\N{MINUS SIGN}10", "\N{MINUS SIGN}5", "0"])
    bar.ax.tick_params(labelsize=8.0, pad=1.0)
    figure.text(0.855, 0.23, "best SINR of the worst\nsensor at each place (dB)", **WORDS, ha="center")
    figure.text(0.855, 0.13, f"boxes at the drone's\naltitude, {up_m:.0f} m", **WORDS, ha="center")
    head = "The best pose keeps its null close to both jammers."
    figure.text(0.03, 0.93, head, fontsize=12.0, fontweight="bold")
    words = (
        f"Worst sensor: {value_db:.3f} dB. "
        f"Proved: no pose in the {count:,} boxes has more than {bound_db:.3f} dB."
    )
    figure.text(0.03, 0.865, words, fontsize=9.5)
    return figure


if __name__ == "__main__":
    with house_style():
        write(draw(), "proof-boxes")
