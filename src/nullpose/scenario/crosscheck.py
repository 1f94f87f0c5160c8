"""Faults between the parts of a scenario, each of which is sound by itself."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.antenna import SHORT_DIPOLE
from nullpose.files import PlainTable
from nullpose.objectives import RECORDS, Custom
from nullpose.scenario.buildings import Building, buried_points
from nullpose.scenario.channel import CustomChannel
from nullpose.scenario.faults import ONLY_LOCAL, Place, faults_of, key_faults, path_of, unknown
from nullpose.scenario.ground_points import SAME_PLACE_M, GroundPoint, Node, Terminal
from nullpose.scenario.motion import LINE, flight_faults, motion_faults
from nullpose.scenario.origin import POINT_LISTS, is_placed, origin_faults
from nullpose.scenario.plausibility import too_small
from nullpose.scenario.reach import airspace_faults
from nullpose.scenario.section import table_of
from nullpose.scenario.units import HALF_DB, MOST_OVER_FED_DB

if TYPE_CHECKING:
    from nullpose.scenario.airspace import Airspace
    from nullpose.scenario.no_fly import NoFlyZone
    from nullpose.scenario.radio import Receiver
    from nullpose.scenario.scenario import Scenario


def scenario_faults(scenario: Scenario, raw: PlainTable) -> Iterator[tuple[Place, str]]:
    """Yield the faults between the values of a scenario, each with its place.

    Two nodes or jammers may be as close as they like, within the keep-out radius too, but not at the
    same place: neither the null nor the directions of a pair would be defined.

    Args:
        scenario: a scenario, in which None stands for what has a fault of its own.
        raw: the raw scenario.
    """
    points: dict[Place, GroundPoint] = {
        (kind, index): point
        for kind in POINT_LISTS
        for index, point in enumerate(getattr(scenario, kind) or ())
        if point is not None
    } | ({} if scenario.destination is None else {("destination",): scenario.destination})
    yield from key_faults(raw, ("nodes_from",), f"{ONLY_LOCAL}, in place of its own nodes; remove it or them")
    airspace: Airspace | None = scenario.airspace
    zones: dict[Place, NoFlyZone] = {
        ("airspace", "no_fly", index): zone
        for index, zone in enumerate(getattr(airspace, "no_fly", None) or ())
    }
    buildings: dict[Place, Building] = {
        ("buildings", index): each for index, each in enumerate(scenario.buildings or ()) if each is not None
    }
    tables = points | buildings | ({} if airspace is None else {("airspace",): airspace}) | zones
    positioned = {place: point for place, point in points.items() if is_placed(point)}
    misplaced = [
        *origin_faults(scenario.origin, tables, raw),
        *too_small(tables, [point.position_m for point in positioned.values()]),
    ]
    yield from misplaced
    moved = list(motion_faults(scenario, points, raw))
    yield from moved
    yield from _objective_faults(scenario, points)
    yield from _source_faults(scenario, points)
    for named in (points, zones, buildings):
        yield from shared_names(named)
    yield from (
        ((*place, "buildings_from"), f"{ONLY_LOCAL}, in place of its own buildings; remove it")
        for place, building in buildings.items()
        if building.buildings_from is not None
    )
    yield from _antenna_faults(scenario, points)
    yield from _gain_faults(scenario, points)
    yield from _channel_faults(scenario, {(): scenario, **points})
    if not misplaced:
        yield from _shared_places(positioned)
    if airspace is not None and not misplaced:
        solid = {at: each for at, each in buildings.items() if each.polygon_m and each.height_m is not None}
        buried = list(buried_points(solid, positioned))
        yield from buried
        if not buried:
            receiver: Receiver | None = scenario.receiver
            outside = airspace.outside(each.zone for each in solid.values())
            yield from airspace_faults(outside, positioned, receiver.position_error_m if receiver else 0.0)
            if not moved:
                yield from flight_faults(scenario, outside, positioned)


def _antenna_faults(scenario: Scenario, points: Mapping[Place, GroundPoint]) -> Iterator[tuple[Place, str]]:
    """Yield what does not go with an array, and dipoles that do not go with the drone's antenna."""
    has_array, antenna = scenario.array is not None, scenario.antenna_record
    is_tilted = scenario.airframe is not None and scenario.axis_band != (1.0, 1.0)
    yield from faults_of(
        (
            has_array and is_tilted,
            ("array",),
            "an array is of upright dipoles on a horizontal vehicle, but [airframe] tilts it or mounts the "
            "dipole at an angle; remove either table",
        ),
        (
            has_array and antenna != SHORT_DIPOLE,
            ("antenna",),
            "the elements of an array are short dipoles; remove this table or [array]",
        ),
    )
    for place, point in points.items():
        yield from faults_of(
            (
                point.antenna == "profile" and isinstance(point.channel or scenario.channel, CustomChannel),
                (*place, "antenna"),
                'antenna = "profile" does not go with a channel that is a function in Python; multiply that '
                'by the gain, or write antenna = "isotropic" with gain_dbi',
            ),
            (
                has_array and point.antenna not in (None, "isotropic"),
                (*place, "antenna"),
                "an array hears isotropic antennas only; remove this key or [array]",
            ),
            (
                point.antenna == "dipole" and not antenna.has_polarisation,
                (*place, "antenna"),
                "a dipole on the ground goes with a dipole on the drone, whose polarisation is known; that "
                f'of antenna.kind = "{antenna.name}" is not; write "circular" or "isotropic"',
            ),
        )


