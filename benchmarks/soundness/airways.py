"""What flights keep to, judged by shapely and a formula for balls that move: nothing of the solver's."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from nullpose.problem.family import still_scenes
from nullpose.scenario import Airspace, Scenario

FloatArray = NDArray[np.float64]
Flags = NDArray[np.bool_]

_ROUNDING_M = 1e-6


@dataclass(frozen=True)
class Airways:
    """The ways through a scene in motion.

    Args:
        scenario: in motion, its airframe with a speed.
    """

    scenario: Scenario

    @cached_property
    def scenes(self) -> list[Scenario]:
        """The still scene at each instant."""
        return still_scenes(self.scenario)

    @cached_property
    def reach_m(self) -> FloatArray:
        """How far the vehicle comes in each step, (t - 1,), metres."""
        airframe = self.scenario.airframe
        assert airframe is not None
        assert airframe.speed_max_m_s is not None
        return np.asarray(airframe.speed_max_m_s * np.diff(self.scenario.instants_s))

    @cached_property
    def ends_m(self) -> tuple[FloatArray | None, FloatArray | None]:
        """Where a flight starts and ends, (3,) metres each; None where that is free."""
        frame = self.scenario.airframe
        assert frame is not None
        start_m, end_m = (None if each is None else np.array(each) for each in (frame.start_m, frame.end_m))
        return start_m, end_m

    def faults(self, flights_m: FloatArray) -> dict[str, Flags]:
        """Tell of flights, (n, t, 3), which break what, (n,) each."""
        steps_m = np.linalg.norm(np.diff(flights_m, axis=1), axis=2)
        found = {"is too fast": np.any(steps_m > self.reach_m + _ROUNDING_M, axis=1)}
        for words, index, end_m in zip(("starts", "ends"), (0, -1), self.ends_m, strict=True):
            if end_m is not None:
                apart_m = np.linalg.norm(flights_m[:, index] - end_m, axis=1)
                found[f"{words} elsewhere"] = apart_m > _ROUNDING_M
        for t in range(flights_m.shape[1] - 1):
            for words, broken in self.segment_faults(t, flights_m[:, t], flights_m[:, t + 1]).items():
                found[words] = found.get(words, False) | broken
        return found

    def keeps(self, flights_m: FloatArray) -> Flags:
        """Tell which flights, (n, t, 3), keep to everything, (n,)."""
        return ~np.logical_or.reduce(list(self.faults(flights_m).values()))

    def segment_faults(self, t: int, p: FloatArray, q: FloatArray) -> dict[str, Flags]:
        """Tell of straight ways from an instant to the next, (n, 3) to (n, 3), which break what."""
        airspace, found = self.scenario.open_airspace, {}
        low_m, high_m = airspace.lower_m - _ROUNDING_M, airspace.upper_m + _ROUNDING_M
        found["leaves the ranges"] = ~np.all((p >= low_m) & (q >= low_m) & (p <= high_m) & (q <= high_m), 1)
        found["leaves the fence"] = _outside_fence(airspace, p, q)
        for zone in airspace.no_fly:
            found[f"enters {zone.name or 'a building'}"] = _inside_zone(airspace, zone, p, q)
        found["comes too near a point"] = self._near_points(t, p, q)
        return found

    def _near_points(self, t: int, p: FloatArray, q: FloatArray) -> Flags:
        first, last = (np.array([point.position_m for point in self.scenes[i].points]) for i in (t, t + 1))
        before, after = p[:, None] - first, q[:, None] - last
        along = after - before
        square = np.maximum(np.sum(along**2, axis=-1), 1e-18)
        share = np.clip(-np.sum(before * along, axis=-1) / square, 0.0, 1.0)
        apart_m = np.linalg.norm(before + share[..., None] * along, axis=-1)
        return np.asarray(np.any(apart_m < self.scenario.airspace.keep_out_m - _ROUNDING_M, axis=1))


def _lines(p: FloatArray, q: FloatArray) -> NDArray[np.object_]:
    return np.asarray(shapely.linestrings(np.stack([p[:, :2], q[:, :2]], axis=1)))


def _outside_fence(airspace: Airspace, p: FloatArray, q: FloatArray) -> Flags:
    if airspace.geofence_m is None:
        return np.zeros(len(p), dtype=np.bool_)
    fence, lines = shapely.Polygon(airspace.geofence_m), _lines(p, q)
    is_near = shapely.distance(lines, fence.exterior) < airspace.margin_m - _ROUNDING_M
    return np.asarray(is_near | ~shapely.covers(fence.buffer(_ROUNDING_M), lines))


def _inside_zone(airspace: Airspace, zone, p: FloatArray, q: FloatArray) -> Flags:
    """Tell which segments enter a zone's interior at the altitudes that it has, its margin counted."""
    beside_m = airspace.margin_m - _ROUNDING_M
    low_m, high_m = zone.floor_m - beside_m, zone.ceiling_m + beside_m
    climb_m = q[:, 2] - p[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = (np.array([[low_m], [high_m]]) - p[:, 2]) / climb_m
    level = np.abs(climb_m) < 1e-12
    enters = np.where(level, 0.0, np.clip(np.min(shares, axis=0), 0.0, 1.0))
    leaves = np.where(level, 1.0, np.clip(np.max(shares, axis=0), 0.0, 1.0))
    middle_m = p[:, 2] + 0.5 * (enters + leaves) * climb_m
    within = (middle_m > low_m) & (middle_m < high_m) & (leaves >= enters)
    lines = _lines(p + enters[:, None] * (q - p), p + leaves[:, None] * (q - p))
    if zone.centre_m is not None:
        away_m = shapely.distance(lines, shapely.Point(zone.centre_m))
        return np.asarray(within & (away_m < zone.radius_m + beside_m))
    outline = shapely.Polygon(zone.outline_m)
    if beside_m > 0.0:
        return np.asarray(within & (shapely.distance(lines, outline) < beside_m))
    return np.asarray(within & shapely.intersects(lines, outline.buffer(beside_m)))
