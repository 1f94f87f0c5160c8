"""What a trajectory gives, what is proved of it, and what simpler flights give."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from nullpose.files import PlainTable
from nullpose.objectives import FloatArray, Quantity
from nullpose.physics import Pose, pose_frames, rotation_world_from_body
from nullpose.scenario import Scenario
from nullpose.solver.result import Stats
from nullpose.solver.rigour import Status
from nullpose.solver.trajectory.course import Aim

_NATS_DB = 10.0 / math.log(10.0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Trajectory:
    """A flight through a scene in motion, and a bound that no flight within the speed limit exceeds.

    Args:
        scenario: in motion.
        maximise: ``worst``, ``mean-db`` or ``mean-rate``: what is maximised over the instants.
        times_s: (t,) the instants.
        poses: the pose at each.
        values: (t,) the objective at each: power ratios, or bits/s/Hz.
        optimum_values: (t,) the best of a vehicle that could be anywhere at once.
        value: what is maximised, in :attr:`unit`.
        upper_bound: no trajectory has more, in the same unit.
        gap_db: asked for.
        bound_name: what the bound is from: ``clairvoyant``, ``key-instants`` or ``prices``.
        baselines: simpler flights by name, in the same unit: ``hover``, ``greedy`` and ``window``, and the
            ``clairvoyant`` bound; None where there is none.
        reason: why the gap was not reached; empty if it was.
        stats: the time that it took; no counts.
    """

    scenario: Scenario
    maximise: Aim
    times_s: FloatArray
    poses: tuple[Pose, ...]
    values: FloatArray
    optimum_values: FloatArray
    value: float
    upper_bound: float
    gap_db: float
    bound_name: str
    baselines: Mapping[str, float | None]
    reason: str
    stats: Stats

    @property
    def quantity(self) -> Quantity:
        """The quantity that is maximised at an instant."""
        return Quantity.of(self.scenario.at(0.0))

    @property
    def unit(self) -> str:
        """The unit of the value: dB, or bits/s/Hz."""
        return unit_of(self.quantity, self.maximise)

    @property
    def ending(self) -> str:
        """The unit at the end of a name."""
        return "db" if self.unit == "dB" else "bps_hz"

    @property
    def gap(self) -> float:
        """How far the bound is above the value, in its unit."""
        return self.upper_bound - self.value

    @property
    def status(self) -> Status:
        """How the solve ended."""
        return Status.CERTIFIED if self.gap <= self.gap_db else Status.GAP_NOT_REACHED

    @property
    def positions_m(self) -> FloatArray:
        """Where the vehicle is at each instant, (t, 3), metres."""
        return np.array([pose.position_m for pose in self.poses])

    @property
    def speeds_m_s(self) -> FloatArray:
        """The speed from each instant to the next, (t - 1,), m/s."""
        steps_m = np.linalg.norm(np.diff(self.positions_m, axis=0), axis=1)
        return np.asarray(steps_m / np.diff(self.times_s))

    @property
    def turn_rates_rad_s(self) -> FloatArray:
        """How fast the body turns from each instant to the next, (t - 1,), rad/s; nothing limits it."""
        turns = rotation_world_from_body(*self._angles())
        between = np.einsum("tji,tjk->tik", turns[:-1], turns[1:])
        cosine = 0.5 * (np.trace(between, axis1=1, axis2=2) - 1.0)
        return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)) / np.diff(self.times_s))

    def _angles(self) -> FloatArray:
        return np.array([(pose.roll_rad, pose.pitch_rad, pose.yaw_rad) for pose in self.poses]).T

    def rows(self) -> list[PlainTable]:
        """List the instants: time, position, attitude, value and the optimum there."""
        quantity = self.quantity
        return [
            {
                "time_s": float(time_s),
                "position_m": pose.position_m.tolist(),
                "wxyz": list(pose_frames(self.scenario, pose).enu.quaternion_wxyz),
                f"value_{quantity.ending}": quantity.in_unit(float(value)),
                f"optimum_{quantity.ending}": quantity.in_unit(float(optimum)),
            }
            for time_s, pose, value, optimum in zip(
                self.times_s, self.poses, self.values, self.optimum_values, strict=True
            )
        ]

    def to_dict(self) -> PlainTable:
        """Return plain data for JSON."""
        ending = self.ending
        return {
            "trajectory": self.rows(),
            "objective": {
                "name": str(self.maximise),
                f"value_{ending}": self.value,
                f"upper_bound_{ending}": self.upper_bound,
                f"gap_{ending}": self.gap,
                "bound": self.bound_name,
            },
            "status": str(self.status),
            "reason": self.reason,
            "baselines": {f"{name}_{ending}": value for name, value in self.baselines.items()},
            "speed_max_m_s": float(np.max(self.speeds_m_s)),
            "turn_rate_max_rad_s": float(np.max(self.turn_rates_rad_s)),
            "stats": {"wall_s": self.stats.wall_s},
        }


def unit_of(quantity: Quantity, aim: Aim) -> str:
    """Return the unit of what is maximised: dB, or bits/s/Hz."""
    return "bits/s/Hz" if quantity.is_rate or aim is Aim.MEAN_RATE else "dB"


def from_nats(quantity: Quantity, aim: Aim, score: float) -> float:
    """Convert a score to the unit of what is maximised."""
    if unit_of(quantity, aim) == "dB":
        return _NATS_DB * score
    return quantity.scale * score / math.log(2.0)