def _gain_faults(scenario: Scenario, points: Mapping[Place, GroundPoint]) -> Iterator[tuple[Place, str]]:
    """Yield the gains that no such antenna has: over the sphere it would radiate more than it is fed."""
    drone, drone_dbi = scenario.antenna_record, scenario.antenna_gain_dbi
    drone_db = drone_dbi + 10.0 * np.log10(max(drone.mean, 1e-30))
    whip = (
        ", a quarter wave over a large ground plane. A collinear whip has more in a narrow beam alone: write "
        'antenna = "profile" with its gain by elevation (antenna_file or antenna_profile)'
    )
    gains = {("antenna",): (drone.label, drone_dbi, drone_db, MOST_OVER_FED_DB, "")} | {
        place: ("short dipole", point.gain_dbi, point.over_fed_db, MOST_OVER_FED_DB + HALF_DB, whip)
        for place, point in points.items()
        if point.antenna == "dipole"
    }
    yield from (
        (
            (*place, "gain_dbi"),
            f"got {gain_dbi:g}, with which a {label} would radiate {excess_db:.1f} dB more than it is fed; "
            f"must be at most {gain_dbi - excess_db + most_db:.2f} (1.76 for a short dipole, 2.15 for a "
            f"half-wave dipole){advice}",
        )
        for place, (label, gain_dbi, excess_db, most_db, advice) in gains.items()
        if excess_db > most_db
    )


def _channel_faults(
    scenario: Scenario, tables: Mapping[Place, Scenario | GroundPoint]
) -> Iterator[tuple[Place, str]]:
    """Yield averages that are missing, and reference distances that do not go with the rest.

    Args:
        scenario: as for ``scenario_faults``.
        tables: those that may have a channel, by their place.
    """
    receiver: Receiver | None = scenario.receiver
    keep_out_m = getattr(scenario.airspace, "keep_out_m", None)
    channels = {place: table.channel for place, table in tables.items() if table.channel is not None}
    for place, channel in channels.items():
        d0_m, key = channel.gain_distance_m, (*place, "channel", "reference_distance_m")
        states_law = bool(channel.exponent or channel.reference_distance_m)  # with no meaning closer than d0
        is_undecided = channel.model == "elevation" and channel.is_by_sight and channel.average is None
        gain_db = 10.0 * np.log10(receiver.reference_gain) - 20.0 * np.log10(d0_m) if receiver else math.nan
        yield from faults_of(
            (
                place and channel.shadow_margin_m is not None,
                (*place, "channel", "shadow_margin_m"),
                "counts for all points; write it in the table [channel]",
            ),
            (
                is_undecided and not scenario.buildings,
                (*place, "channel", "average"),
                'missing, but model = "elevation" needs it: power, db or guaranteed, unless buildings decide '
                "on line of sight; add it",
            ),
            (
                states_law and keep_out_m is not None and d0_m > keep_out_m,
                key,
                f"got {d0_m:g}, must be at most airspace.keep_out_m = {keep_out_m or 0.0:g}: a power law has "
                "no meaning at a shorter distance; make keep_out_m longer",
            ),
            (
                states_law and d0_m != 1.0 and receiver and receiver.frequency_hz is not None,
                key,
                f"got {d0_m:g}, but receiver.frequency_hz gives the gain at 1 m; state the gain at "
                f"{d0_m:g} m in its place, in free space reference_gain_db = {gain_db:.2f}",
            ),
        )


def _objective_faults(scenario: Scenario, points: Mapping[Place, GroundPoint]) -> Iterator[tuple[Place, str]]:
    """Yield what the objective needs and is not given, and what is given and has no meaning under it."""
    if scenario.objective is None:
        return
    record, nodes = scenario.objective_record, len(scenario.nodes or ())
    if isinstance(scenario.objective, Custom) and nodes and (fault := scenario.objective.fault(nodes)):
        yield ("objective",), fault
    yield from (
        (place, f'missing, but objective = "{record.name}" needs {" or ".join(keys)}; add it')
        for need in record.needs
        for place, keys, present in _places_of(need, scenario, points)
        if not present
    )
    yield from (
        (
            place,
            "both weight and min_sinr_db are given, at most one is allowed with objective = "
            f'"{record.name}"; remove either, or maximise a sum of rates or a mean',
        )
        for place, point in points.items()
        if isinstance(point, Terminal) and point.weight is not None and point.min_sinr_db is not None
        if record.mean_offset is None
    )
    without_meaning = {
        other.name: {key for each in other.unused for key in _keys_of(each)} for other in RECORDS.values()
    }
    for unused in record.unused:
        for place in (each for *_, present in _places_of(unused, scenario, points) for each in present):
            others = [f'"{name}"' for name, keys in without_meaning.items() if place[-1] not in keys]
            yield (
                place,
                f'has no meaning with objective = "{record.name}"; remove it, or write objective = '
                f"{' or '.join(others)}",
            )


