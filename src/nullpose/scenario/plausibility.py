"""What looks like a mistake: outlines in degrees, powers in another unit, altitudes over something else."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.errors import Fault
from nullpose.scenario.faults import Place
from nullpose.scenario.ground_points import Emitter
from nullpose.scenario.origin import POINT_LISTS
from nullpose.scenario.units import EARTHLY_CORNERS, watts_from_dbm

if TYPE_CHECKING:
    from nullpose.scenario.scenario import Scenario

_LEAST_M = {"geofence_m": 5.0, "polygon_m": 0.1}  # smaller outlines are taken for a mistake among ...
_WIDE_M = 100.0  # ... points farther apart than this
_DBM = (10.0, 60.0)  # powers in W that are likely to be dBm
_OFF_M = 15.0  # points that all lie so far off the origin's altitude are unlikely


def in_degrees(
    tables: Mapping[Place, Any], positions_m: Sequence[tuple[float, float, float]]
) -> Iterator[tuple[Place, str]]:
    """Yields the outlines in metres that are far too small for the ground points, as if they were degrees.

    Args:
        tables: the airspace and its zones by their place, and any others.
        positions_m: of the ground points [m].
    """
    span_m = max((np.ptp(axis) for axis in list(zip(*positions_m, strict=True))[:2]), default=0.0)
    for (place, table), (key, least_m) in product(
        tables.items(), _LEAST_M.items() if span_m > _WIDE_M else ()
    ):
        if (corners_m := getattr(table, key, None)) and np.ptp(corners_m, axis=0).max() < least_m:
            east_m, north_m = np.ptp(corners_m, axis=0)
            earthly = next(each for each, metric in EARTHLY_CORNERS.items() if metric == key)
            yield (
                (*place, key),
                f"it is {east_m:.2g} m by {north_m:.2g} m, but the ground points are {span_m:.0f} m apart: "
                f"this looks like degrees; write {earthly} = [[latitude, longitude], ...] and an [origin], "
                "or the corners in metres east and north of the origin",
            )


def doubts(scenario: Scenario) -> tuple[Fault, ...]:
    """Returns what a sound scenario states that looks like a mistake, each with its place.

    Powers in W that would be likely in dBm, where the file states others in dBm; points that all lie as far
    off the origin's altitude as the sea, the ellipsoid and the ground may be apart.

    Args:
        scenario: any.

    Example:
        >>> import nullpose
        >>> doubts(nullpose.load("examples/paper.toml"))
        ()
    """
    points = {
        f"{kind}[{index}]": point
        for kind in POINT_LISTS
        for index, point in enumerate(getattr(scenario, kind))
    }
    return (*_powers(scenario, points), *_altitudes(points))


def _powers(scenario: Scenario, points: Mapping[str, Any]) -> Iterator[Fault]:
    powers = {place: point for place, point in points.items() if isinstance(point, Emitter)}
    in_dbm = [scenario.receiver.noise_dbm, *(emitter.power_dbm for emitter in powers.values())]
    for place, emitter in powers.items() if any(dbm is not None for dbm in in_dbm) else ():
        power = emitter.power_w
        if power is not None and _DBM[0] <= power <= _DBM[1]:
            yield Fault(
                f"{place}.power_w",
                f"{power:g} W is {10.0 * math.log10(power) + 30.0:.1f} dBm, and others are stated in dBm; "
                f"if {power:g} dBm ({watts_from_dbm(power):.3g} W) is meant, write power_dbm = {power:g}",
            )


def _altitudes(points: Mapping[str, Any]) -> Iterator[Fault]:
    heights_m = {place: point.position_m[2] for place, point in points.items() if point.alt_m is not None}
    least_m = min(map(abs, heights_m.values()), default=0.0)
    if least_m >= _OFF_M and np.ptp([*heights_m.values()]) <= least_m:
        first, height_m = next(iter(heights_m.items()))
        yield Fault(
            first,
            f"this and all other points lie {least_m:.0f} m or more {'above' if height_m > 0.0 else 'below'} "
            "the origin, as far as the sea and the ellipsoid may be apart; check that alt_m is over the "
            "ellipsoid, and write alt_msl_m for altitudes over the sea, alt_agl_m for those above the ground",
        )
