"""A scenario as tables for a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from nullpose.report.frames import place_words
from nullpose.report.summary import PointSummary, ScenarioSummary

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = ["scenario_view"]


def scenario_view(summary: ScenarioSummary) -> RenderableType:
    """Return a scenario's nodes, jammers, airspace and receiver, with what the links can carry at best.

    Args:
        summary: the scenario's numbers.
    """
    from rich.console import Group
    from rich.text import Text

    parts: list[RenderableType] = [Text(summary.scenario.name or "scenario", style="bold"), Text()]
    parts += [_surroundings_table(summary), _points_table("Nodes", "node", "SNR", summary.nodes)]
    if summary.jammers:
        parts.append(_points_table("Jammers", "jammer", "JNR", summary.jammers))
    else:
        parts.append(Text("No jammers."))
    parts.append(
        Text("At best: as close as the airspace and the keep-out allow, the dipole broadside, no jamming.")
    )
    return Group(*parts)


def _surroundings_table(summary: ScenarioSummary) -> Table:
    from rich import box
    from rich.table import Table

    airspace = summary.scenario.airspace
    table = Table(box=box.SIMPLE, show_header=False, pad_edge=False, title="Airspace and receiver")
    table.title_justify, table.title_style = "left", "bold"
    if summary.scenario.origin is not None:
        table.add_row("origin", place_words(summary.scenario.origin))
    table.add_row("altitude (m)", _range(airspace.altitude_m))
    table.add_row("x, east (m)", _range(airspace.x_m))
    table.add_row("y, north (m)", _range(airspace.y_m))
    table.add_row("keep-out radius (m)", f"{airspace.keep_out_m:g}")
    table.add_row("noise", f"{summary.noise_dbm:.2f} dBm ({summary.noise_w:.4g} W)")
    table.add_row("path gain at 1 m (dB)", f"{summary.reference_gain_db:.2f}")
    return table


def _range(sides: tuple[float, float] | None) -> str:
    return "unbounded" if sides is None else f"{sides[0]:g} to {sides[1]:g}"


def _points_table(title: str, noun: str, ratio: str, points: Sequence[PointSummary]) -> Table:
    from rich import box
    from rich.markup import escape
    from rich.table import Table

    table = Table(title=title, box=box.SIMPLE_HEAD, title_justify="left", title_style="bold", pad_edge=False)
    table.add_column(noun)
    columns = ("x (m)", "y (m)", "z (m)", "power (dBm)", "power (W)", "closest (m)", f"{ratio} at best (dB)")
    for column in columns:
        table.add_column(column, justify="right")
    for point in points:
        position = [f"{x:g}" for x in point.position_m]
        power = [f"{point.power_dbm:.2f}", f"{point.power_w:.4g}"]
        table.add_row(
            escape(point.name), *position, *power, f"{point.nearest_m:g}", f"{point.best_ratio_db:.2f}"
        )
    return table