def _source_faults(scenario: Scenario, points: Mapping[Place, GroundPoint]) -> Iterator[tuple[Place, str]]:
    """Yield the nodes that listen to no source, or to none of several; and an airspace that does not end."""
    sources, airspace = scenario.sources or (), scenario.airspace
    if sources and airspace and not airspace.geofence_m and None in (airspace.x_m, airspace.y_m):
        yield (
            ("airspace",),
            "has no x_m and y_m, and no geofence; with [[sources]] it must have either: the best drone may "
            "be far away, where it jams nobody; add x_m and y_m",
        )
    names = [each.name or f"{each.letter}{i}" for i, each in enumerate(sources, 1) if each is not None]
    for place, node in points.items() if len(names) == len(sources) > 0 else ():
        if not isinstance(node, Node):
            continue
        if node.source_name is None and len(names) > 1:
            yield (
                (*place, "from"),
                f"missing, and there are {len(names)} sources: {', '.join(names)}; add the name of one",
            )
        elif node.source_name is not None and node.source_name not in names:
            yield (
                (*place, "from"),
                f'got "{node.source_name}", an {unknown("source", node.source_name, names)}',
            )


def _keys_of(need: str) -> list[str]:
    """List the keys of a quantity of the nodes, such as ``nodes.power``; of a table its own."""
    quantity = need.partition(".")[2]
    groups = (ways.groups for ways in Node.ways if quantity and ways.groups[0][0].startswith(quantity))
    return [key for group in next(groups, ((quantity or need,),)) for key in group]


def _places_of(
    need: str, scenario: Scenario, points: Mapping[Place, GroundPoint]
) -> Iterator[tuple[Place, Sequence[str], list[Place]]]:
    """Yield each place of a table or a quantity, its keys there, and the places of those present.

    Args:
        need: the key of a table, or a quantity of the nodes, such as ``nodes.power``.
        scenario: as for ``scenario_faults``.
        points: its points by their place.
    """
    kind, _, quantity = need.partition(".")
    if not quantity:
        table = table_of(type(scenario), kind)
        yield (kind,), [table.heading() if table else kind], [(kind,)] if getattr(scenario, kind) else []
    else:
        keys = _keys_of(need)
        yield from (
            (place, keys, [(*place, key) for key in keys if getattr(point, key) is not None])
            for place, point in points.items()
            if place[0] == kind
        )


def shared_names(tables: Mapping[Place, Any]) -> Iterator[tuple[Place, str]]:
    """Yield the tables whose name is that of an earlier one already.

    Args:
        tables: by their place; None is a name that is at fault.
    """
    owners: dict[str, Place] = {}
    for place, table in tables.items():
        # Tables of a faulty scenario are not named by their place yet.
        name = f"{table.letter}{int(place[-1]) + 1}" if table.name == "" else table.name
        if name is not None and owners.setdefault(name, place) != place:
            yield (
                (*place, "name"),
                f'got "{name}", the name of {path_of(owners[name])} already; every name may be used once',
            )


def _shared_places(points: Mapping[Place, GroundPoint]) -> Iterator[tuple[Place, str]]:
    placed = list(points)
    positions_m = np.array([point.position_m for point in points.values()]).reshape(-1, 3)
    if np.all(np.diff(np.sort(positions_m @ LINE)) > 2.0 * SAME_PLACE_M):
        return
    from scipy.spatial import KDTree  # imported here: hardly any scenario has points so close

    pairs = sorted(KDTree(positions_m).query_pairs(SAME_PLACE_M))
    firsts = {
        later: earlier
        for earlier, later in reversed(pairs)
        # Who jams may listen as well: a jammer and an eavesdropper may be at one place.
        if {placed[earlier][0], placed[later][0]} != {"jammers", "eavesdroppers"}
    }
    for later, earlier in firsts.items():
        place, owner = placed[later], placed[earlier]
        yield (
            (*place, "position_m"),
            f"got {positions_m[later].tolist()}, the place of {path_of(owner)} already; "
            f"{' and '.join(dict.fromkeys(str(each[0]) for each in (owner, place)))} must be at "
            "different places; move or remove one",
        )
