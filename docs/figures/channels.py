"""Work out the page "Which channel, and does it matter?": `make figures`.

The numbers of every channel go to ``channels.csv`` beside this script, the page's tables to
``channels-paper.csv``, ``channels-500-m.csv`` and ``channels-claims.csv``, and the figure to
``docs/images/channels.png``.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from twins import write

import nullpose
from nullpose.channel import ENVIRONMENTS
from nullpose.channel.elevation import AVERAGES
from nullpose.report.figures.style import GREY, INK, NODE, Curve, house_style, line_style

FOLDER = Path(__file__).parent
PAPER = nullpose.load(FOLDER.parents[1] / "examples" / "paper.toml")
GAP = 1e-4
STRONG, STRONGEST = 100.0, 1e4
EXPONENTS = (2.5, 3.0, 4.0)
BLOCK = [[8.0, 8.0], [12.0, 8.0], [12.0, 17.0], [8.0, 17.0]]
SAME_VALUE = 1e-5
MINUS = "\N{MINUS SIGN}"

# The distance between the nodes, the marks, and how far off a line's middle they are.
LOOKS = (
    (50.0, Curve("paper's scene, 50 m", INK, "", "o", 1.5, 3.0), -0.14),
    (500.0, Curve("stretched to 500 m", NODE, "", "D", 1.5, 3.1), 0.14),
)
LIMITS = ((-0.6, 18.0), (0.0, 0.63), (-0.17, 0.05))
TICKS = ((0, 5, 10, 15), (0, 0.2, 0.4, 0.6), (-0.1, 0))
RULES = (5, 8, 11, 14)  # between the kinds of channels

KNOWN: Mapping[tuple[str, str], float] = {
    ("paper", "power law 2.5"): 1.2133587,
    ("paper", "power law 3"): 1.1754851,
    ("paper", "power law 4"): 1.1058441,
    ("paper", "suburban, power"): 4.6794510,
    ("paper", "urban, power"): 2.3801376,
    ("paper", "urban, db"): 1.6365206,
    ("paper", "a block of buildings"): 1.316530,
    ("500 m", "suburban, power"): 16.5016145,
    ("500 m", "urban, power"): 8.1689586,
    ("500 m", "urban, db"): 5.4437780,
}
"""Values found by a multistart of SLSQP and proved by another program, by scene and channel."""

Row = dict[str, object]


@dataclass(frozen=True)
class Scene:
    """Two nodes and a jammer.

    Args:
        name: as tables have it.
        base: in free space.
        middle_m: from a node to the middle between both, where power laws are as strong as free space.
        strength_m2: P g0 over the noise, in free space and for power laws.
        elevation_strength_m2: the same by elevation.
    """

    name: str
    base: nullpose.Scenario
    middle_m: float
    strength_m2: float
    elevation_strength_m2: float

    def at(self, changes: Sequence[str], strength: float, jamming_ratio: float = 1.0) -> nullpose.Scenario:
        """Return the scene in a channel.

        Args:
            changes: to the scenario, that make it the channel's.
            strength: P g0 over the noise, m to the exponent.
            jamming_ratio: the jammer's power over the nodes'.
        """
        powers = [f"receiver.noise_w={1.0 / strength!r}", f"jammers.M.power_w={jamming_ratio!r}"]
        return nullpose.apply_overrides(self.base, [*powers, *changes])


@dataclass(frozen=True)
class Channel:
    """A channel of the comparison.

    Args:
        name: as tables have it.
        changes: to a scenario, that make it the channel's.
        exponent: with which power falls with distance.
        by_elevation: whether line of sight depends on the elevation.
    """

    name: str
    changes: tuple[str, ...]
    exponent: float = 2.0
    by_elevation: bool = False

    def strengths(self, scene: Scene) -> tuple[float, float]:
        """Return P g0 over the noise in a scene: for this channel, and for free space with the same radio.

        Args:
            scene: with a strength for each kind of channel.
        """
        if self.by_elevation:
            return scene.elevation_strength_m2, scene.elevation_strength_m2
        return scene.strength_m2 * scene.middle_m ** (self.exponent - 2.0), scene.strength_m2


def scenes() -> Iterator[Scene]:
    """Yield the paper's scene, and the same stretched to 500 m."""
    yield Scene("paper", PAPER, 25.0, 1e3, 4e3)
    far = [
        "airspace.altitude_m=[20.0, 300.0]",
        "nodes.S2.position_m=[0.0, 500.0, 0.0]",
        "jammers.M.position_m=[170.0, 150.0, 4.0]",
    ]
    yield Scene("500 m", nullpose.apply_overrides(PAPER, far), 250.0, 1.425e6, 1.425e6)


