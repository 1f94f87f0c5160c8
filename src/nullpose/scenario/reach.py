"""Whether an airspace has a position for the vehicle, and whether what is uncertain reaches into it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from nullpose.scenario.airspace import Airspace
from nullpose.scenario.arrays import Floats
from nullpose.scenario.ellipsoid import distance_m
from nullpose.scenario.faults import Place, path_of
from nullpose.scenario.ground_points import GroundPoint
from nullpose.scenario.polygon import MOST_CORNERS
from nullpose.scenario.subdivision import find_position
from nullpose.scenario.uncertainty import Uncertain

_MOST_DISTANCES = 6_000_000  # between parts of the airspace and what bounds it, for the time that they take


def airspace_faults(
    airspace: Airspace, points: Mapping[Place, GroundPoint], error_m: float
) -> Iterator[tuple[Place, str]]:
    """Yields what is wrong between the airspace and the ground points, each with its place.

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
            f"its geofence and no-fly zones have {corners} corners, must be at most {MOST_CORNERS} in all; "
            "leave out those that change the areas least",
        )
    elif may_hold_a_position(airspace, centres_m):
        yield from _reach_faults(airspace, points, centres_m, error_m)
    else:
        yield (
            ("airspace",),
            f"every position in it is less than keep_out_m = {airspace.keep_out_m!r} m from a node or "
            "jammer, in a no-fly zone or outside the geofence, or within their margin_m, so there is no room "
            "for the vehicle; widen altitude_m, x_m or y_m, make keep_out_m or a zone smaller, lower "
            "margin_m or move the geofence",
        )


def may_hold_a_position(airspace: Airspace, centres_m: Floats) -> bool:
    """Returns whether there is a position that the airspace allows outside the keep-out balls.

    True to a billionth of the airspace's size, unless it is so intricate that it takes too long to tell,
    which counts as if there were one.

    Args:
        airspace: where the vehicle may be.
        centres_m: the ground points [m], (n, 3).
    """
    fence_m = airspace.geofence_outline_m
    lower_m, upper_m = airspace.lower_m, airspace.upper_m
    if len(fence_m):
        lower_m = np.maximum(lower_m, [*fence_m.min(axis=0), -np.inf])
        upper_m = np.minimum(upper_m, [*fence_m.max(axis=0), np.inf])
    if not (np.isfinite(lower_m).all() and np.isfinite(upper_m).all()):
        return True  # zones and balls end somewhere
    apart_m = np.linalg.norm(centres_m - np.clip(centres_m, lower_m, upper_m), axis=1)
    near_m = centres_m[apart_m < airspace.keep_out_m]
    borders = sum((len(zone.outline_m) for zone in airspace.no_fly), len(fence_m) + len(near_m))
    most = min(60_000, _MOST_DISTANCES // max(1, borders))
    position_m, is_sure = find_position(lower_m, upper_m, lambda at: _clearance_m(airspace, near_m, at), most)
    return position_m is not None or not is_sure


def _reach_faults(
    airspace: Airspace, points: Mapping[Place, GroundPoint], centres_m: Floats, error_m: float
) -> Iterator[tuple[Place, str]]:
    """Yields a fault for every ground point that the vehicle may meet, given what is uncertain.

    That is so if an allowed position is no further from the point's set than the vehicle's own position
    error: the distance may then be zero, at which the model has no limit.
    """
    for place, point in points.items():
        reach_m = point.uncertainty_reach_m if isinstance(point, Uncertain) else 0.0
        total_m = reach_m + error_m
        if total_m == 0.0 or total_m < airspace.keep_out_m:
            continue
        matrix_m = point.uncertainty_matrix_m if isinstance(point, Uncertain) else np.zeros((3, 3))
        half_m = np.sqrt(np.diag(matrix_m @ matrix_m.T)) + error_m
        centre_m = np.asarray(point.position_m)

        def clearance_m(at: Floats, centre_m: Floats = centre_m, matrix_m: Floats = matrix_m) -> Floats:
            inside = error_m - distance_m(at, centre_m, matrix_m)
            return np.asarray(np.minimum(inside, _clearance_m(airspace, centres_m, at)))

        lower_m = np.maximum(airspace.lower_m, centre_m - half_m)
        upper_m = np.minimum(airspace.upper_m, centre_m + half_m)
        met_m, _ = find_position(lower_m, upper_m, clearance_m)
        if met_m is not None:
            yield (
                (*place, "uncertainty_m") if reach_m else ("receiver", "position_error_m"),
                f"the vehicle, up to position_error_m = {error_m:g} from where it is meant to be, may meet "
                f"{path_of(place)}, which is known to within {reach_m:g} m: at "
                f"{[float(f'{x:.4g}') for x in met_m]} for one, inside the airspace; make either smaller, "
                f"keep the airspace away from it, or make keep_out_m more than {total_m:g}",
            )


def _clearance_m(airspace: Airspace, centres_m: Floats, at: Floats) -> Floats:
    nearest_m = np.linalg.norm(at[:, None] - centres_m, axis=-1).min(axis=1, initial=np.inf)
    return np.asarray(np.minimum(airspace.clearance_m(at), nearest_m - airspace.keep_out_m))
