"""Changes that a page makes to a scenario: points and zones, typed values, a fence."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import GROUND_ANTENNAS
from nullpose.report.numbers import MINUS
from nullpose.scenario import (
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

_TABLES: dict[Kind, Any] = {
    "nodes": Node,
    "jammers": Jammer,
    "eavesdroppers": Eavesdropper,
    "no_fly": NoFlyZone,
}
_ALIKE = (
    "power_w",
    "power_dbm",
    "antenna",
    "antenna_axis",
    "null_depth_db",
    "gain_dbi",
    "noise_w",
    "noise_dbm",
)  # to the last of its kind
_ANY = "any"  # typed for a tilt without a limit
_FREE = Override("airframe.preset", "omnidirectional")
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
    values: dict[str, Any] = {
        "name": next(name for i in count(1) if (name := f"{table.letter}{i}") not in taken)
    }
    if kind == "no_fly":
        values |= {"centre_m": (east, north), "radius_m": float(f"{0.08 * size_m:.1g}")}
    else:
        alike = (*state.scenario.nodes, *members)[-1]
        keys = table.model_fields.keys() & type(alike).model_fields.keys() & set(_ALIKE)
        values |= {key: getattr(alike, key) for key in keys} | {"position_m": (east, north, 0.0)}
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
    airspace = state.scenario.airspace.model_copy(update={"geofence_m": corners})
    return state.with_scenario(state.scenario.model_copy(update={"airspace": airspace}))


def entries_of(state: State, key: Key | None) -> tuple[Entry, ...]:
    """List the values of a point or a zone that can be typed; of the vehicle and its airspace without one.

    Args:
        state: before.
        key: which, or None.
    """
    if key is None:
        return tuple(_vehicle_entries(state.scenario))
    kind, index = key
    member, path = state.members(kind)[index], f"{'airspace.' * (kind == 'no_fly')}{kind}[{index}]"
    labels = {"name": "name"} | _keys(member)
    entries = [Entry(f"{path}.{key}", label, _text(getattr(member, key))) for key, label in labels.items()]
    if kind == "no_fly":
        return tuple(entries)
    place = [
        Entry(f"{path}.position_m[{i}]", *each)
        for i, each in enumerate(zip(_DIRECTIONS, map(_text, member.position_m), strict=True))
    ]
    antenna = Entry(f"{path}.antenna", "antenna", member.antenna, tuple(GROUND_ANTENNAS))
    return (entries[0], *place, *entries[1:], antenna)


def _keys(member: GroundPoint | NoFlyZone) -> dict[str, str]:
    """Label the keys of a point or a zone that can be typed besides its name and its place."""
    if isinstance(member, NoFlyZone):
        return _SHAPES[member.shape] | {"altitude_m": "altitudes (m)"}
    in_dbm = getattr(member, "power_dbm", None) is not None
    power = {"power_dbm": "power (dBm)"} if in_dbm else {"power_w": "power (W)"}
    keys = power | {"min_sinr_db": "required SINR (dB)", "uncertainty_m": "position error (m)"}
    return {key: label for key, label in keys.items() if key in type(member).model_fields}


def _vehicle_entries(scenario: Scenario) -> Iterator[Entry]:
    airframe, airspace = scenario.airframe, scenario.airspace
    tilt_deg = 180.0 if airframe is None else math.degrees(airframe.tilt_max_rad)
    yield Entry("airframe.tilt_max_deg", "tilt limit (deg)", _ANY if tilt_deg >= 180.0 else _text(tilt_deg))
    yield Entry("airframe.mount_deg", "antenna mount (deg)", _text(airframe.mount_deg if airframe else 0.0))
    for i, label in enumerate(("lowest altitude (m)", "highest altitude (m)")):
        yield Entry(f"airspace.altitude_m[{i}]", label, _text(airspace.altitude_m[i]))
    yield Entry("airspace.geofence_m", "fence corners (m)", _text(airspace.geofence_m))
    yield Entry("airspace.margin_m", "margin to fence, zones (m)", _text(airspace.margin_m))
    yield Entry("airspace.keep_out_m", "distance to points (m)", _text(airspace.keep_out_m))


def _text(value: Any) -> str:
    """Return a number or a list as it is typed; empty for None."""
    if value is None:
        return ""
    if isinstance(value, tuple):
        return f"[{', '.join(map(_text, value))}]"
    return f"{value + 0.0:.12g}" if isinstance(value, float) else str(value)


def with_typed(state: State, entries: Iterable[Entry], texts: Mapping[str, str]) -> State:
    """Return the state with the values that were typed.

    Args:
        state: before.
        entries: what could be typed.
        texts: what was, by path; where it is what it was, nothing changes.

    Raises:
        ScenarioError: with every value that is not allowed.
    """
    overrides: list[Override] = []
    for entry in entries:
        typed = texts.get(entry.path, entry.text).strip()
        if typed == entry.text:
            continue
        if entry.path.startswith("airframe.") and not overrides and state.scenario.airframe is None:
            overrides.append(_FREE)
        if entry.path == "airframe.tilt_max_deg" and typed in ("", _ANY):
            overrides.append(_FREE)
        elif entry.options or not typed or entry.path.endswith(".name"):
            overrides.append(Override(entry.path, typed or None))
        else:
            overrides.append(parse_override(f"{entry.path}={typed.replace(MINUS, '-')}"))
    typed_in = state.with_scenario(apply_overrides(state.scenario, overrides)) if overrides else state
    names = [override for override in overrides if override.path.endswith(".name")]
    if names:  # by itself in the text, where a point that has moved too would be taken for another one
        renamed = state.written.with_scenario(apply_overrides(state.scenario, names)).written
        return replace(typed_in, text=renamed.text)
    return typed_in