def channels(scene: Scene) -> Iterator[Channel]:
    """Yield the channels compared in a scene.

    Args:
        scene: buildings stand in the paper's.
    """
    yield Channel("free space", ())
    for exponent in EXPONENTS:
        law = f'channel={{model="power-law", exponent={exponent}}}'
        yield Channel(f"power law {exponent:g}", (law,), exponent)
    if scene.name == "paper":
        block = f"buildings=[{{polygon_m={BLOCK}, height_m=12.0}}]"
        yield Channel("a block of buildings", (block, "channel={blocked_loss_db=20.0, shadow_margin_m=0}"))
    for environment in ENVIRONMENTS:
        for average in AVERAGES:
            table = f'channel={{model="elevation", environment="{environment}", average="{average}"}}'
            yield Channel(f"{environment}, {average}", (table,), by_elevation=True)


def certified(scenario: nullpose.Scenario, scheme: str = "optimum") -> nullpose.Result:
    """Return a scheme's best pose, certified.

    Args:
        scenario: what to solve.
        scheme: which axes are allowed.
    """
    result = nullpose.solve(scenario, scheme, gap=GAP)
    if str(result.status) != "certified":
        raise RuntimeError(f"{scenario.name}: {scheme} is {result.status}")
    return result


def decibels(ratio: float) -> float:
    """Return a power ratio in dB."""
    return float(10.0 * np.log10(ratio))


def measured(scene: Scene, channel: Channel) -> Row:
    """Return what a channel does in a scene, a row of ``channels.csv``.

    Args:
        scene: nodes, jammer and strengths.
        channel: of all its links.
    """
    strength, free_strength = channel.strengths(scene)
    stated = scene.at(channel.changes, strength)
    best = certified(stated)
    free_pose = certified(scene.at((), free_strength)).pose
    value = best.objective.value
    known = KNOWN.get((scene.name, channel.name), value)
    if abs(value - known) > SAME_VALUE * known:
        raise RuntimeError(f"{scene.name}, {channel.name}: {value!r}, known is {known!r}")
    x_m, y_m, z_m = best.pose.position_m
    row: Row = {"scene": scene.name, "channel": channel.name, "value": value}
    row |= {"x_m": x_m, "y_m": y_m, "z_m": z_m}
    row |= {"regret_db": decibels(value / nullpose.min_sinr(stated, free_pose))}
    row |= {"vertical_loss_db_1": decibels(value / certified(stated, "vertical").objective.value)}
    strong = [scene.at(channel.changes, strength, ratio) for ratio in (STRONG, STRONGEST)]
    optima = [certified(scenario).objective.value for scenario in strong]
    nulls = [certified(scenario, "zero-interference").objective.value for scenario in strong]
    upright = certified(strong[0], "vertical").objective.value
    return row | {
        "vertical_loss_db_100": decibels(optima[0] / upright),
        "null_loss_db_100": decibels(optima[0] / nulls[0]),
        "null_loss_db_10000": decibels(optima[1] / nulls[1]),
        "saturation_db": decibels(optima[0] / optima[1]),
    }


