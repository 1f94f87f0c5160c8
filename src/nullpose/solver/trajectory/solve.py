"""The verb for trajectories: a flight through a scene in motion, and a bound that none exceeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from nullpose.errors import SolveError, checked, require_usage
from nullpose.objectives import FloatArray
from nullpose.physics import Pose, rotation_world_from_body
from nullpose.physics.rotation import attitude_of, attitude_of_axis, rotation_about
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.compiling import limit_clock, precompile, working_clock
from nullpose.solver.result import Stats
from nullpose.solver.trajectory.bounds import Clairvoyant, clairvoyant, worst_bound
from nullpose.solver.trajectory.course import Aim, Course
from nullpose.solver.trajectory.prices import PriceBound
from nullpose.solver.trajectory.result import Trajectory, from_nats
from nullpose.solver.trajectory.search import Flight, best_flight, greedy, hovering, is_allowed, seeing_ahead

_OPPOSITE = -1.0 + 1e-12  # cosine to an axis that the vehicle reaches the other way round, too

GAP_DB = 0.05
"""The gap asked for unless another is, in dB or, of a rate, bits/s/Hz."""
TIME_LIMIT_S = 60.0


@checked
def solve_trajectory(
    scenario: Scenario,
    maximise: Aim | str = Aim.WORST,
    *,
    gap_db: float = GAP_DB,
    time_limit_s: float = TIME_LIMIT_S,
    window_s: float | None = None,
    on_progress: Callable[[str, float], None] | None = None,
) -> Trajectory:
    """Find the best flight of a vehicle with a speed limit through a scene in motion, and a bound on all.

    The flight is straight from instant to instant, keeps to ``airframe.speed_max_m_s`` and, along the
    segments as well, to the airspace and clear of every point. Where it starts and ends is free unless
    ``airframe.start_m`` and ``airframe.end_m`` say so. The attitude may change as fast as it needs to.

    The bound is calculated in floating point and has no certificate. Of ``worst`` it holds for any flight in
    continuous time, that of a mean for the mean over the instants.

    Args:
        scenario: with ``[time]``, something that moves, and ``airframe.speed_max_m_s``.
        maximise: ``worst``, the smallest value over the instants; ``mean-db``, the mean of its decibels;
            ``mean-rate``, the mean of ``log2(1 + ratio)``.
        gap_db: difference of bound and value at which the proof is done, dB or bits/s/Hz.
        time_limit_s: seconds after which search and proof stop with what they have reached.
        window_s: how far ahead the flight sees that is compared; without it there is none.
        on_progress: called now and then with what is done and the share of it, or the gap so far.

    Raises:
        UsageError: nothing moves, the speed is missing, a bad gap or limit, or an antenna, an objective or a
            channel that trajectories do not know.
        SolveError: no trajectory was found.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.apply_overrides(
        ...     nullpose.load("examples/moving_jammer.toml"),
        ...     ["airframe.preset=omnidirectional", "airframe.speed_max_m_s=5", "time.step_s=5"],
        ... )
        >>> found = nullpose.solve_trajectory(scenario)
        >>> found.value <= found.upper_bound, len(found.poses)
        (True, 13)
    """
    require_usage(
        str(maximise) in set(Aim), f"maximise: given {maximise!r}; allowed: {', '.join(map(str, Aim))}"
    )
    require_usage(1e-6 <= gap_db <= 100.0, f"gap: given {gap_db!r} dB; allowed: 1e-6 to 100")
    require_usage(time_limit_s > 0.0, f"time limit: given {time_limit_s!r}; allowed: more than 0 seconds")
    require_usage(
        window_s is None or window_s > 0.0, f"window: given {window_s!r}; allowed: more than 0 seconds"
    )
    began, course = working_clock(), Course.of(scenario, Aim(maximise))
    precompile()  # compiling must not count against the time limit
    tell = on_progress or (lambda words, share: None)
    return _Run(course, gap_db, limit_clock() + time_limit_s, tell).result(scenario, window_s, began)


class _Run:
    """The steps of one solve."""

    def __init__(
        self, course: Course, gap_db: float, deadline: float, tell: Callable[[str, float], None]
    ) -> None:
        self.course, self.deadline, self.tell = course, deadline, tell
        self.gap_db, self.reason = gap_db, ""
        self.gap = gap_db / self.in_unit(1.0)

    @property
    def half_time(self) -> float:
        """Half-way from now to the deadline: what comes afterwards takes time, too."""
        now = limit_clock()
        return now + 0.5 * (self.deadline - now)

    def in_unit(self, score: float) -> float:
        return from_nats(self.course.quantity, self.course.aim, score)

    def result(self, scenario: Scenario, window_s: float | None, began: float) -> Trajectory:
        course, count = self.course, len(self.course.times_s)
        best = clairvoyant(course, self.gap, lambda done: self.tell("instants", done / count), self.half_time)
        found, lattice = best_flight(course, best.poses, self.half_time)
        hover = hovering(course, lattice, self.half_time)
        others = {"hover": hover, "greedy": greedy(course, best.poses), "window": None}
        if window_s is not None and found is not None:
            others["window"] = seeing_ahead(course, window_s, found, self.half_time)
        # not one that misses its end or what a node requires, or waits where a point comes by
        others = {
            name: each if each and each.score > -math.inf and is_allowed(course, each.poses[:, :3]) else None
            for name, each in others.items()
        }
        flights = [each for each in (found, *others.values()) if each is not None]
        if not flights:
            raise SolveError(
                "no trajectory was found that keeps to the airspace and the speed; raise "
                "airframe.speed_max_m_s, or widen the airspace"
            )
        prices, multipliers = np.zeros((count - 1, 3)), best.multipliers
        if found is not None and found.prices is not None and found.multipliers is not None:
            prices, multipliers = found.prices, found.multipliers
        flight = max(flights, key=lambda each: each.score)
        flight = replace(flight, prices=prices, multipliers=multipliers)
        top = course.aim.score(best.bounds)
        flight, bound, bound_name = self._bounded(flight, best, top)
        scores = {name: None if each is None else self.in_unit(each.score) for name, each in others.items()}
        return Trajectory(
            scenario=scenario,
            maximise=course.aim,
            times_s=course.times_s,
            poses=tuple(continuous_poses(course, flight.poses)),
            values=_values(course, flight.logs),
            optimum_values=_values(course, best.bounds),
            value=self.in_unit(flight.score),
            upper_bound=max(self.in_unit(bound), self.in_unit(flight.score)),
            gap_db=self.gap_db,
            bound_name=bound_name,
            baselines=scores | {"clairvoyant": self.in_unit(top)},
            reason=self.reason,
            stats=Stats(wall_s=working_clock() - began),
        )

    def _bounded(self, flight: Flight, best: Clairvoyant, top: float) -> tuple[Flight, float, str]:
        """Return the flight, perhaps a better one, the bound and where it is from."""
        bound, name = top, "clairvoyant"
        if top <= flight.score + self.gap:
            return flight, bound, name

        def take(found: Flight, proved: float) -> None:
            nonlocal flight, bound, name
            flight = max(flight, found, key=lambda each: each.score)
            if proved < bound:
                bound, name = proved, "key-instants" if self.course.aim.is_worst else "prices"
            self.tell("gap", self.in_unit(bound - flight.score))

        try:
            if self.course.aim.is_worst:
                worst_bound(self.course, flight, best, self.gap, self.deadline, take)
            else:
                PriceBound(self.course, flight, best, self.gap, self.deadline, take).run()
        except KeyboardInterrupt:
            self.reason = INTERRUPT
        if bound > flight.score + self.gap and not self.reason:
            is_late = limit_clock() > self.deadline
            self.reason = "the time limit" if is_late else "the bound came no nearer"
        return flight, bound, name


def _values(course: Course, logs: FloatArray) -> FloatArray:
    return np.array([course.quantity.of_ratio(float(ratio)) for ratio in np.exp(logs)])


def continuous_poses(course: Course, poses: FloatArray) -> Iterator[Pose]:
    """Turn the vehicle along a flight as little as it can: u and -u are the same antenna, and a spin is free.

    Where the tilt is limited and the dipole is not along the body's vertical, each attitude is that of least
    tilt for u or -u.

    Args:
        course: the problem.
        poses: (t, 6) positions and axes.
    """
    airframe = course.scenes[0].airframe
    assert airframe is not None, "its speed is stated"
    mount_rad, tilt_max_rad = airframe.mount_rad, airframe.tilt_max_rad
    is_free = mount_rad == 0.0 or tilt_max_rad >= math.pi
    mount, before = rotation_world_from_body(0.0, mount_rad, 0.0), None
    for scene, pose in zip(course.scenes, poses, strict=True):
        found = Pose.of_airframe(scene, pose[:3], pose[3:])
        axis = found.antenna_axis
        if before is None:
            before = found.rotation_world_from_antenna
        elif is_free:
            if tilt_max_rad >= math.pi and axis @ before[:, 2] < 0.0:
                axis = -axis
            before = _least_turn(before[:, 2], axis) @ before
            found = Pose(pose[:3], *attitude_of(before @ mount.T, tilt_max_rad), mount_rad)
        else:
            other = Pose(
                pose[:3], *attitude_of_axis(-axis, tilt_max_rad, mount_rad, is_even=False), mount_rad
            )
            frames = [each.rotation_world_from_antenna for each in (found, other)]
            is_other = (
                other.antenna_axis @ axis < _OPPOSITE and np.sum(before * (frames[1] - frames[0])) > 0.0
            )
            found, before = (other, frames[1]) if is_other else (found, frames[0])
        yield found


def _least_turn(first: FloatArray, last: FloatArray) -> FloatArray:
    """Build the smallest rotation that takes one unit vector to another."""
    across = np.cross(first, last)
    size = float(np.linalg.norm(across))
    if size < 1e-12:
        return np.eye(3)
    return rotation_about(across / size * math.atan2(size, float(first @ last)))
