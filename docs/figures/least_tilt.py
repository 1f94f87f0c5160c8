"""How much tilt do random scenes need? The table and the figure of the page on airframes.

The scenes are those of a study: 2 to 6 nodes and a jammer on a square of 300 m. A scene counts as one that
needs no more than a tilt, or more, only where that is proved within a number of boxes.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from twins import write

import nullpose
from nullpose.report.figures.style import house_style
from nullpose.report.figures.sweep import MOUNT_CURVES
from nullpose.study.monte_carlo import StudySpec, draw_scene

FOLDER = Path(__file__).parent
MOUNTS_DEG = (0.0, 45.0, 90.0)
TILTS_DEG = (0.0, 10.0, 20.0, 30.0)
BOXES, GAP = 20_000, 1e-3  # of each proof: the same on every machine
CHANNELS: dict[str, tuple[int, dict[str, object] | None]] = {
    "free space": (500, None),
    "power law 3": (200, {"model": "power-law", "exponent": 3.0}),
    "urban": (200, {"model": "elevation", "environment": "urban", "average": "power"}),
}
ANTENNAS = {"isotropic": "isotropic", "whips": "dipole"}
SQUARE = {"layout": "rectangle", "x_m": [-150.0, 150.0], "y_m": [-150.0, 150.0]}
SPEC = StudySpec.from_dict(
    {
        "name": "Random fields",
        "seed": 1,
        "scenes": 500,
        "scene": {
            "airspace": {"altitude_m": [20.0, 120.0]},
            "receiver": {"noise_dbm": -95.0, "frequency_hz": 868e6},
        },
        "nodes": SQUARE | {"count": [2, 6], "height_m": 1.0, "power_dbm": 14.0},
        "jammers": SQUARE | {"count": 1, "height_m": 2.0, "power_dbm": 20.0},
    }
)
Row = tuple[str, str, int, float, float, float]


def scene(index: int, antenna: str, channel: dict[str, object] | None) -> nullpose.Scenario:
    """Return a scene with its ground antennas and its channel.

    Args:
        index: of the study.
        antenna: of all ground points.
        channel: of all links; None for free space.
    """
    plain = draw_scene(SPEC, index).to_dict()
    for kind in ("nodes", "jammers"):
        plain[kind] = [point | {"antenna": antenna} for point in plain[kind]]
    return nullpose.Scenario.from_dict(plain if channel is None else plain | {"channel": channel})


def least(task: tuple[str, str, int]) -> list[Row]:
    """Find the least tilt of each mount in one scene.

    Args:
        task: names of channel and antenna, and the scene's number.

    Returns:
        For each mount and for the better of upright and flat: a tilt that suffices and one that does not.
    """
    name, antenna, index = task
    scenario = scene(index, ANTENNAS[antenna], CHANNELS[name][1])
    found = nullpose.least_tilt(scenario, mounts_deg=MOUNTS_DEG, gap=GAP, node_limit=BOXES, threads=1)
    return [
        (
            name,
            antenna,
            index,
            mount.mount_deg,
            math.nan if mount.suffices_deg is None else mount.suffices_deg,
            -1.0 if mount.fails_deg is None else mount.fails_deg,
        )
        for mount in found.mounts
    ]


def tasks() -> Iterator[tuple[str, str, int]]:
    """Yield what is to be solved, one kind of scene after the other."""
    for name, (count, _) in CHANNELS.items():
        for antenna in ANTENNAS:
            yield from ((name, antenna, index) for index in range(count))


def table(rows: list[Row]) -> list[list[object]]:
    """Set for some tilts in what share of scenes they suffice and in what they do not, both proved (%)."""
    lines: list[list[object]] = []
    for name, (count, _) in CHANNELS.items():
        for antenna in ANTENNAS:
            for mount in MOUNTS_DEG:
                sides = [row[4:] for row in rows if (row[0], row[1], row[3]) == (name, antenna, mount)]
                enough, little = np.array(sides).T
                cells = [
                    f"{100.0 * np.mean(enough <= tilt):.1f} / {100.0 * np.mean(little >= tilt):.1f}"
                    for tilt in TILTS_DEG
                ]
                lines.append([name, antenna, f"{mount:g}", count, *cells])
    return lines


def draw(rows: list[Row]) -> Figure:
    """Draw how many scenes need more than each tilt, in free space: a panel for each antenna."""
    with house_style():
        figure = Figure(figsize=(9.0, 3.8), layout="constrained")
        for axes, antenna in zip(figure.subplots(1, 2, sharey=True), ANTENNAS, strict=True):
            for mount, look in zip(MOUNTS_DEG, MOUNT_CURVES, strict=False):
                tilts = [row[4] for row in rows if (row[0], row[1], row[3]) == ("free space", antenna, mount)]
                steps = np.minimum(np.sort(tilts), 90.0)  # those that are not known are the last
                axes.step(
                    [0.0, *steps, 90.0],
                    [100.0, *(100.0 * (1.0 - np.arange(1, len(steps) + 1) / len(steps))), 0.0],
                    where="post",
                    color=look.colour,
                    linestyle=look.line,
                    label=f"mounted at {mount:g}°",
                )
            axes.set_xlim(0.0, 90.0)
            axes.set_ylim(0.0, 100.0)
            axes.set_xlabel("tilt (deg)")
            axes.set_title("isotropic ground antennas" if antenna == "isotropic" else "upright whips")
        figure.axes[0].set_ylabel("scenes in which a tilt is not proved to suffice (%)")
        figure.axes[1].legend(frameon=False)
    return figure


def main() -> None:
    """Work out all scenes on all processors, and write tables and figure."""
    for name in CHANNELS:  # compiles, once for each kind
        for antenna in ANTENNAS:
            nullpose.solve(scene(0, ANTENNAS[antenna], CHANNELS[name][1]), gap=0.1)
    with ProcessPoolExecutor() as pool:
        rows = [row for part in pool.map(least, tasks(), chunksize=5) for row in part]
    for file, head, lines in (
        ("least-tilt.csv", ["channel", "antennas", "scene", "mount_deg", "suffices_deg", "fails_deg"], rows),
        (
            "least-tilt-table.csv",
            ["channel", "ground antennas", "mount (deg)", "scenes", *(f"{t:g}°" for t in TILTS_DEG)],
            table(rows),
        ),
    ):
        with (FOLDER / file).open("w", encoding="utf-8", newline="") as out:
            csv.writer(out, lineterminator="\n").writerows([head, *lines])
    write(draw(rows), "least-tilt", 130)


if __name__ == "__main__":
    main()
