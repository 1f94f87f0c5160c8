"""Flights that try to exceed a bound: random walks, climbs from them, and flights near the best one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.soundness.airways import Airways
from benchmarks.soundness.search import nearest_in_band
from nullpose.objectives import Quantity
from nullpose.physics import allowed_value
from nullpose.scenario import Scenario
from nullpose.solver.trajectory.course import Course, likely_poses
from nullpose.solver.trajectory.search import climbed

FloatArray = NDArray[np.float64]

_ROUND_M = 30.0  # how far around the points walks begin
_ROUNDS, _TURNS = 40, 50  # of changes to a flight, and to its axes
_BARRIER = 1e-2
_SETTING = np.log(1.6), np.log(0.8)  # of how much is changed: after a success, and otherwise


@dataclass(frozen=True)
class Attack:
    """Flights against the bounds of a scene.

    Args:
        airways: what flights keep to.
        courses: by aim: the solver's problem, of which its climbs and its likely axes are taken.
        rng: what is random.
    """

    airways: Airways
    courses: dict[str, Course]
    rng: np.random.Generator

    def walks(self, count: int, share: float = 1.0) -> FloatArray:
        """Return random walks at up to a share of the largest speed, (n, t, 3), most within the airspace."""
        rng, reach_m, (start_m, end_m) = self.rng, share * self.airways.reach_m, self.airways.ends_m
        low_m, high_m = self._box_m()
        p = rng.uniform(low_m, high_m, (count, 3)) if start_m is None else np.tile(start_m, (count, 1))
        if start_m is None:
            p[: count // 2, 2] = low_m[2]  # the best is often there
        left_m = np.append(np.cumsum(reach_m[::-1])[::-1], 0.0)
        flown, way = [p], rng.normal(size=(count, 3))
        for t, step_m in enumerate(reach_m):
            way = 0.7 * way + rng.normal(size=(count, 3)) * [1.0, 1.0, 0.3]
            length_m = step_m * np.minimum(1.0, rng.uniform(0.0, 2.0, (count, 1)))
            q = np.clip(p + length_m * way / np.linalg.norm(way, axis=1, keepdims=True), low_m, high_m)
            if end_m is not None:
                home_m = end_m - p
                far_m = np.linalg.norm(home_m, axis=1, keepdims=True)
                homewards = p + home_m * np.minimum(1.0, step_m / np.maximum(far_m, 1e-9))
                is_far = np.linalg.norm(q - end_m, axis=1) > left_m[t + 1]
                q[is_far] = homewards[is_far]
            blocked = np.logical_or.reduce(list(self.airways.segment_faults(t, p, q).values()))
            q[blocked] = p[blocked]
            flown.append(q)
            p = q
        return np.stack(flown, axis=1)

    def climbs(self, flights_m: FloatArray) -> FloatArray:
        """Return where the solver's climbs from flights, (n, t, 3), lead to, the aims taking turns."""
        courses = list(self.courses.values())
        climbs = [climbed(courses[i % len(courses)], each, _BARRIER) for i, each in enumerate(flights_m)]
        return np.array([each.poses[:, :3] for each in climbs]).reshape(flights_m.shape)

    def bettered(self, flights_m: FloatArray) -> FloatArray:
        """Return flights, (n, t, 3), changed at random for the better, the aims taking turns."""
        rng, (count, instants, _), flights_m = self.rng, flights_m.shape, flights_m.copy()
        aims, times = list(self.courses), np.arange(instants)
        size = 10.0 ** rng.uniform(-3.0, 1.0, count)
        best = self._wanted(aims, self._likely(flights_m)[1])
        for _ in range(_ROUNDS):
            middle, width = rng.uniform(0, instants, (count, 1)), 10.0 ** rng.uniform(-0.5, 1.0, (count, 1))
            bump = np.exp(-(((times - middle) / width) ** 2))[..., None]
            trial = flights_m + size[:, None, None] * bump * rng.normal(size=(count, 1, 3))
            trial = self._slowed(np.clip(trial, *self._box_m(1e3)))
            values = self._wanted(aims, self._likely(trial)[1])
            better = (values > best) & self.airways.keeps(trial)
            flights_m, best = (
                np.where(better[:, None, None], trial, flights_m),
                np.where(better, values, best),
            )
            size *= np.exp(np.where(better, *_SETTING))
        return flights_m

    def values(self, flights_m: FloatArray) -> FloatArray:
        """Evaluate flights, (n, t, 3), at the best axes found: (n, t), by the physics."""
        axes, out = self._likely(flights_m)[0], np.empty(flights_m.shape[:2])
        axes[~np.any(axes, axis=-1)] = [0.0, 0.0, 1.0]  # beyond a border by rounding the solver has none
        for t, scene in enumerate(self.airways.scenes):
            out[:, t] = self._best_values(scene, flights_m[:, t], axes[:, t])
        return out

    def _best_values(self, scene: Scenario, p: FloatArray, axes: FloatArray) -> FloatArray:
        """Return values at axes that are turned while that is better, first by much and then by little."""
        band, size = scene.axis_band, np.full(len(p), 1.0)
        axes = nearest_in_band(axes, *band)
        best = allowed_value(scene, p, axes)
        for _ in range(_TURNS):
            turned = nearest_in_band(axes + size[:, None] * self.rng.normal(size=p.shape), *band)
            values = allowed_value(scene, p, turned)
            better = values > best
            axes[better], best[better] = turned[better], values[better]
            size *= np.exp(np.where(better, *_SETTING))
        return best

    def _likely(self, flights_m: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return likely axes, (n, t, 3), and the log ratios there, (n, t)."""
        course = next(iter(self.courses.values()))
        places = np.ascontiguousarray(np.swapaxes(flights_m, 0, 1))
        found = [likely_poses(course, t, each) for t, each in enumerate(places)]
        return np.stack([axes for axes, _ in found], axis=1), np.stack([logs for _, logs in found], axis=1)

    def _wanted(self, aims: list[str], logs: FloatArray) -> FloatArray:
        """Return the score of each flight for the aim whose turn it is, (n,)."""
        courses = list(self.courses.values())
        return np.array([courses[i % len(aims)].aim.score(each) for i, each in enumerate(logs)])

    def _slowed(self, flights_m: FloatArray) -> FloatArray:
        """Shorten steps that are too fast, from the start on, or from the end if that alone is given."""
        (start_m, end_m), flights_m = self.airways.ends_m, flights_m.copy()
        for i, given_m in ((0, start_m), (-1, end_m)):
            if given_m is not None:
                flights_m[:, i] = given_m
        backwards = start_m is None and end_m is not None
        flights_m = flights_m[:, ::-1] if backwards else flights_m
        for t, reach_m in enumerate(self.airways.reach_m[:: -1 if backwards else 1]):
            step_m = flights_m[:, t + 1] - flights_m[:, t]
            length_m = np.maximum(np.linalg.norm(step_m, axis=1, keepdims=True), 1e-12)
            flights_m[:, t + 1] = flights_m[:, t] + step_m * np.minimum(1.0, reach_m / length_m)
        return flights_m[:, ::-1] if backwards else flights_m

    def _box_m(self, round_m: float = _ROUND_M) -> tuple[FloatArray, FloatArray]:
        airspace, scenes = self.airways.scenario.airspace, self.airways.scenes
        ground_m = np.array([point.position_m for scene in scenes for point in scene.points])
        low_m, high_m = airspace.box_m
        return np.maximum(low_m, ground_m.min(axis=0) - round_m), np.minimum(
            high_m, ground_m.max(axis=0) + round_m
        )


def scores(scenario: Scenario, values: FloatArray) -> dict[str, FloatArray]:
    """Return by aim what flights reach, (n,), in its unit, from their values at the instants, (n, t)."""
    if Quantity.of(scenario).is_rate:
        return {"worst": values.min(axis=1), "mean-db": values.mean(axis=1)}
    with np.errstate(divide="ignore"):
        decibels = 10.0 * np.log10(values)
    return {
        "worst": decibels.min(axis=1),
        "mean-db": decibels.mean(axis=1),
        "mean-rate": np.log2(1.0 + values).mean(axis=1),
    }
