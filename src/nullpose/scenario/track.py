"""How a ground point moves: evenly, or along a track."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Annotated

from nullpose.files import PlainTable
from nullpose.scenario.faults import ONLY_LOCAL, Place, plain
from nullpose.scenario.rules import MOST_MEMBERS, Limits, ListOf
from nullpose.scenario.units import PLACE_KEYS, Seconds, Speed
from nullpose.scenario.ways import at_most_one

MOTION = at_most_one("velocity_m_s", "track", "track_from")
"""The ways to state how a point moves."""
Velocity = Annotated[
    tuple[Speed, Speed, Speed], ListOf("a list of three numbers [x, y, z]: m/s east, north and up", 3, 3)
]
_Coordinate = Annotated[
    float, Limits("a coordinate in m or degrees", -1e7, 1e7, "[t, x, y, z], or [t, lat, lon, alt]")
]
_Row = Annotated[
    tuple[Seconds, _Coordinate, _Coordinate, _Coordinate],
    ListOf("a list of four numbers [t, x, y, z], in s and m, or [t, lat, lon, alt]", 4, 4),
]
Track = Annotated[
    tuple[_Row, ...], ListOf("a list of rows [t, x, y, z] or [t, lat, lon, alt]", 1, MOST_MEMBERS)
]


def place_of_start(point: Mapping[str, object]) -> list[object] | None:
    """Return the three numbers of the place at which the track of a raw point begins at t = 0, if it does."""
    rows = plain(point.get("track"))
    match plain(rows[0]) if isinstance(rows, list | tuple) and rows else None:
        case [0 | 0.0, int() | float() as x, int() | float() as y, int() | float() as z]:
            return [x, y, z]
    return None


def track_faults(track: Track | None, raw: PlainTable) -> Iterator[tuple[Place, str]]:
    """Yield a track that goes back in time, or begins later than a point whose place is not stated.

    Args:
        track: of a point; None if it has none, or one at fault.
        raw: the raw point.
    """
    if "track_from" in raw and MOTION.taken(raw.keys()) == [("track_from",)]:
        yield ("track_from",), f"{ONLY_LOCAL}; state the track here, as track"
    times_s = [row[0] for row in track or ()]
    if times_s and times_s[0] > 0.0 and not raw.keys() & PLACE_KEYS:
        got = f"the track begins at t = {times_s[0]:g}"
        yield ("track", 0, 0), f"{got}; state the place at t = 0 too: by a row, or as position_m"
    back = [index for index, (earlier_s, later_s) in enumerate(pairwise(times_s), 1) if later_s <= earlier_s]
    for index in back[:1]:
        yield (
            ("track", index, 0),
            f"got t = {times_s[index]:g} after t = {times_s[index - 1]:g}, must be later: a track goes "
            "forward in time; sort the rows, each time once",
        )
