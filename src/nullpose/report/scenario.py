"""What a scenario amounts to before anything is solved: its numbers, and tables of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nullpose.channel.model import BLOCKED, PointChannels, largest_excess_gain
from nullpose.files import PlainTable
from nullpose.objectives import Quantity
from nullpose.physics import to_db
from nullpose.physics.types import FloatArray
from nullpose.problem.build import distances_m
from nullpose.report.document import Row, View, cell, document, head, pairs, rows, table
from nullpose.report.geometry import outline_m
from nullpose.report.words import airframe_words, array_words, channel_words, place_words, reach_words
from nullpose.scenario import (
    Antenna,
    Building,
    Channel,
    Destination,
    Eavesdropper,
    Jammer,
    Node,
    NoFlyZone,
    Origin,
    Scenario,
    Source,
)

_MOST_ROWS = 12  # of buildings; more are told of as one
_Point = Node | Jammer | Eavesdropper | Destination | Source
_EARTHLY = {
    "latitude (deg)": ("lat_deg", 6),
    "longitude (deg)": ("lon_deg", 6),
    "over the ellipsoid (m)": ("alt_m", 2),
    "over the sea (m)": ("alt_msl_m", 2),
}


def summarise(scenario: Scenario) -> PlainTable:
    """Compute a scenario's numbers as plain data: powers in both units, and the most that a link can carry.

    The best a link can do is the drone as close as the airspace's box and the keep-out allow, the dipole
    broadside: ``g0 P h^2 / (d^2 sigma^2)``, paper eq. 2.1 without jamming and with G = 1. Points with a noise
    of their own receive from the drone; any other point transmits to it.
    """
    receiver, transmits = scenario.receiver, scenario.objective_record.transmits
    ends = _points(scenario, scenario.destinations, scenario.destination_noise_w)
    sources = _points(scenario, scenario.sources, None)
    for row in sources:  # the drone does not hear them
        del row["nearest_m"], row["best_power_to_noise_db"]
    return {
        "scenario": scenario.to_dict(),
        "nodes": _points(scenario, scenario.nodes, scenario.node_noise_w if transmits else None),
        "jammers": _points(scenario, scenario.jammers, None),
        "eavesdroppers": _points(scenario, scenario.eavesdroppers, scenario.eavesdropper_noise_w),
        **({"destination": ends[0]} if ends else {}),
        **({"sources": sources} if sources else {}),
        "noise_w": receiver.noise_power_w,
        "noise_dbm": _dbm(receiver.noise_power_w),
        "reference_gain_db": float(to_db(receiver.reference_gain)),
        **({} if scenario.origin is None else {"on_earth": _on_earth(scenario, scenario.origin)}),
    }


def _on_earth(scenario: Scenario, origin: Origin) -> list[PlainTable]:
    """Compute latitudes, longitudes and absolute altitudes of the points and of the areas' extents."""
    airspace = scenario.airspace
    box_m = np.transpose([airspace.x_m, airspace.y_m]) if airspace.x_m and airspace.y_m else np.empty((0, 2))
    areas = [
        ("airspace", box_m, airspace.altitude_m),
        *[("geofence", airspace.geofence_outline_m, airspace.altitude_m)] * (airspace.geofence_m is not None),
        *((zone.name, outline_m(zone), zone.altitude_m) for zone in airspace.no_fly),
    ]
    rows: list[PlainTable] = [
        {"name": point.name} | origin.place(point.position_m) for point in scenario.points
    ]
    for name, outline, altitude_m in areas:
        corners = outline if len(outline) else [(0.0, 0.0)]  # of an airspace without sides
        places = [origin.place([*corner, end]) for corner in corners for end in altitude_m or (0.0,)]
        keys = [key for key in places[0] if (altitude_m if key.startswith("alt") else len(outline))]
        ends = {key: sorted(place[key] for place in places) for key in keys}
        rows.append({"name": name} | {key: [values[0], values[-1]] for key, values in ends.items()})
    return rows


def _dbm(power_w: float) -> float:
    return float(to_db(power_w)) + 30.0


def _points(scenario: Scenario, points: Sequence[_Point], noises_w: FloatArray | None) -> list[PlainTable]:
    """List each point with its power, its noise if it receives from the drone, and its best link."""
    receiver, transmitter, rows = scenario.receiver, scenario.transmitter, []
    places_m = np.reshape([point.position_m for point in points], (-1, 3))
    away_m = distances_m(places_m, scenario.airspace.lower_m, scenario.airspace.upper_m)
    nearest = np.maximum(away_m, scenario.airspace.keep_out_m).tolist()
    for i, (point, nearest_m) in enumerate(zip(points, nearest, strict=True)):
        power_w = getattr(point, "transmit_power_w", None) or None
        sent_w, noise_w, noise = power_w or 0.0, receiver.noise_power_w, {}
        if noises_w is not None and transmitter is not None:
            sent_w, noise_w = transmitter.transmit_power_w, float(noises_w[i])
            noise = {"noise_w": noise_w, "noise_dbm": _dbm(noise_w)}
        channels = PointChannels.of([scenario.channel_of(point)])
        (gain,) = largest_excess_gain(channels, np.array([nearest_m])).tolist()
        ratio = gain * point.largest_gain * scenario.reference_gain * sent_w / nearest_m**2 / noise_w
        rows.append(
            {
                "name": point.name,
                "position_m": list(point.position_m),
                "antenna": _antenna_words(point) or point.antenna,
                "power_w": power_w,
                "power_dbm": None if power_w is None else _dbm(power_w),
                "nearest_m": nearest_m,
                "best_power_to_noise_db": float(to_db(ratio)),
                **noise,
            }
        )
    return rows


