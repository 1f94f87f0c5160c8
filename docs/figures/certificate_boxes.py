"""Draw the boxes that proofs leave, and count those they examine: `make figures`.

Writes ``docs/images/certificate-boxes.png`` and ``docs/figures/certificate-boxes.csv``, which the page "The
certificate explained" shows.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MultipleLocator
from twins import write

import nullpose
from nullpose.certificate.boxes import boxes_of
from nullpose.certificate.certificate import AFFINE, FAR, KEPT_OUT, TOWARDS, WORLD
from nullpose.report.figures.style import GREY, INK, JAMMER, MARKS, NODE, house_style
from nullpose.solver.certificate_from_proof import certificate_of

DOCS = Path(__file__).parents[1]
TABLE = DOCS / "figures" / "certificate-boxes.csv"

SCENARIO = nullpose.load(DOCS.parent / "examples" / "paper.toml")
EXPONENTS = {1e-2: -2, 1e-4: -4, 1e-6: -6}
POWERS = range(-3, 7)  # of ten: the jammer's power over the nodes'
DRAWN = {"optimum": "Optimum: any axis", "vertical": "Vertical axis"}
COUNTED = ("optimum", "zero-interference", "maximum-gain", "vertical")

# Okabe and Ito's colours, thinned: told apart with any colour vision
FILLS = {
    FAR: ("#ececec", "too far from a node, as is all outside"),
    TOWARDS: ("#8fc4e8", "bounded for all axes, using the jammer's direction"),
    WORLD: ("#f3cf87", "bounded for all axes"),
    AFFINE: ("#8ed1b8", "bounded for the vertical axis"),
    KEPT_OUT: ("#d9a3c0", "inside the keep-out radius"),
}
POSE = INK
WINDOW_M = 1.25  # half the width of the closer views
MOST_M = 43.0


def solved(scheme: str, gap: float, power: int) -> nullpose.Result:
    """Return the paper's scenario solved at a jamming power.

    Args:
        scheme: the case.
        gap: at which the proof is done.
        power: of ten, the jammer's power over the nodes'.
    """
    scenario = nullpose.apply_overrides(SCENARIO, [f"jammers.M.power_w=1e{power}"])
    return nullpose.solve(scenario, scheme=scheme, gap=gap)


def write_table() -> None:
    """Write how many boxes were examined, a row for each case and gap."""
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["case", "gap", *(f"$10^{{{power}}}$" for power in POWERS)])
        for scheme in COUNTED:
            for gap, exponent in EXPONENTS.items():
                counts = [sum(p.nodes for p in solved(scheme, gap, power).proofs) for power in POWERS]
                writer.writerow([scheme.replace("-", " "), f"$10^{{{exponent}}}$", *counts])


def draw_floor(axes: Axes, solution: nullpose.Result, size: float) -> set[int]:
    """Draw the leaves that touch the floor in plan view; return the tests among them.

    Args:
        axes: where to draw.
        solution: with a proof of one tree.
        size: of the mark at the pose, points.
    """
    (tree,) = certificate_of(solution).trees
    boxes = boxes_of(tree.root_m, tree.leaves)
    floor = np.flatnonzero(tree.leaves.box[:, 5] == 0)
    low, side = boxes.centre - boxes.half, 2.0 * boxes.half
    tests = tree.leaves.test[floor]
    axes.add_collection(
        PatchCollection(
            [Rectangle((low[i, 0], low[i, 1]), side[i, 0], side[i, 1]) for i in floor],
            facecolor=[FILLS[test][0] for test in tests],
            edgecolor=GREY,
            linewidth=0.4,
        )
    )
    (x, y), (width, depth) = tree.root_m[0, :2], np.ptp(tree.root_m[:, :2], axis=0)
    axes.add_patch(Rectangle((x, y), width, depth, fill=False, edgecolor=INK, linewidth=0.9))
    x, y, _ = solution.pose.position_m
    axes.plot(x, y, "o", color=POSE, markeredgecolor="white", markeredgewidth=0.6, markersize=size, zorder=5)
    x, y, _ = SCENARIO.jammers[0].position_m
    axes.plot(
        x, y, MARKS["jammer"][1], color=JAMMER, markersize=1.8 * size, markeredgecolor="white", zorder=4
    )
    axes.set_aspect("equal")
    axes.grid(visible=False)
    return set(tests.tolist())


def draw_whole(axes: Axes, solution: nullpose.Result) -> None:
    """Draw the whole floor, with the nodes.

    Args:
        axes: where to draw.
        solution: with a proof of one tree.
    """
    draw_floor(axes, solution, 5.5)
    for node in SCENARIO.nodes:
        x, y, _ = node.position_m
        axes.plot(x, y, MARKS["node"][1], color=NODE, markersize=5)
        axes.annotate(node.name, (x, y), xytext=(7, 0), textcoords="offset points", va="center", fontsize=8.5)
    axes.set_xlim(-MOST_M, MOST_M)
    axes.set_ylim(-6.0, 56.0)
    axes.set_title(f"{DRAWN[solution.scheme.value]}\nboxes at the lowest altitude", fontsize=9.0)
    axes.set_ylabel("North y (m)")


def draw_near(axes: Axes, solution: nullpose.Result, exponent: int) -> set[int]:
    """Draw the floor around the pose; return the tests that the proof's leaves use.

    Args:
        axes: where to draw.
        solution: with a proof of one tree.
        exponent: the gap, as a power of ten.
    """
    used = draw_floor(axes, solution, 6.0)
    x, y, _ = solution.pose.position_m
    axes.set_xlim(x - WINDOW_M, x + WINDOW_M)
    axes.set_ylim(y - WINDOW_M, y + WINDOW_M)
    for ticks in (axes.xaxis, axes.yaxis):
        ticks.set_major_locator(MultipleLocator(1.0))
    axes.spines[["top", "right"]].set_visible(True)
    for spine in axes.spines.values():
        spine.set(color=POSE, linewidth=1.2)
    (proof,) = solution.proofs
    axes.set_title(
        f"gap $10^{{{exponent}}}$\n{len(proof.leaves)} final boxes, {proof.nodes} examined", fontsize=9.0
    )
    return used


def draw() -> Figure:
    """Return the figure: a row for each case, the whole floor and then its middle at each gap."""
    figure = Figure(figsize=(10.0, 6.3), layout="constrained")
    panels = figure.subplots(len(DRAWN), 1 + len(EXPONENTS), width_ratios=[1.38, 1.0, 1.0, 1.0])
    used: set[int] = set()
    for row, scheme in enumerate(DRAWN):
        solution = None
        for column, (gap, exponent) in enumerate(EXPONENTS.items(), start=1):
            solution = solved(scheme, gap, 0)
            used |= draw_near(panels[row, column], solution, exponent)
        assert solution is not None
        draw_whole(panels[row, 0], solution)
        for axes in panels[-1]:
            axes.set_xlabel("East x (m)")
    handles: list[Patch | Line2D] = [
        Patch(facecolor=fill, edgecolor=GREY, linewidth=0.5, label=label)
        for test, (fill, label) in FILLS.items()
        if test in used
    ]
    handles += [
        Line2D([], [], marker="o", color=POSE, markersize=7, linestyle="", label="drone, pose found"),
        Line2D([], [], marker="X", color=JAMMER, markersize=7, linestyle="", label="jammer"),
        Line2D([], [], marker="s", color=NODE, markersize=6, linestyle="", label="node"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False, fontsize=8.5)
    return figure


def main() -> None:
    """Write the table and the picture."""
    write_table()
    with house_style():
        write(draw(), "certificate-boxes")


if __name__ == "__main__":
    main()
