"""What a trajectory is of: the instants of a scene in motion, and what is maximised over them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property

import numpy as np

from nullpose.errors import UsageError, require_usage
from nullpose.objectives import FloatArray, Quantity
from nullpose.physics import Pose, allowed_value
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family, still_scenes
from nullpose.scenario import Scenario
from nullpose.scenario.motion import time_of

_MOST_INSTANTS = 10_000
_INSTANT_MB = 0.1  # scene, family and model of one


class Aim(StrEnum):
    """What is maximised over the instants of a trajectory."""

    WORST = "worst"
    MEAN_DB = "mean-db"
    MEAN_RATE = "mean-rate"

    @property
    def is_worst(self) -> bool:
        """Whether it is the smallest value, which needs one level for all instants."""
        return self is Aim.WORST

    def gains(self, logs: FloatArray) -> FloatArray:
        """Convert log ratios to what is summed up, or of which the least counts: nats."""
        return np.logaddexp(0.0, logs) if self is Aim.MEAN_RATE else logs

    def slopes(self, logs: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Differentiate the gains by the logarithms, once and twice."""
        if self is not Aim.MEAN_RATE:
            return np.ones_like(logs), np.zeros_like(logs)
        share = 1.0 / (1.0 + np.exp(-logs))
        return share, share * (1.0 - share)

    def score(self, logs: FloatArray) -> float:
        """Return what is maximised, from the log ratios at the instants: nats."""
        return float(np.min(logs) if self.is_worst else np.mean(self.gains(logs)))


@dataclass(frozen=True, eq=False)
class Course:
    """The problem of a trajectory.

    Args:
        scenes: the scene at each instant.
        times_s: (t,) the instants.
        families: the family at each.
        field: the axes that the vehicle reaches.
        aim: what is maximised.
        speed_max_m_s: the vehicle's.
        ends_m: where it is at the first and the last instant, (3,) each; None where that is free.
    """

    scenes: list[Scenario]
    times_s: FloatArray
    families: list[Family]
    field: AxisField
    aim: Aim
    speed_max_m_s: float
    ends_m: tuple[FloatArray | None, FloatArray | None]

    @classmethod
    def of(cls, scenario: Scenario, aim: Aim) -> Course:
        """Build the problem of a scene in motion.

        Args:
            scenario: in motion, its airframe with a speed.
            aim: what is maximised.

        Raises:
            UsageError: nothing moves, the speed is missing, there are too many instants, or the antenna, the
                objective or the channels are not for a trajectory.
        """
        times_s, airframe = time_of(scenario, "trajectory: asked for").instants_s, scenario.airframe
        if airframe is None or airframe.speed_max_m_s is None:
            raise UsageError("airframe.speed_max_m_s: missing; a trajectory needs the largest speed, in m/s")
        require_usage(
            airframe.speed_max_m_s > 0.0,
            "airframe.speed_max_m_s: given 0; allowed: more than 0; solve --hover has the pose that stays",
        )
        require_usage(
            len(times_s) <= _MOST_INSTANTS,
            f"time: given {len(times_s):,} instants for a trajectory, which take about "
            f"{_INSTANT_MB * len(times_s):,.0f} MB; allowed: {_MOST_INSTANTS:,}; raise step_s",
        )
        is_dipole = scenario.array is None and scenario.antenna_record.is_quadratic
        require_usage(
            is_dipole and not scenario.has_custom_channels,
            "trajectory: given an array, an antenna that is no dipole, or a channel in Python; allowed: a "
            "dipole, and the channels that a file can state",
        )
        scenes = still_scenes(scenario)
        require_usage(
            not (aim is Aim.MEAN_RATE and Quantity.of(scenes[0]).is_rate),
            "maximise: given mean-rate, but the objective is a rate; allowed: mean-db, which is its mean",
        )
        families = [build_family(scene, any_channel=True, any_objective=True) for scene in scenes]
        start_m, end_m = (
            None if each is None else np.array(each) for each in (airframe.start_m, airframe.end_m)
        )
        field = AxisField.within(*scenes[0].axis_band)
        return cls(scenes, times_s, families, field, aim, airframe.speed_max_m_s, (start_m, end_m))

    def part(self, first: int, last: int, start_m: FloatArray) -> Course:
        """Return the problem of the instants from one index to before another, from a place, (3,)."""
        families, scenes = self.families[first:last], self.scenes[first:last]
        return replace(
            self, scenes=scenes, times_s=self.times_s[first:last], families=families, ends_m=(start_m, None)
        )

    @cached_property
    def reach_m(self) -> FloatArray:
        """How far the vehicle comes from each instant to the next, (t - 1,), metres."""
        return np.asarray(self.speed_max_m_s * np.diff(self.times_s))

    @cached_property
    def quantity(self) -> Quantity:
        """The quantity of a node."""
        return Quantity.of(self.scenes[0])

    def logs(self, poses: FloatArray) -> FloatArray:
        """Evaluate the log ratios of poses, (t, 6) positions and axes, by the physics.

        Minus infinity where a node of a sum or a mean has less than it requires.
        """
        values = [
            allowed_value(scene, pose[:3], Pose.of_airframe(scene, pose[:3], pose[3:]).antenna_axis)
            for scene, pose in zip(self.scenes, poses, strict=True)
        ]
        with np.errstate(divide="ignore"):
            return np.log(self.quantity.to_ratio(np.array(values)))


def likely_poses(course: Course, t: int, positions_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Find a likely axis for positions at an instant; return the axes, (n, 3), and the log ratios, (n,).

    Args:
        course: the problem.
        t: index of the instant.
        positions_m: (n, 3); those outside of what the airspace allows have minus infinity.
    """
    from nullpose.solver.kernels.compiler.jit import entry_of
    from nullpose.solver.kernels.search.flight import value_positions

    family, axes, logs = course.families[t], np.zeros_like(positions_m), np.empty(len(positions_m))
    entry_of(value_positions)(family.ratios, family.domain, course.field.arrays, positions_m, axes, logs)
    return axes, logs
