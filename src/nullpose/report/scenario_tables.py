"""A scenario as tables for a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from nullpose.physics.quantity import Quantity
from nullpose.report.airframe import airframe_words, array_words, reach_words
from nullpose.report.frames import place_words
from nullpose.report.summary import PointSummary, ScenarioSummary
from nullpose.report.tables import new_table
from nullpose.scenario import Airspace, NoFlyZone, Scenario

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = ["scenario_view"]


def scenario_view(summary: ScenarioSummary) -> RenderableType:
    """Return a scenario's points, airspace, vehicle and receiver, with what the links can carry at best.

    Args:
        summary: the scenario's numbers.
    """
    from rich.console import Group
    from rich.text import Text

    scenario = summary.scenario
    parts: list[RenderableType] = [Text(scenario.name or "scenario", style="bold"), Text()]
    parts += [_pairs("Airspace", _airspace_rows(scenario))]
    if scenario.airspace.no_fly:
        parts.append(_zones_table(scenario.airspace.no_fly))
    parts.append(_pairs("Vehicle and receiver", _vehicle_rows(summary)))
    parts.append(_nodes_table(summary))
    if summary.jammers:
        parts.append(_jammers_table(summary))
    if summary.eavesdroppers:
        parts.append(_eavesdroppers_table(summary))
    if not (summary.jammers or summary.eavesdroppers):
        parts.append(Text("No jammers."))
    parts.append(Text("\n".join(_notes(summary))))
    return Group(*parts)


def _notes(summary: ScenarioSummary) -> list[str]:
    scenario = summary.scenario
    room = scenario.airspace.no_fly or scenario.airspace.geofence_m is not None
    jamming = ", no jamming"
    if scenario.objective == "secrecy-rate":
        jamming = ", jamming as it is" if scenario.jammers else ""
    notes = [
        "At best: as close as the airspace and the keep-out allow"
        f"{' (zones and fence not counted)' if room else ''}, the dipole broadside{jamming}."
    ]
    notes += [f"Node {name} requires more than its link carries at best." for name in summary.beyond_reach]
    if scenario.is_uncertain:
        notes.append("Errors and uncertainty count where a guaranteed value is asked for, not otherwise.")
    return notes


def _pairs(title: str, rows: Sequence[tuple[str, str]]) -> Table:
    from rich import box
    from rich.markup import escape
    from rich.table import Table

    table = Table(box=box.SIMPLE, show_header=False, pad_edge=False, title=title)
    table.title_justify, table.title_style = "left", "bold"
    for name, words in rows:
        table.add_row(name, escape(words))
    return table


def _airspace_rows(scenario: Scenario) -> list[tuple[str, str]]:
    airspace = scenario.airspace
    origin = [] if scenario.origin is None else [("origin", place_words(scenario.origin))]
    fence = [] if airspace.geofence_m is None else [("geofence", _fence_words(airspace))]
    return [
        *origin,
        ("altitude (m)", _range(airspace.altitude_m)),
        ("x, east (m)", _range(airspace.x_m)),
        ("y, north (m)", _range(airspace.y_m)),
        *fence,
        ("keep-out radius (m)", f"{airspace.keep_out_m:g}"),
    ]


def _fence_words(airspace: Airspace) -> str:
    outline_m = airspace.geofence_outline_m
    return f"{len(outline_m)} corners, {_extent_words(outline_m)}"


def _extent_words(outline_m: np.ndarray) -> str:
    (west, south), (east, north) = outline_m.min(axis=0), outline_m.max(axis=0)
    return f"x {west:g} to {east:g}, y {south:g} to {north:g}"


def _zones_table(zones: Sequence[NoFlyZone]) -> Table:
    from rich.markup import escape

    table = new_table("No-fly zones", (), first="zone")
    for column in ("shape", "where (m)", "altitude (m)"):
        table.add_column(column)
    for zone in zones:
        if zone.centre_m is not None:
            where = f"centre {zone.centre_m[0]:g}, {zone.centre_m[1]:g}, radius {zone.radius_m:g}"
        else:
            where = _extent_words(zone.outline_m)
        shape = f"polygon of {len(zone.outline_m)}" if zone.shape == "polygon" else zone.shape
        table.add_row(
            escape(zone.name), shape, where, "all" if zone.altitude_m is None else _range(zone.altitude_m)
        )
    return table


def _vehicle_rows(summary: ScenarioSummary) -> list[tuple[str, str]]:
    scenario = summary.scenario
    receiver, airframe = scenario.receiver, scenario.airframe
    rows = [("maximised", f"the {Quantity.of(scenario).smallest} over the nodes")]
    if scenario.array is not None:
        rows.append(("array", array_words(scenario.array)))
    if airframe is not None:
        rows.append(("airframe", airframe_words(airframe)))
    rows.append(("antenna", f"short dipole, {reach_words(airframe)}"))
    errors = (
        ("attitude error", receiver.attitude_error_deg, "deg"),
        ("position error", receiver.position_error_m, "m"),
    )
    rows += [(name, f"at most {size:g} {unit}") for name, size, unit in errors if size > 0.0]
    if scenario.transmitter is not None:
        power_w = scenario.transmitter.transmit_power_w
        rows.append(("transmits", _power_words(power_w)))
    return [
        *rows,
        ("noise", _power_words(summary.noise_w)),
        ("path gain at 1 m (dB)", f"{summary.reference_gain_db:.2f}"),
    ]


def _power_words(power_w: float) -> str:
    from nullpose.physics import to_db

    return f"{float(to_db(power_w)) + 30.0:.2f} dBm ({power_w:.4g} W)"


def _range(sides: tuple[float, float] | None) -> str:
    return "unbounded" if sides is None else f"{sides[0]:g} to {sides[1]:g}"


def _nodes_table(summary: ScenarioSummary) -> Table:
    nodes = summary.scenario.nodes
    own: dict[str, list[str]] = {}
    if summary.scenario.objective == "secrecy-rate":
        own["noise (dBm)"] = [_decimals(node.noise_dbm) for node in summary.nodes]
    else:
        own["power (dBm)"] = [_decimals(node.power_dbm) for node in summary.nodes]
        own["power (W)"] = [_digits(node.power_w) for node in summary.nodes]
    if any(node.min_sinr_db is not None for node in nodes):
        own["requires (dB)"] = [_digits(node.min_sinr_db) for node in nodes]
    if any(node.weight is not None for node in nodes):
        own["weight"] = [_digits(node.weight) for node in nodes]
    own["closest (m)"] = [_digits(node.nearest_m) for node in summary.nodes]
    own["SNR at best (dB)"] = [_decimals(node.best_ratio_db) for node in summary.nodes]
    return _points_table("Nodes", "node", summary.nodes, own)


def _jammers_table(summary: ScenarioSummary) -> Table:
    jammers = summary.jammers
    own = {
        "power (dBm)": [_decimals(jammer.power_dbm) for jammer in jammers],
        "power (W)": [_digits(jammer.power_w) for jammer in jammers],
    }
    if summary.scenario.objective != "secrecy-rate":
        own["closest (m)"] = [_digits(jammer.nearest_m) for jammer in jammers]
        own["JNR at best (dB)"] = [_decimals(jammer.best_ratio_db) for jammer in jammers]
    return _points_table("Jammers", "jammer", jammers, own | _uncertainty(jammers))


def _eavesdroppers_table(summary: ScenarioSummary) -> Table:
    points = summary.eavesdroppers
    own = {
        "noise (dBm)": [_decimals(point.noise_dbm) for point in points],
        "closest (m)": [_digits(point.nearest_m) for point in points],
        "SNR at best (dB)": [_decimals(point.best_ratio_db) for point in points],
    }
    return _points_table("Eavesdroppers", "eavesdropper", points, own | _uncertainty(points))


def _uncertainty(points: Sequence[PointSummary]) -> dict[str, list[str]]:
    """Return a column with how far each point may be from where it is said to be, if any may."""
    extents = [np.atleast_1d(point.uncertainty_m or 0.0) for point in points]
    if not any(np.any(extent > 0.0) for extent in extents):
        return {}
    return {"uncertainty (m)": [" x ".join(f"{size:g}" for size in extent) for extent in extents]}


def _points_table(title: str, noun: str, points: Sequence[PointSummary], own: dict[str, list[str]]) -> Table:
    from rich.markup import escape

    table = new_table(title, ("x (m)", "y (m)", "z (m)", *own), first=noun)
    for i, point in enumerate(points):
        position = [f"{x:g}" for x in point.position_m]
        table.add_row(escape(point.name), *position, *(cells[i] for cells in own.values()))
    return table


def _decimals(number: float | None) -> str:
    return "-" if number is None else f"{number:.2f}"


def _digits(number: float | None) -> str:
    return "-" if number is None else f"{number:.6g}"