def write_rows(name: str, rows: Sequence[Row]) -> None:
    """Write a table beside this script.

    Args:
        name: of the table.
        rows: with the same keys.
    """
    with (FOLDER / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def rounded(row: Row) -> Row:
    """Return a row with its numbers to seven digits, which no machine changes.

    Args:
        row: of ``channels.csv``.
    """
    return {key: f"{cell:.7g}" if isinstance(cell, float) else cell for key, cell in row.items()}


def number(value: object, digits: int) -> str:
    """Return a number as a table has it, a true minus sign before it and none before a zero.

    Args:
        value: the number.
        digits: after the point.
    """
    return f"{float(str(value)):z.{digits}f}".replace("-", MINUS)


def poses_table(rows: Sequence[Row]) -> list[Row]:
    """Return the table of best poses in a scene.

    Args:
        rows: of ``channels.csv``.
    """
    places = {"x (m)": "x_m", "y (m)": "y_m", "z (m)": "z_m"}
    return [
        {
            "channel": row["channel"],
            "best value (dB)": number(decibels(float(str(row["value"]))), 2),
            **{title: number(row[key], 1) for title, key in places.items()},
            "loss of the free-space pose (dB)": number(row["regret_db"], 2),
        }
        for row in rows
    ]


def claims_table(by_scene: Mapping[str, Sequence[Row]]) -> list[Row]:
    """Return the table of what vertical dipole and zero interference lose, both scenes side by side.

    Args:
        by_scene: the rows of ``channels.csv``.
    """
    columns = {
        "vertical, 1": ("vertical_loss_db_1", 1),
        "vertical, 100": ("vertical_loss_db_100", 1),
        "null, 100": ("null_loss_db_100", 3),
    }
    table: dict[object, Row] = {}
    for scene, rows in by_scene.items():
        for row in rows:
            cells = {
                f"{title}, {scene}": number(row[key], digits) for title, (key, digits) in columns.items()
            }
            table.setdefault(row["channel"], {"channel": row["channel"]}).update(cells)
    titles = [f"{title}, {scene}" for title in columns for scene in by_scene]
    return [{key: row.get(key, "") for key in ("channel", *titles)} for row in table.values()]


def draw(by_scene: Mapping[str, Sequence[Row]]) -> Figure:
    """Return the figure: a line for each channel, a mark for each scene.

    Args:
        by_scene: the rows of ``channels.csv``.
    """
    names = [str(row["channel"]) for row in by_scene["paper"]]
    figure = Figure(figsize=(6.0, 5.4), layout="constrained")
    panels = figure.subplots(1, 3, sharey=True, width_ratios=[1.35, 1.0, 1.0])
    for rows, (separation_m, look, shift) in zip(by_scene.values(), LOOKS, strict=True):
        heights = np.array([names.index(str(row["channel"])) for row in rows]) + shift
        shown = {"regret_db": 1.0, "z_m": separation_m, "x_m": separation_m}
        for axes, (key, unit) in zip(panels, shown.items(), strict=True):
            values = np.array([float(str(row[key])) for row in rows]) / unit
            axes.plot(values, heights, **line_style(look) | {"linestyle": "", "clip_on": False})
    titles = (
        "loss of the free-\nspace pose (dB)",
        "altitude /\nnode distance",
        "x /\nnode distance",
    )
    for axes, title, limits, ticks in zip(panels, titles, LIMITS, TICKS, strict=True):
        axes.set_xlabel(title)
        axes.set_xlim(limits)
        axes.set_xticks(ticks, [f"{tick:g}".replace("-", MINUS) for tick in ticks])
        for height in RULES:
            axes.axhline(height - 0.5, color=GREY, linewidth=0.6)
    panels[0].set_yticks(range(len(names)), names)
    panels[0].set_ylim(len(names) - 0.5, -0.5)
    panels[2].axvline(0.0, color=GREY, linewidth=0.8)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2, frameon=False, handlelength=1.0)
    return figure


def main() -> None:
    """Write tables and figure."""
    by_scene = {scene.name: [measured(scene, channel) for channel in channels(scene)] for scene in scenes()}
    write_rows("channels", [rounded(row) for row in chain.from_iterable(by_scene.values())])
    for scene, rows in by_scene.items():
        write_rows(f"channels-{scene.replace(' ', '-')}", poses_table(rows))
    write_rows("channels-claims", claims_table(by_scene))
    with house_style():
        write(draw(by_scene), "channels")


if __name__ == "__main__":
    main()
