"""Whether an airspace has a position for the vehicle, and whether what is uncertain reaches into it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial

import numpy as np

from nullpose.scenario.airspace import Airspace
from nullpose.scenario.faults import Place, path_of
from nullpose.scenario.ground_points import GroundPoint
from nullpose.scenario.polygon import MOST_CORNERS
from nullpose.scenario.radio import Uncertain
from nullpose.scenario.section import Floats

_TOUCHING = 1e-9  # relative to the box; a part this small that cannot be ruled out counts as found
_BATCH = 256


def find_position(
    lower_m: Floats, upper_m: Floats, clearance_m: Callable[[Floats], Floats], most_parts: int = 60_000
) -> tuple[Floats | None, bool]:
    """Find a position [m] in a box at which a clearance is not negative, or None; and whether that is sure.

    A clearance may change by no more than the distance gone (distances from sets do, and the least of
    several). So a part of the box whose middle has a clearance below minus its half diagonal holds no such
    position. The parts with the greatest clearance are halved first, across their longest side.

    Args:
        lower_m: lower corner of the box [m], (3,), finite.
        upper_m: upper corner [m], (3,), finite.
        clearance_m: from positions [m], (n, 3), to clearances [m], (n,).
        most_parts: parts that are looked at before it gives up.
    """
    if (lower_m > upper_m).any():
        return None, True
    smallest_m = _TOUCHING * (1.0 + np.abs([lower_m, upper_m]).max())
    parts = 0.5 * np.array([[lower_m + upper_m, upper_m - lower_m]])  # middles and half sides, (n, 2, 3)
    clearances = clearance_m(parts[:, 0])
    looked_at = 1
    while True:
        kept = np.flatnonzero(clearances >= -np.linalg.norm(parts[:, 1], axis=1))
        order = kept[np.argsort(-clearances[kept], kind="stable")]
        parts, clearances = parts[order], clearances[order]
        if not len(parts):
            return None, True
        if clearances[0] >= 0.0 or parts[0, 1].max() <= smallest_m:
            return parts[0, 0], True
        if looked_at > most_parts:
            return None, False
        halved = _halved(parts[:_BATCH])
        looked_at += len(halved)
        parts = np.concatenate([halved, parts[_BATCH:]])
        clearances = np.concatenate([clearance_m(halved[:, 0]), clearances[_BATCH:]])


def _halved(parts: Floats) -> Floats:
    """Return both halves of each part, cut across its longest side."""
    middles, halves = parts[:, 0], parts[:, 1]
    steps = np.where(np.arange(3) == halves.argmax(axis=1)[:, None], 0.5 * halves, 0.0)
    return np.concatenate([np.stack([middles + s * steps, halves - steps], axis=1) for s in (-1.0, 1.0)])


_MOST_DISTANCES = 6_000_000  # between parts of the airspace and what bounds it, for the time that they take


def airspace_faults(
    airspace: Airspace, points: Mapping[Place, GroundPoint], error_m: float
) -> Iterator[tuple[Place, str]]:
    """Yield what is wrong between the airspace and the ground points, each with its place.

    Args:
        airspace: where the vehicle is meant to be.
        points: all the ground points by their place.
        error_m: how far the vehicle may be from where it is meant to be [m].
    """
    centres_m = np.array([point.position_m for point in points.values()], dtype=np.float64).reshape(-1, 3)
    corners = sum(max(1, len(zone.outline_m)) for zone in airspace.no_fly if airspace.reached(zone))
    corners += len(airspace.geofence_outline_m)
    if corners > MOST_CORNERS:
        yield (
            ("airspace",),
            f"its geofence, no-fly zones and buildings have {corners} corners, must be at most "
            f"{MOST_CORNERS} in all; leave out those that change the areas least, or bound x_m and y_m",
        )
    elif may_hold_a_position(airspace, centres_m):
        yield from _reach_faults(airspace, points, centres_m, error_m)
    else:
        yield (
            ("airspace",),
            f"every position in it is less than keep_out_m = {airspace.keep_out_m!r} m from a node or "
            "jammer, in a no-fly zone or a building, or outside the geofence, or within their margin_m, so "
            "there is no room for the vehicle; widen altitude_m, x_m or y_m, make keep_out_m or a zone "
            "smaller, lower margin_m or move the geofence",
        )


def may_hold_a_position(airspace: Airspace, centres_m: Floats) -> bool:
    """Check for a position that the airspace allows outside the keep-out balls.

    True to a billionth of the airspace's size, unless it is so intricate that it takes too long to tell,
    which counts as if there were one.

    Args:
        airspace: where the vehicle may be.
        centres_m: the ground points [m], (n, 3).
    """
    lower_m, upper_m = airspace.box_m
    if not (np.isfinite(lower_m).all() and np.isfinite(upper_m).all()):
        return True  # zones and balls end somewhere
    apart_m = np.linalg.norm(centres_m - np.clip(centres_m, lower_m, upper_m), axis=1)
    near_m = centres_m[apart_m < airspace.keep_out_m]
    outlines = [airspace.geofence_outline_m, *(zone.outline_m for zone in airspace.no_fly)]
    most = min(60_000, _MOST_DISTANCES // max(1, sum(map(len, outlines), len(near_m))))
    free_m = partial(free_distance_m, airspace, near_m)
    position_m, is_sure = find_position(lower_m, upper_m, free_m, most)
    return position_m is not None or not is_sure


def _reach_faults(
    airspace: Airspace, points: Mapping[Place, GroundPoint], centres_m: Floats, error_m: float
) -> Iterator[tuple[Place, str]]:
    """Yield a fault for every ground point that the vehicle may meet, given what is uncertain.

    That is so if an allowed position is no further from the point's set than the vehicle's own position
    error: the distance may then be zero, at which the model has no limit.
    """
    for place, point in points.items():
        reach_m = point.uncertainty_reach_m if isinstance(point, Uncertain) else 0.0
        if (total_m := reach_m + error_m) == 0.0 or total_m < airspace.keep_out_m:
            continue
        centre_m = np.asarray(point.position_m)

        def clearance_m(at: Floats, centre_m: Floats = centre_m, total_m: float = total_m) -> Floats:
            inside = total_m - np.linalg.norm(at - centre_m, axis=1)
            return np.asarray(np.minimum(inside, free_distance_m(airspace, centres_m, at)))

        lower_m = np.maximum(airspace.lower_m, centre_m - total_m)
        met_m, _ = find_position(lower_m, np.minimum(airspace.upper_m, centre_m + total_m), clearance_m)
        if met_m is not None:
            yield (
                (*place, "uncertainty_m") if reach_m else ("receiver", "position_error_m"),
                f"the vehicle, up to position_error_m = {error_m:g} from where it is meant to be, may meet "
                f"{path_of(place)}, which is known to within {reach_m:g} m: at "
                f"{[float(f'{x:.4g}') for x in met_m]} for one, inside the airspace; make either smaller, "
                f"keep the airspace away from it, or make keep_out_m more than {total_m:g}",
            )


def free_distance_m(airspace: Airspace, centres_m: Floats, at: Floats) -> Floats:
    """Measure distances from what is forbidden, the keep-out balls too [m], below 0 inside, (n,).

    Args:
        airspace: where the vehicle may be.
        centres_m: the ground points [m], (m, 3).
        at: positions [m], (n, 3).
    """
    nearest_m = np.linalg.norm(at[:, None] - centres_m, axis=-1).min(axis=1, initial=np.inf)
    return np.asarray(np.minimum(airspace.clearance_m(at), nearest_m - airspace.keep_out_m))