def scenario_view(scenario: Scenario) -> View:
    """Set a scenario's points, airspace and vehicle as tables, with the most that each link can carry."""
    numbers, transmits = summarise(scenario), scenario.objective_record.transmits
    links = [*numbers["nodes"], *filter(None, [numbers.get("destination")])]
    best = (
        "Nearest, highest: the drone as near as the airspace and the keep-out radius (around every point) "
        f"allow, zones and fence ignored, at the largest gain{'' if transmits else '; SNR without jamming'}."
    )
    notes = [
        f"{type(node).__name__} {node.name} requires more than the highest ratio of its link."
        for node, link in zip(scenario.terminals, links, strict=True)
        if node.min_sinr_db is not None and node.min_sinr_db > link["best_power_to_noise_db"]
    ]
    if scenario.is_uncertain:
        notes.append("Errors and uncertainty are used for guaranteed values only.")
    zones = [_zone_row(zone) for zone in scenario.airspace.no_fly]
    return document(
        head(scenario.name),
        "",
        pairs("Airspace", _airspace_rows(scenario).items()),
        table("No-fly zones", zones, left=("shape", "where (m)", "altitude (m)")),
        table("Buildings", _building_rows(scenario.buildings), left=("where (m)",)),
        pairs("Vehicle and receiver", _vehicle_rows(scenario).items()),
        table("Latitude and longitude", _place_rows(numbers.get("on_earth", ()))),
        _points_table("node", scenario.nodes, numbers["nodes"], "highest SNR (dB)"),
        _points_table(
            "jammer", scenario.jammers, numbers["jammers"], "" if transmits else "highest JNR (dB)"
        ),
        _points_table("eavesdropper", scenario.eavesdroppers, numbers["eavesdroppers"], "highest SNR (dB)"),
        _points_table("source", scenario.sources, numbers.get("sources", []), ""),
        _points_table("destination", scenario.destinations, links[len(scenario.nodes) :], "highest SNR (dB)"),
        "\n".join([best, *notes]),
    )


def _airspace_rows(scenario: Scenario) -> dict[str, str | None]:
    airspace, fence_m = scenario.airspace, scenario.airspace.geofence_outline_m
    return {
        "origin": None if scenario.origin is None else place_words(scenario.origin),
        "altitude (m)": _range(airspace.altitude_m, ""),
        "x, east (m)": _range(airspace.x_m, "unbounded"),
        "y, north (m)": _range(airspace.y_m, "unbounded"),
        "geofence": f"{len(fence_m)} corners, {_extent_words(fence_m)}" if len(fence_m) else None,
        "margin to fence, zones (m)": f"{airspace.margin_m:g}" if airspace.margin_m else None,
        "keep-out radius (m)": f"{airspace.keep_out_m:g}",
    }


def _range(sides: tuple[float, float] | None, otherwise: str) -> str:
    return otherwise if sides is None else f"{sides[0]:g} to {sides[1]:g}"


def _extent_words(outline_m: FloatArray) -> str:
    (west, south), (east, north) = outline_m.min(axis=0), outline_m.max(axis=0)
    return f"x {west:g} to {east:g}, y {south:g} to {north:g}"


def _zone_row(zone: NoFlyZone) -> dict[str, str]:
    centre = zone.centre_m and f"centre {zone.centre_m[0]:g}, {zone.centre_m[1]:g}, radius {zone.radius_m:g}"
    corners = f" of {len(zone.outline_m)}" if zone.shape == "polygon" else ""
    return {
        "zone": zone.name,
        "shape": f"{zone.shape}{corners}",
        "where (m)": centre or _extent_words(zone.outline_m),
        "altitude (m)": _range(zone.altitude_m, "all"),
    }


def _building_rows(buildings: Sequence[Building]) -> list[Row]:
    """Set a row for each building; of many, one for all of them."""
    if not buildings:
        return []
    names = [building.name for building in buildings]
    groups: list[Sequence[Building]] = [(building,) for building in buildings]
    if len(buildings) > _MOST_ROWS:
        names, groups = [f"all {len(buildings)}"], [buildings]
    outlines_m = [np.vstack([building.outline_m for building in group]) for group in groups]
    roofs_m = [[height_m for building in group for height_m in building.heights_m] for group in groups]
    bases_m = [[building.base_m for building in group] for group in groups]
    return rows(
        {
            "building": names,
            "where (m)": [_extent_words(outline_m) for outline_m in outlines_m],
            "height (m)": [_between(values) for values in roofs_m],
            "base (m)": [_between(values) if any(values) else None for values in bases_m],
        }
    )


