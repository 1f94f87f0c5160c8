"""Whether an airspace has room, and whether what is uncertain reaches into it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.scenario.airspace import Airspace
from nullpose.scenario.ellipsoid import distance_m
from nullpose.scenario.faults import Place, path_of
from nullpose.scenario.room import has_room
from nullpose.scenario.subdivision import find_position
from nullpose.scenario.wording import listed

__all__ = ["Known", "has_any_room", "reach_faults"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Known:
    """What is known of where a ground point is.

    Args:
        place: where it stands in the scenario.
        position_m: its stated position [m], (3,).
        matrix_m: the matrix A [m], (3, 3), of the set ``{position + A x : |x| <= 1}`` that it is in.
        reach_m: the set's greatest half-width [m].
    """

    place: Place
    position_m: Array
    matrix_m: Array
    reach_m: float


def has_any_room(airspace: Airspace, points: Sequence[Known]) -> bool:
    """Returns whether there is a position that the airspace allows outside the keep-out balls.

    Exact for a box, and to a billionth of the box's size with zones or a fence, unless these are so intricate
    that it takes too long to tell, which counts as room.

    Args:
        airspace: where the vehicle may be.
        points: all the ground points.
    """
    centres_m = np.array([point.position_m for point in points], dtype=np.float64).reshape(-1, 3)
    lower_m, upper_m = airspace.lower_m, airspace.upper_m
    fence_m = airspace.geofence_outline_m
    if not len(fence_m) and not airspace.no_fly:
        return has_room(lower_m, upper_m, centres_m, airspace.keep_out_m)
    if len(fence_m):
        lower_m = np.maximum(lower_m, [*fence_m.min(axis=0), -np.inf])
        upper_m = np.minimum(upper_m, [*fence_m.max(axis=0), np.inf])
    if not (np.isfinite(lower_m).all() and np.isfinite(upper_m).all()):
        return True  # zones and balls end somewhere
    corners = sum((len(zone.outline_m) for zone in airspace.no_fly), len(fence_m))
    most = min(60_000, 6_000_000 // max(1, corners))
    found = find_position(lower_m, upper_m, lambda at: _clearance_m(airspace, centres_m, at), most)
    return found.position_m is not None or not found.settled


def reach_faults(airspace: Airspace, points: Sequence[Known], error_m: float) -> Iterator[tuple[Place, str]]:
    """Yields a fault for every ground point that the vehicle may meet, given what is uncertain.

    That is so if an allowed position is no further from the point's set than the vehicle's own position
    error: the distance may then be zero, at which the model has no limit.

    Args:
        airspace: where the vehicle is meant to be.
        points: all the ground points.
        error_m: how far the vehicle may be from where it is meant to be [m].
    """
    centres_m = np.array([point.position_m for point in points], dtype=np.float64).reshape(-1, 3)
    exact = []
    for point in points:
        total_m = point.reach_m + error_m
        if total_m == 0.0 or total_m < airspace.keep_out_m:
            continue
        half_m = np.sqrt(np.diag(point.matrix_m @ point.matrix_m.T)) + error_m

        def clearance_m(at: Array, point: Known = point) -> Array:
            inside = error_m - distance_m(at, point.position_m, point.matrix_m)
            return np.asarray(np.minimum(inside, _clearance_m(airspace, centres_m, at)))

        lower_m = np.maximum(airspace.lower_m, point.position_m - half_m)
        upper_m = np.minimum(airspace.upper_m, point.position_m + half_m)
        met_m = find_position(lower_m, upper_m, clearance_m).position_m
        if met_m is None:
            continue
        if point.reach_m == 0.0:
            exact.append(path_of(point.place))
            continue
        slack = f", with position_error_m = {error_m:g}," if error_m else ""
        message = (
            f"the positions that it allows{slack} reach into the airspace, at "
            f"{[float(f'{x:.4g}') for x in met_m]} for one, where the vehicle may meet it; make it smaller, "
            f"keep the airspace away from it, or make keep_out_m more than {total_m:g}"
        )
        yield (*point.place, "uncertainty_m"), message
    if exact:
        message = (
            f"a vehicle up to {error_m:g} m from where it is meant to be may meet {listed(exact)}; make it "
            f"smaller, or keep_out_m more than {error_m:g}"
        )
        yield ("receiver", "position_error_m"), message


def _clearance_m(airspace: Airspace, centres_m: Array, at: Array) -> Array:
    clearance = airspace.clearance_m(at)
    if not len(centres_m):
        return clearance
    nearest = np.linalg.norm(at[:, None] - centres_m, axis=-1).min(axis=1)
    return np.asarray(np.minimum(clearance, nearest - airspace.keep_out_m))
