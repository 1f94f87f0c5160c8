"""The search for a trajectory, and simpler flights to compare it with."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nullpose.objectives import FloatArray
from nullpose.solver.compiling import limit_clock
from nullpose.solver.trajectory.climb import Climb
from nullpose.solver.trajectory.course import Course, likely_poses
from nullpose.solver.trajectory.lattice import INSIDE, Lattice
from nullpose.solver.trajectory.segments import half_spaces

_STRIDES = 1.5, 2.5  # of the lattice's step
_BARRIERS = {True: (1e-3, 1e-2), False: (1e-2, 1e-1)}  # by whether the worst instant counts: for all its rows
_ROUGH, _END = 1e-3, {True: 3e-7, False: 3e-6}
_FINISHED = 2  # of the rough climbs, the best
_NEAR, _REACHED = 2e-2, 1e-5  # below the best at each instant, of a rough climb and of a finished one
_AT_REST_M_S = 1e-4
_MARGIN = 1e-3  # of the airspace's height that starts keep from its floor, at most 1 cm
_MARGIN_M = 1e-2
_ROUNDING = 1e-9  # metres, and of a step


@dataclass(frozen=True, eq=False)
class Flight:
    """A flight: where the vehicle is, and how it is turned.

    Args:
        poses: (t, 6) positions and axes.
        logs: (t,) log ratios there, by the physics.
        score: what is maximised, nats.
        prices: (t - 1, 3) multipliers of the speed limit, of one that a climb led to.
        multipliers: of the ratios at each instant, likewise.
    """

    poses: FloatArray
    logs: FloatArray
    score: float
    prices: FloatArray | None = None
    multipliers: list[FloatArray] | None = None


def flight_of(course: Course, poses: FloatArray, climb: Climb | None = None) -> Flight:
    """Evaluate the flight of poses, (t, 6), by the physics."""
    logs = course.logs(poses)
    multipliers = () if climb is None else (climb.prices(), climb.multipliers())
    return Flight(poses, logs, course.aim.score(logs), *multipliers)


def climbed(course: Course, positions_m: FloatArray, mu: float) -> Flight:
    """Return the flight that a climb from positions, (t, 3), leads to."""
    climb = Climb(course, inside(course, positions_m))
    return flight_of(course, climb.run(mu, _END[course.aim.is_worst]), climb)


def best_flight(course: Course, best_poses: FloatArray, deadline: float) -> tuple[Flight | None, Lattice]:
    """Search for the best trajectory: paths over a lattice, and climbs from them.

    Args:
        course: the problem.
        best_poses: (t, 6) the best at each instant, if the vehicle could be anywhere.
        deadline: on ``limit_clock``, after which no climb begins but the first.

    Returns:
        The trajectory, if one was found, and the lattice.
    """
    lattice, is_worst = Lattice.around(course, best_poses[:, :3]), course.aim.is_worst
    slower = replace(course, speed_max_m_s=INSIDE * course.speed_max_m_s)
    paths = [greedy(slower, best_poses).poses[:, :3]]
    paths += [lattice.best_path(worst, strides) for worst in (is_worst, not is_worst) for strides in _STRIDES]
    climbs = [
        (Climb(course, poses), mu)
        for poses in (inside(course, path) for path in _distinct(paths))
        if is_allowed(course, poses[:, :3])
        for mu in _BARRIERS[is_worst]
    ]

    def finished(climb: Climb) -> Flight:
        return flight_of(course, climb.run(_ROUGH, _END[is_worst], deadline), climb)

    ceiling, rough = course.aim.score(course.logs(best_poses)), list[tuple[float, int]]()
    for i, (climb, mu) in enumerate(climbs):
        if i == 0 or limit_clock() < deadline:
            rough.append((course.aim.score(course.logs(climb.run(mu, _ROUGH, deadline))), i))
            is_near = rough[-1][0] > ceiling - _NEAR
            if is_near and (flight := finished(climb)).score > ceiling - _REACHED:
                return flight, lattice  # the best at each instant that counts
    flights = [finished(climbs[i][0]) for _, i in sorted(rough, reverse=True)[:_FINISHED]]
    flights = [each for each in flights if each.score > -np.inf]
    return max(flights, key=lambda each: each.score, default=None), lattice


def hovering(course: Course, lattice: Lattice, deadline: float) -> Flight | None:
    """Return the best flight found that stays in one place and turns: at the start, if that is given.

    Args:
        course: the problem.
        lattice: where the search begins.
        deadline: on ``limit_clock``.
    """
    fixed_m = [each for each in course.ends_m if each is not None]
    is_worst, count, best = course.aim.is_worst, len(course.times_s), None
    places_m = fixed_m[:1] or lattice.best_places(is_worst, deadline)
    places_m = [np.tile(place_m, (count, 1)) for place_m in places_m]
    clear_m = [each for each in places_m if is_clear(course, each)]
    if clear_m and not fixed_m:
        held = replace(course, speed_max_m_s=_AT_REST_M_S)
        climb = Climb(held, inside(held, clear_m[0]))
        end_m = np.mean(climb.run(_BARRIERS[is_worst][1], _END[is_worst], deadline)[:, :3], axis=0)
        places_m.append(np.tile(end_m, (count, 1)))
    for each in places_m:
        if is_allowed(course, each) and (best is None or limit_clock() < deadline):
            climb = Climb(course, _posed(course, each), turns_only=True)
            flight = flight_of(course, climb.run(_ROUGH, _END[is_worst], deadline))
            best = flight if best is None or flight.score > best.score else best
    return best


def greedy(course: Course, best_poses: FloatArray) -> Flight:
    """Return the flight towards the best pose of each instant, (t, 6), as far as the speed lets it.

    Where something is in the way it waits.
    """
    (start_m, end_m), places_m = course.ends_m, best_poses[:, :3]
    flown = [places_m[0] if start_m is None else start_m]
    left_m = np.append(np.cumsum(course.reach_m[::-1])[::-1], 0.0)
    for t, reach_m in enumerate(course.reach_m):
        goal_m = places_m[t + 1]
        if end_m is not None and np.linalg.norm(flown[-1] - end_m) > left_m[t + 1] - reach_m:
            goal_m = end_m
        way_m = goal_m - flown[-1]
        moved = flown[-1] + min(1.0, reach_m / max(1e-12, float(np.linalg.norm(way_m)))) * way_m
        pair = np.array([flown[-1], moved])
        flown.append(moved if is_clear(course, pair, t) else flown[-1])
    poses = _posed(course, np.array(flown))
    is_there = np.linalg.norm(poses[:, :3] - places_m, axis=1) < _ROUNDING
    return flight_of(course, np.where(is_there[:, None], best_poses, poses))


def seeing_ahead(course: Course, window_s: float, start: Flight, deadline: float) -> Flight | None:
    """Return the flight that plans anew at each instant, for what it sees of the time to come; None if late.

    Args:
        course: the problem.
        window_s: how far ahead motions are known.
        start: a flight of which the first pose is the start.
        deadline: on ``limit_clock``.
    """
    poses = inside(course, np.tile(start.poses[0, :3], (len(course.times_s), 1)))
    for t in range(len(poses) - 1):
        if limit_clock() > deadline:
            return None
        last = int(np.searchsorted(course.times_s, course.times_s[t] + window_s, side="right"))
        part = course.part(t, max(last, t + 2), poses[t, :3])
        ahead = inside(part, np.tile(poses[t, :3], (len(part.times_s), 1)))
        poses[t + 1] = Climb(part, ahead).run(_BARRIERS[False][0], _ROUGH)[1]
    return flight_of(course, poses)


def is_allowed(course: Course, positions_m: FloatArray) -> bool:
    """Check that a flight, (t, 3), keeps to speed, airspace, points and the ends that are given."""
    steps_m = np.linalg.norm(np.diff(positions_m, axis=0), axis=1)
    is_slow = bool(np.all(steps_m <= course.reach_m * (1.0 + _ROUNDING) + _ROUNDING))
    ends = [
        (place_m, end_m)
        for place_m, end_m in zip(positions_m[[0, -1]], course.ends_m, strict=True)
        if end_m is not None
    ]
    at_ends = all(np.allclose(place_m, end_m, rtol=0.0, atol=_ROUNDING) for place_m, end_m in ends)
    return is_slow and at_ends and is_clear(course, positions_m)


def is_clear(course: Course, positions_m: FloatArray, first: int = 0) -> bool:
    """Check that straight segments keep to the airspace and clear of every point.

    Args:
        course: the problem.
        positions_m: (n, 3) at n instants.
        first: index of the first of them.
    """
    families = course.families[first : first + len(positions_m)]
    domain, points_m = families[0].domain, np.stack([each.ratios.points_m for each in families])
    low_m, high_m = domain.low_m - _ROUNDING, domain.high_m + _ROUNDING
    within = bool(np.all((positions_m >= low_m) & (positions_m <= high_m)))
    spaces = half_spaces(
        domain, positions_m[:-1], positions_m[1:], points_m[:-1], points_m[1:], domain.keep_out_m
    )
    return within and bool(np.all(spaces.slacks_m >= -_ROUNDING))


def _distinct(paths: list[FloatArray]) -> list[FloatArray]:
    return [path for i, path in enumerate(paths) if not any(np.array_equal(path, each) for each in paths[:i])]


def _posed(course: Course, positions_m: FloatArray) -> FloatArray:
    axes = [likely_poses(course, t, np.array(place_m[None]))[0][0] for t, place_m in enumerate(positions_m)]
    return np.hstack([positions_m, axes])


def inside(course: Course, positions_m: FloatArray) -> FloatArray:
    """Return poses strictly inside the faces of the airspace, but for a start or an end that is given."""
    domain = course.families[0].domain
    size_m = domain.high_m - domain.low_m
    margin_m = np.where(size_m > 1e-9, np.minimum(_MARGIN_M, _MARGIN * size_m), 0.0)
    positions_m = np.clip(positions_m, domain.low_m + margin_m, domain.high_m - margin_m)
    for t, end_m in ((0, course.ends_m[0]), (-1, course.ends_m[1])):
        positions_m[t] = positions_m[t] if end_m is None else end_m
    return _posed(course, positions_m)
