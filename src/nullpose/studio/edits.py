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
    Airspace,
    Eavesdropper,
    Jammer,
    Node,
    NoFlyZone,
    Receiver,
    Scenario,
    apply_overrides,
)
from nullpose.scenario.overrides import Override, parse_override
from nullpose.studio.view import KINDS, Key, Kind, View

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


def new_scenario() -> Scenario:
    """Return the scene to build another in: one node, and the paper's noise and altitudes."""
    return Scenario(
        name="New scene",
        airspace=Airspace(altitude_m=(8.0, 30.0)),
        receiver=Receiver(noise_w=1e-3, reference_gain_db=0.0),
        nodes=(Node(name="S1", position_m=(0.0, 0.0, 0.0), power_w=1.0),),
    )


def with_added(view: View, what: str, place_m: ArrayLike, size_m: float) -> View:
    """Return the view with a point or a zone more, the last of its kind and like the one before.

    Args:
        view: the view now.
        what: a key of :data:`ADDED`.
        place_m: (2,) where it is on the ground, east and north, metres.
        size_m: of the scene, from which a zone's radius follows.

    Raises:
        ScenarioError: the scenario has no use for it.
    """
    kind = ADDED[what]
    table, members = _TABLES[kind], view.members(kind)
    taken = {one.name for each in KINDS for one in view.members(each)}
    east, north = (round(float(number), 2) for number in np.asarray(place_m))
    values: dict[str, Any] = {
        "name": next(name for i in count(1) if (name := f"{table.letter}{i}") not in taken)
    }
    if kind == "no_fly":
        values |= {"centre_m": (east, north), "radius_m": float(f"{0.08 * size_m:.1g}")}
    else:
        alike = (*view.scenario.nodes, *members)[-1]
        keys = table.model_fields.keys() & type(alike).model_fields.keys() & set(_ALIKE)
        values |= {key: getattr(alike, key) for key in keys} | {"position_m": (east, north, 0.0)}
    return view.with_members(kind, (*members, table.from_dict(values)))


def without(view: View, key: Key) -> View:
    """Return the view without a point or a zone.

    Args:
        view: the view now.
        key: which.

    Raises:
        ScenarioError: the scenario needs it.
    """
    kind, index = key
    # the text follows at once: a point that is added later may have the same name, and other comments
    return view.with_members(kind, (one for i, one in enumerate(view.members(kind)) if i != index)).written


def with_fence(view: View, corners_m: ArrayLike) -> View:
    """Return the view with another fence.

    Args:
        view: the view now.
        corners_m: (n, 2) east and north of its corners in order around it, metres.

    Raises:
        ScenarioError: they make no fence.
    """
    corners = tuple((round(float(x), 2), round(float(y), 2)) for x, y in np.asarray(corners_m))
    airspace = view.scenario.airspace.model_copy(update={"geofence_m": corners})
    return view.with_scenario(view.scenario.model_copy(update={"airspace": airspace}))


def entries_of(view: View, key: Key | None) -> tuple[Entry, ...]:
    """Return what can be typed of a point or a zone; of the vehicle and its airspace without one.

    Args:
        view: the view now.
        key: which, or None.
    """
    if key is None:
        return tuple(_vehicle_entries(view.scenario))
    kind, index = key
    one, path = view.members(kind)[index], f"{'airspace.' * (kind == 'no_fly')}{kind}[{index}]"
    stated = {"name": "name"} | _keys(one)
    entries = [Entry(f"{path}.{name}", label, _text(getattr(one, name))) for name, label in stated.items()]
    if kind == "no_fly":
        return tuple(entries)
    place = [
        Entry(f"{path}.position_m[{i}]", *each)
        for i, each in enumerate(zip(_DIRECTIONS, map(_text, one.position_m), strict=True))
    ]
    antenna = Entry(f"{path}.antenna", "antenna", one.antenna, tuple(GROUND_ANTENNAS))
    return (entries[0], *place, *entries[1:], antenna)


def _keys(one: Any) -> dict[str, str]:
    """Return what can be typed of a point or a zone besides its name and its place, with labels."""
    if isinstance(one, NoFlyZone):
        return _SHAPES[one.shape] | {"altitude_m": "altitudes (m)"}
    in_dbm = getattr(one, "power_dbm", None) is not None
    power = {"power_dbm": "power (dBm)"} if in_dbm else {"power_w": "power (W)"}
    keys = power | {"min_sinr_db": "required SINR (dB)", "uncertainty_m": "position error (m)"}
    return {key: label for key, label in keys.items() if key in type(one).model_fields}


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


def with_typed(view: View, entries: Iterable[Entry], texts: Mapping[str, str]) -> View:
    """Return the view with the values that were typed.

    Args:
        view: the view now.
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
        if entry.path.startswith("airframe.") and not overrides and view.scenario.airframe is None:
            overrides.append(_FREE)
        if entry.path == "airframe.tilt_max_deg" and typed in ("", _ANY):
            overrides.append(_FREE)
        elif entry.options or not typed or entry.path.endswith(".name"):
            overrides.append(Override(entry.path, typed or None))
        else:
            overrides.append(parse_override(f"{entry.path}={typed.replace(MINUS, '-')}"))
    typed_in = view.with_scenario(apply_overrides(view.scenario, overrides)) if overrides else view
    names = [one for one in overrides if one.path.endswith(".name")]
    if names:  # by itself in the text, where a point that has moved too would be taken for another one
        renamed = view.written.with_scenario(apply_overrides(view.scenario, names)).written
        return replace(typed_in, text=renamed.text)
    return typed_in