def _between(values: Sequence[float]) -> str:
    low, high = min(values), max(values)
    return f"{low:g}" if low == high else _range((low, high), "")


def _vehicle_rows(scenario: Scenario) -> dict[str, str | None]:
    receiver, airframe, array = scenario.receiver, scenario.airframe, scenario.array
    attitude_deg, position_m = receiver.attitude_error_deg, receiver.position_error_m
    sender, distance_m = scenario.transmitter, (scenario.channel or Channel()).gain_distance_m
    left = [scenario.channel_of(point).row[BLOCKED] for point in scenario.points]
    blocked = {
        "loss of a blocked link (dB)": _between(np.round(-to_db(left), 6).tolist()),
        "margin of shadows (m)": f"{scenario.prisms.margin_m:g}" if scenario.prisms else None,
    }
    return {
        "maximised": f"the {Quantity.of(scenario).smallest_over}",
        "array": None if array is None else array_words(array),
        "airframe": None if airframe is None else airframe_words(airframe),
        "antenna": f"{scenario.antenna_record.label}{_gain_words(scenario.antenna)}, {reach_words(airframe)}",
        "attitude error": f"at most {attitude_deg:g} deg" if attitude_deg else None,
        "position error": f"at most {position_m:g} m" if position_m else None,
        "transmits": None if sender is None else _power_words(sender.transmit_power_w),
        "noise": _power_words(receiver.noise_power_w),
        f"path gain at {distance_m:g} m (dB)": f"{to_db(receiver.reference_gain):.2f}",
        "channel": channel_words(scenario),
        **({} if scenario.prisms is None else blocked),
    }


def _power_words(power_w: float) -> str:
    return f"{_dbm(power_w):.2f} dBm ({power_w:.4g} W)"


def _place_rows(places: Sequence[PlainTable]) -> list[Row]:
    """Set a row for each point and for each area on the Earth, of which both ends are given."""
    columns: dict[str, list[str | None]] = {"": [place["name"] for place in places]}
    for heading, (key, digits) in _EARTHLY.items():
        ends = [place.get(key) for place in places]
        ends = [end if end is None or isinstance(end, list) else [end] for end in ends]
        columns[heading] = [end and "\nto ".join(f"{x:z.{digits}f}" for x in end) for end in ends]
    return rows(columns)


def _points_table(
    noun: str, points: Sequence[_Point], numbers: Sequence[PlainTable], best: str
) -> View | None:
    """Set a row for each point: what points of its kind state, and what its link carries at best."""
    words = [_antenna_words(point) for point in points]
    antennas = words if any(words) else []  # beside which one unit of power has to do
    columns: dict[str, Sequence[str | None]] = {
        noun: [point.name for point in points],
        **{f"{axis} (m)": [f"{point.position_m[i]:g}" for point in points] for i, axis in enumerate("xyz")},
        "noise (dBm)": [cell(each.get("noise_dbm"), ".2f") for each in numbers],
        "power (dBm)": [cell(each["power_dbm"], ".2f") for each in numbers],
        "power (W)": [None if antennas else cell(each["power_w"], ".6g") for each in numbers],
        "antenna": antennas or [None] * len(points),
        "from": [getattr(point, "source_name", None) for point in points],
        "requires (dB)": [cell(getattr(point, "min_sinr_db", None), ".6g") for point in points],
        "weight": [cell(getattr(point, "weight", None), ".6g") for point in points],
        "uncertainty (m)": [
            f"{radius_m:g}" if (radius_m := getattr(point, "uncertainty_m", None)) else None
            for point in points
        ],
    }
    if best:
        columns["nearest (m)"] = [cell(each["nearest_m"], ".6g") for each in numbers]
        columns[best] = [cell(each["best_power_to_noise_db"], ".2f") for each in numbers]
    return table(f"{noun.capitalize()}{'s' * (noun != 'destination')}", rows(columns))


def _antenna_words(point: _Point) -> str | None:
    """Describe a point's antenna, how it lies and its gain; None for an isotropic one of 0 dBi."""
    axis = "" if point.antenna_axis is None else f" along {', '.join(f'{x:g}' for x in point.antenna_axis)}"
    null = "" if point.null_depth_db is None else f", null of {point.null_depth_db:g} dB"
    words = f"{point.antenna}{axis}{null}{_gain_words(point)}"
    return None if words == "isotropic" else words


def _gain_words(antenna: _Point | Antenna | None) -> str:
    """Write an antenna's gain after a comma, nothing where it is 0 dBi."""
    dbi = 0.0 if antenna is None else getattr(antenna, "peak_dbi", antenna.gain_dbi)
    return "" if dbi == 0.0 else f", {dbi:g} dBi"
