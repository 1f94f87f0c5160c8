"""Changes that a page makes to a scenario: points and zones, typed values, a fence."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import count

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import GROUND_ANTENNAS
from nullpose.report.numbers import MINUS
from nullpose.scenario import (
    Airframe,
    Eavesdropper,
    GroundPoint,
    Jammer,
    Node,
    NoFlyZone,
    Scenario,
    apply_overrides,
)
from nullpose.scenario.overrides import Override, parse_override
from nullpose.studio.state import KINDS, Key, Kind, State

ADDED: dict[str, Kind] = {
    "node": "nodes",
    "jammer": "jammers",
    "eavesdropper": "eavesdroppers",
    "no-fly zone": "no_fly",
}
"""What a click on the ground can add, with the list of the scenario that it goes to."""

_TABLES: dict[Kind, type[GroundPoint] | type[NoFlyZone]] = {
    "nodes": Node,
    "jammers": Jammer,
    "eavesdroppers": Eavesdropper,
    "no_fly": NoFlyZone,
}
# what a new point takes from the last one of its kind
_ALIKE = (
    "power_w",
    "power_dbm",
    "antenna",
    "antenna_axis",
    "null_depth_db",
    "antenna_file",
    "antenna_profile",
    "gain_dbi",
    "noise_w",
    "noise_dbm",
    "bandwidth_hz",
    "noise_figure_db",
)
_ANY = "any"  # typed for a tilt without a limit
_FREE = Override("airframe.preset", "omnidirectional")
_VEHICLE = {
    "airframe.tilt_max_deg": "tilt limit (deg)",
    "airframe.mount_deg": "antenna mount (deg)",
    "airspace.altitude_m[0]": "lowest altitude (m)",
    "airspace.altitude_m[1]": "highest altitude (m)",
    "airspace.geofence_m": "fence corners (m)",
    "airspace.margin_m": "margin to fence, zones (m)",
    "airspace.keep_out_m": "distance to points (m)",
}
_DIRECTIONS = ("east (m)", "north (m)", "up (m)")
_SHAPES = {
    "box": {"x_m": "west, east (m)", "y_m": "south, north (m)"},
    "cylinder": {"centre_m": "centre (m)", "radius_m": "radius (m)"},
    "polygon": {"polygon_m": "corners (m)"},
}


@dataclass(frozen=True, slots=True)
class Entry:
    """One value that can be typed or chosen.

    Args:
        path: where it is in the scenario, as in ``nodes[0].power_w``.
        label: what it is called in the page, with its unit.
        text: the value now; empty if it is not stated.
        options: the values that can be chosen; none if it is typed.
    """

    path: str
    label: str
    text: str
    options: tuple[str, ...] = ()


def with_added(state: State, what: str, place_m: ArrayLike, size_m: float) -> State:
    """Return the state with a point or a zone more, the last of its kind and like the one before.

    Args:
        state: before.
        what: a key of :data:`ADDED`.
        place_m: (2,) where it is on the ground, east and north, metres.
        size_m: of the scene, from which a zone's radius follows.

    Raises:
        ScenarioError: the scenario has no use for it.
    """
    kind = ADDED[what]
    table, members = _TABLES[kind], state.members(kind)
    taken = {member.name for each in KINDS for member in state.members(each)}
    east, north = (round(float(number), 2) for number in np.asarray(place_m))
    values: dict[str, object] = {
        "name": next(name for i in count(1) if (name := f"{table.letter}{i}") not in taken)
    }
    if kind == "no_fly":
        values |= {"centre_m": (east, north), "radius_m": float(f"{0.08 * size_m:.1g}")}
    else:
        alike = (*state.scenario.nodes, *members)[-1]
        values |= {
            key: getattr(alike, key)
            for key in table.model_fields.keys() & type(alike).model_fields.keys() & set(_ALIKE)
        } | {"position_m": (east, north, 0.0)}
    return state.with_members(kind, (*members, table.from_dict(values)))


def without(state: State, key: Key) -> State:
    """Return the state without a point or a zone.

    Args:
        state: before.
        key: which.

    Raises:
        ScenarioError: the scenario needs it.
    """
    kind, index = key
    # the text follows at once: a point that is added later may have the same name, and other comments
    members = [member for i, member in enumerate(state.members(kind)) if i != index]
    return replace(state.with_members(kind, members).written, selected=None)


def with_fence(state: State, corners_m: ArrayLike) -> State:
    """Return the state with another fence.

    Args:
        state: before.
        corners_m: (n, 2) east and north of its corners in order around it, metres.

    Raises:
        ScenarioError: they make no fence.
    """
    corners = tuple((round(float(x), 2), round(float(y), 2)) for x, y in np.asarray(corners_m))
    return state.with_scenario(apply_overrides(state.draft, [Override("airspace.geofence_m", corners)]))


def entries_of(state: State, key: Key | None) -> tuple[Entry, ...]:
    """List the values of a point or a zone that can be typed; of the vehicle and its airspace without one.

    Args:
        state: before.
        key: which, or None.
    """
    if key is None:
        return _vehicle_entries(state.scenario)
    kind, index = key
    member, path = dict(state.points()).get(key, state.members(kind)[index]), _path(key)
    entries = [
        Entry(f"{path}.{key}", label, _text(getattr(member, key)))
        for key, label in ({"name": "name"} | _keys(member)).items()
    ]
    if isinstance(member, NoFlyZone):
        return tuple(entries)
    place = [
        Entry(f"{path}.position_m[{i}]", *each)
        for i, each in enumerate(zip(_DIRECTIONS, map(_text, member.position_m), strict=True))
    ]
    # a profile needs a table, which is not typed
    kinds = tuple(kind for kind in GROUND_ANTENNAS if kind != "profile" or kind == member.antenna)
    return (entries[0], *place, *entries[1:], Entry(f"{path}.antenna", "antenna", member.antenna, kinds))


def _path(key: Key) -> str:
    kind, index = key
    return f"{'airspace.' * (kind == 'no_fly')}{kind}[{index}]".replace("destinations[0]", "destination")


def _keys(member: GroundPoint | NoFlyZone) -> dict[str, str]:
    """Label the keys of a point or a zone that can be typed besides its name and its place."""
    if isinstance(member, NoFlyZone):
        return _SHAPES[member.shape] | {"altitude_m": "altitudes (m)"}
    in_dbm = getattr(member, "power_dbm", None) is not None
    power = {"power_dbm": "power (dBm)"} if in_dbm else {"power_w": "power (W)"}
    keys = power | {"min_sinr_db": "required SINR (dB)", "uncertainty_m": "position error (m)"}
    return {key: label for key, label in keys.items() if key in type(member).model_fields}


def _vehicle_entries(scenario: Scenario) -> tuple[Entry, ...]:
    airframe, airspace = scenario.airframe or Airframe(preset="omnidirectional"), scenario.airspace
    tilt_deg = math.degrees(airframe.tilt_max_rad)
    values = (
        _ANY if tilt_deg >= 180.0 else tilt_deg,
        airframe.mount_deg,
        *airspace.altitude_m,
        airspace.geofence_m,
        airspace.margin_m,
        airspace.keep_out_m,
    )
    return tuple(
        Entry(path, label, _text(value))
        for (path, label), value in zip(_VEHICLE.items(), values, strict=True)
    )


def _text(value: object) -> str:
    """Return a number or a list as it is typed; empty for None."""
    if value is None:
        return ""
    if isinstance(value, tuple):
        return f"[{', '.join(map(_text, value))}]"
    return f"{value + 0.0:.12g}" if isinstance(value, float) else str(value)


def with_typed(state: State, entry: Entry, text: str) -> State:
    """Return the state with a value that was typed.

    Args:
        state: before.
        entry: which value.
        text: what was typed; where it is what it was, nothing changes.

    Raises:
        ScenarioError: the value is not allowed.
    """
    typed, path, scenario = text.strip(), entry.path, state.draft
    if typed == entry.text:
        return state
    for key, _ in state.points():
        if path.startswith(f"{_path(key)}.position_m"):
            state.require_rest(key)
    if path.endswith(
        ".name"
    ):  # by itself in the text, where a point that moves too would be taken for another
        return state.written.with_scenario(apply_overrides(scenario, [Override(path, typed or None)])).written
    if path == "airframe.tilt_max_deg" and typed in ("", _ANY):
        override = _FREE
    elif entry.options or not typed:
        override = Override(path, typed or None)
    else:
        override = parse_override(f"{path}={typed.replace(MINUS, '-')}")
    is_first = path.startswith("airframe.") and scenario.airframe is None
    return state.with_scenario(apply_overrides(scenario, [_FREE, override] if is_first else [override]))
