"""Draw README's cards, 400 by 240 pixels, one subject each: `make figures`, after ``airframes.py``.

Into ``docs/images/card-*.png`` and their dark twins.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from airframes import read, steps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from proof_boxes import CELLS, GAP, SCENARIO, boxes_m, draw_boxes
from twins import write

import nullpose
from nullpose.report.figures.names import place_names
from nullpose.report.figures.plan import draw_plan
from nullpose.report.figures.plan_scene import PlanScene
from nullpose.report.figures.style import INK, VEHICLES, house_style
from nullpose.solver import solve

EXAMPLES = Path(__file__).parents[2] / "examples"
AXIS = 0.24  # half-length of an antenna's axis over the extent of the scene


def framed(figure: Figure, title: str) -> Axes:
    """Add axes that fill a card below its title."""
    figure.text(0.03, 0.9, title, fontsize=7.5, fontweight="bold")
    axes = figure.add_axes((0.03, 0.04, 0.94, 0.82))
    axes.set(xticks=[], yticks=[])
    return axes


def airframes(figure: Figure) -> None:
    """Draw three vehicles as the jamming grows."""
    axes, table = framed(figure, "Level, or any attitude?"), read("paper")
    for name, words, at in (
        ("omnidirectional", "any attitude", (2e1, 1.28)),
        ("level-horizontal", "level, flat", (5e1, 0.8)),
        ("level-vertical", "level, upright", (1.2e-3, 0.36)),
    ):
        axes.plot(table["jamming_ratio"], table[name], color=VEHICLES[name].colour, linewidth=1.8)
        axes.text(*at, words, color=VEHICLES[name].colour, fontsize=6.5, fontweight="bold")
    axes.set(xscale="log", ylim=(0.0, 1.62), xticks=[], yticks=[])
    axes.minorticks_off()
    axes.text(1.2e-3, 0.08, "SINR over jamming power", fontsize=6.5, color=INK)


def plan_of(name: str, title: str, **more: bool) -> Callable[[Figure], None]:
    """Make a card of an example seen from above."""

    def draw(figure: Figure) -> None:
        result = solve(nullpose.load(EXAMPLES / f"{name}.toml"), gap=1e-2, **more)
        scene = PlanScene(scenario=result.scenario, poses=(result.pose,), axis=AXIS, uncertain=bool(more))
        axes = framed(figure, title)
        draw_plan(axes, scene, result.pose)
        axes.set(xlabel="", ylabel="", xticks=[], yticks=[])
        for text in [text for text in axes.texts if text.get_text().startswith(("drone", "mast"))]:
            text.remove()  # a card has space for few names
        place_names(axes)

    return draw


def certificate(figure: Figure) -> None:
    """Draw the boxes of a proof around its pose."""
    result = nullpose.solve(SCENARIO, gap=GAP)
    axes = framed(figure, "Proved, box by box")
    draw_boxes(axes, result, nullpose.value_map(result, cells=CELLS), boxes_m(result)[1])
    x, y, _ = result.pose.position_m
    axes.set(xlim=(x - 35.0, x + 35.0), ylim=(y - 21.0, y + 16.0), aspect="auto", xticks=[], yticks=[])


def studies(figure: Figure) -> None:
    """Draw the distribution of what vehicles lose over random fields."""
    axes, table = framed(figure, "Over random scenes"), read("fields")
    for name, words, at in (
        ("level-vertical", "level, upright", (-6.9, 0.14)),
        ("level-horizontal", "level, flat", (-11.6, 0.75)),
        ("tilt-30-horizontal", "tilt 30°", (-3.2, 0.3)),
    ):
        loss_db = np.maximum(10.0 * np.log10(table[name] / table["omnidirectional"]), -12.0)
        steps(axes, loss_db, color=VEHICLES[name].colour, linewidth=1.8)
        axes.text(*at, words, color=VEHICLES[name].colour, fontsize=6.5, fontweight="bold")
    axes.set(xlim=(-12.0, 0.3), ylim=(0.0, 1.05))


CARDS = {
    "airframes": airframes,
    "no-fly": plan_of("no-fly", "No-fly zones and fences"),
    "robust": plan_of("robust", "Jammer somewhere in the ring", robust=True),
    "channels": plan_of("town", "Buildings that block links"),
    "studies": studies,
    "certificate": certificate,
}


if __name__ == "__main__":
    for card, draw_card in CARDS.items():
        with house_style("column"):
            picture = Figure(figsize=(2.0, 1.2))
            draw_card(picture)
            write(picture, f"card-{card}")
