"""A scenario as tables for a terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics import to_db
from nullpose.report.airframe import airframe_words, array_words, reach_words
from nullpose.report.document import document, head, pairs, table
from nullpose.report.frames import place_words
from nullpose.report.summary import PointSummary, ScenarioSummary
from nullpose.report.tables import stated_cells
from nullpose.scenario import NoFlyZone, Scenario

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["scenario_view"]

_Cells = Mapping[str, Sequence[str]]


def scenario_view(summary: ScenarioSummary) -> RenderableType:
    """Return a scenario's points, airspace, vehicle and receiver, with what the links can carry at best.

    Args:
        summary: the scenario's numbers.
    """
    scenario = summary.scenario
    return document(
        head(scenario.name),
        "",
        pairs("Airspace", _airspace_rows(scenario)),
        table(
            "No-fly zones",
            [_zone_row(zone) for zone in scenario.airspace.no_fly],
            left=("shape", "where (m)", "altitude (m)"),
        ),
        pairs("Vehicle and receiver", _vehicle_rows(summary)),
        _points_table("node", summary.nodes, _node_cells(summary)),
        _points_table("jammer", summary.jammers, _jammer_cells(summary)),
        _points_table("eavesdropper", summary.eavesdroppers, _eavesdropper_cells(summary)),
        None if summary.jammers or summary.eavesdroppers else "No jammers.",
        "\n".join(_notes(summary)),
    )


def _notes(summary: ScenarioSummary) -> list[str]:
    scenario = summary.scenario
    bounded = scenario.airspace.no_fly or scenario.airspace.geofence_m is not None
    room = " (zones and fence not counted)" if bounded else ""
    jamming = ", no jamming"
    if scenario.objective == "secrecy-rate":
        jamming = ", jamming as it is" if scenario.jammers else ""
    notes = [
        f"At best: as close as the airspace and the keep-out allow{room}, the dipole broadside{jamming}.",
        *(f"Node {name} requires more than its link carries at best." for name in summary.beyond_reach),
    ]
    if scenario.is_uncertain:
        notes.append("Errors and uncertainty count where a guaranteed value is asked for, not otherwise.")
    return notes


def _airspace_rows(scenario: Scenario) -> list[tuple[str, str]]:
    airspace, rows = scenario.airspace, []
    if scenario.origin is not None:
        rows.append(("origin", place_words(scenario.origin)))
    rows.append(("altitude (m)", _range(airspace.altitude_m)))
    rows.append(("x, east (m)", _range(airspace.x_m)))
    rows.append(("y, north (m)", _range(airspace.y_m)))
    if airspace.geofence_m is not None:
        outline_m = airspace.geofence_outline_m
        rows.append(("geofence", f"{len(outline_m)} corners, {_extent_words(outline_m)}"))
    return [*rows, ("keep-out radius (m)", f"{airspace.keep_out_m:g}")]


def _extent_words(outline_m: np.ndarray) -> str:
    (west, south), (east, north) = outline_m.min(axis=0), outline_m.max(axis=0)
    return f"x {west:g} to {east:g}, y {south:g} to {north:g}"


def _zone_row(zone: NoFlyZone) -> dict[str, str]:
    if zone.centre_m is not None:
        where = f"centre {zone.centre_m[0]:g}, {zone.centre_m[1]:g}, radius {zone.radius_m:g}"
    else:
        where = _extent_words(zone.outline_m)
    return {
        "zone": zone.name,
        "shape": f"polygon of {len(zone.outline_m)}" if zone.shape == "polygon" else zone.shape,
        "where (m)": where,
        "altitude (m)": "all" if zone.altitude_m is None else _range(zone.altitude_m),
    }


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
        rows.append(("transmits", _power_words(scenario.transmitter.transmit_power_w)))
    return [
        *rows,
        ("noise", _power_words(summary.noise_w)),
        ("path gain at 1 m (dB)", f"{summary.reference_gain_db:.2f}"),
    ]


def _power_words(power_w: float) -> str:
    return f"{float(to_db(power_w)) + 30.0:.2f} dBm ({power_w:.4g} W)"


def _range(sides: tuple[float, float] | None) -> str:
    return "unbounded" if sides is None else f"{sides[0]:g} to {sides[1]:g}"


def _node_cells(summary: ScenarioSummary) -> _Cells:
    nodes, points = summary.scenario.nodes, summary.nodes
    rate = summary.scenario.objective == "secrecy-rate"
    return {
        **(_noise(points) if rate else _power(points)),
        **stated_cells("requires (dB)", [node.min_sinr_db for node in nodes]),
        **stated_cells("weight", [node.weight for node in nodes]),
        **_at_best("SNR", points),
    }


def _jammer_cells(summary: ScenarioSummary) -> _Cells:
    points = summary.jammers
    reach = {} if summary.scenario.objective == "secrecy-rate" else _at_best("JNR", points)
    return {**_power(points), **reach, **_uncertainty(points)}


def _eavesdropper_cells(summary: ScenarioSummary) -> _Cells:
    points = summary.eavesdroppers
    return {**_noise(points), **_at_best("SNR", points), **_uncertainty(points)}


def _noise(points: Sequence[PointSummary]) -> _Cells:
    return {"noise (dBm)": [_decimals(point.noise_dbm) for point in points]}


def _power(points: Sequence[PointSummary]) -> _Cells:
    return {
        "power (dBm)": [_decimals(point.power_dbm) for point in points],
        "power (W)": ["-" if point.power_w is None else f"{point.power_w:.6g}" for point in points],
    }


def _at_best(ratio: str, points: Sequence[PointSummary]) -> _Cells:
    return {
        "closest (m)": [f"{point.nearest_m:.6g}" for point in points],
        f"{ratio} at best (dB)": [_decimals(point.best_ratio_db) for point in points],
    }


def _uncertainty(points: Sequence[PointSummary]) -> _Cells:
    """Return a column with how far each point may be from where it is said to be, if any may."""
    extents = [np.atleast_1d(point.uncertainty_m or 0.0) for point in points]
    if not any(np.any(extent > 0.0) for extent in extents):
        return {}
    return {"uncertainty (m)": [" x ".join(f"{size:g}" for size in extent) for extent in extents]}


def _points_table(noun: str, points: Sequence[PointSummary], own: _Cells) -> RenderableType | None:
    rows = []
    for i, point in enumerate(points):
        place = {f"{axis} (m)": f"{at:g}" for axis, at in zip("xyz", point.position_m, strict=True)}
        rows.append({noun: point.name, **place, **{heading: cells[i] for heading, cells in own.items()}})
    return table(f"{noun.capitalize()}s", rows)


def _decimals(number: float | None) -> str:
    return "-" if number is None else f"{number:.2f}"
