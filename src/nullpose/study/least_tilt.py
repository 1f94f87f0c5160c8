"""The least vehicle that suffices: for each mount of the antenna, the least tilt with a good enough pose.

More tilt never lowers the best value, since it allows more axes. So the tilts that suffice begin at one
angle. Each solve shows that its tilt suffices, by a pose, or that it does not, by its upper bound.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Unpack

import numpy as np

from nullpose.errors import SolveError, checked, require_usage
from nullpose.files import PlainTable
from nullpose.objectives import FloatArray
from nullpose.physics import Pose
from nullpose.scenario import Airframe, Scenario
from nullpose.solver import Result, SolveKeywords, Status, solve
from nullpose.solver.rigour import Rigour
from nullpose.study.case import SHARE, OnProgress, report_steps
from nullpose.study.vehicle_search import AS_NEEDED, LEAST_GAP, Sufficiency, VehicleSearch, required

MOUNTS_DEG = (0.0, 45.0, 90.0)
"""The mounts that are looked at unless others are stated."""
STEP_DEG = 0.1
"""How near a tilt that suffices and one that does not come to each other."""
_MOST_STEPS = 1800
_GRID_DEG = 5.0  # of the best mount, where one on it needs no more tilt than any other
_GAP = 1e-3  # of the omnidirectional vehicle, and of values by angle
_ANGLES = 46  # of a figure, every 2 degrees
_SAME_TILT = 1e-6  # of a step, by rounding


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MountTilt:
    """The tilts that a mount of the antenna takes.

    Args:
        mount_deg: angle between the antenna and the body's vertical.
        suffices_deg: a tilt with which a pose is proved to reach the share; None if none was found.
        result: the pose with that tilt; its bound is that of the omnidirectional vehicle.
        fails_deg: a tilt with which no pose reaches the share; None where a level vehicle suffices.
        upper_bound: that no pose with that tilt exceeds.
        reason: why the two are further apart than a step, or one is missing; empty if neither.
    """

    mount_deg: float
    suffices_deg: float | None = None
    result: Result | None = None
    fails_deg: float | None = None
    upper_bound: float | None = None
    reason: str = ""

    @property
    def value(self) -> float | None:
        """The value with the tilt that suffices."""
        return None if self.result is None else self.result.objective.value

    @property
    def pose(self) -> Pose | None:
        """The pose with the tilt that suffices."""
        return None if self.result is None else self.result.pose

    @property
    def is_known(self) -> bool:
        """Whether both sides are known, a step apart; a level vehicle that suffices needs no other side."""
        too_little_deg = -STEP_DEG if self.fails_deg is None else self.fails_deg
        return self.suffices_deg is not None and self.suffices_deg - too_little_deg < 1.5 * STEP_DEG

    def to_dict(self) -> PlainTable:
        """Write the two sides as plain data."""
        return {
            key: getattr(self, key)
            for key in ("mount_deg", "suffices_deg", "value", "fails_deg", "upper_bound", "reason")
        }


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LeastTilt:
    """The least tilt for several mounts, and the mount that needs least.

    Args:
        share: of the omnidirectional value that is to be reached.
        omnidirectional: the best pose of a vehicle that takes any attitude.
        mounts: the two sides of each mount.
        best: those of the mount that needs least tilt; None for an antenna that has no axis.
        rigour: of the least sure bound.
        seconds: how long it took.
    """

    share: float
    omnidirectional: Result
    mounts: tuple[MountTilt, ...]
    best: MountTilt | None
    rigour: Rigour
    seconds: float

    @property
    def target(self) -> float:
        """The value that suffices: the share of the omnidirectional vehicle's upper bound."""
        return required(self.omnidirectional.objective, self.share)

    def to_dict(self) -> PlainTable:
        """Write everything but the poses as plain data for JSON."""
        value = self.omnidirectional.objective.value
        return {
            "target": {"share": self.share, "value": self.target, "omnidirectional_value": value},
            "mounts": [mount.to_dict() for mount in self.mounts],
            "best": None if self.best is None else self.best.to_dict(),
            "rigour": str(self.rigour),
            "seconds": self.seconds,
        }


@checked
def least_tilt(
    scenario: Scenario,
    *,
    share: float = SHARE,
    mounts_deg: Sequence[float] = MOUNTS_DEG,
    on_progress: OnProgress = None,
    **options: Unpack[SolveKeywords],
) -> LeastTilt:
    """Find the least tilt with which a vehicle reaches a share of what any pose can.

    Of every mount, and of the best one. A level vehicle with free yaw reaches every axis at the angle of its
    mount, so the mount of the best pose needs no tilt at all.

    Args:
        scenario: what is asked for; its airframe and its array are left out.
        share: of the value (a power ratio or a rate) of the vehicle that takes any attitude, at most 1;
            proofs come as near as 1e-7.
        mounts_deg: angles between the antenna and the body's vertical, 0 to 90; none for the best one alone.
        on_progress: called with how many mounts are done and how many there are.
        options: as for :func:`nullpose.solver.solve`; the gap is chosen by the share unless it is stated.

    Raises:
        UsageError: a share or a mount that is not allowed.
        SolveError: no pose of the omnidirectional vehicle reaches every node.

    Example:
        >>> import nullpose
        >>> found = nullpose.least_tilt(nullpose.load("examples/paper.toml"))
        >>> [(mount.mount_deg, mount.suffices_deg) for mount in found.mounts]
        [(0.0, 75.4), (45.0, 30.4), (90.0, 6.1)]
        >>> found.best.mount_deg, found.best.suffices_deg
        (80.0, 0.0)
    """
    require_usage(0.0 < share <= 1.0, f"share (--reach): given {share!r}; allowed: above 0 to 1")
    for mount_deg in mounts_deg:
        require_usage(
            0.0 <= mount_deg <= 90.0,
            f"mount: given {mount_deg!r} degrees; allowed: 0 (upright) to 90 (flat)",
        )
    require_usage(
        mounts_deg or scenario.antenna_record.is_axisymmetric,
        f"mount: given best with a {scenario.antenna_record.label}, which has no axis; state its degrees",
    )
    began, search = time.perf_counter(), tilt_search(scenario, share, options)
    finders: list[Callable[[], MountTilt | None]] = [partial(search.sides, each) for each in mounts_deg]
    finders.append(search.best if scenario.antenna_record.is_axisymmetric else lambda: None)
    *mounts, best = [find() for find in report_steps(finders, on_progress)]
    return LeastTilt(
        share=share,
        omnidirectional=search.whole,
        mounts=tuple(filter(None, mounts)),
        best=best,
        rigour=search.rigour,
        seconds=time.perf_counter() - began,
    )


def tilt_search(scenario: Scenario, share: float, options: SolveKeywords) -> TiltSearch:
    """Solve a scenario for a vehicle that takes any attitude, to go on with its tilts.

    Args:
        scenario: its airframe and its array are left out.
        share: above 0, at most 1.
        options: as for :func:`nullpose.solver.solve`; the gap is chosen by the share unless it is stated.

    Raises:
        KeyboardInterrupt: Ctrl-C ended the proof.
        SolveError: no pose reaches every node.
    """
    gap = min(max(0.1 * (1.0 - share), LEAST_GAP), _GAP) if options.get("gap") is None else options["gap"]
    search = TiltSearch(
        scenario.without_array.model_copy(update={"airframe": None}), share, options | {"gap": gap}
    )
    uninterrupted(search.whole)
    return search


def values_by_angle(
    found: LeastTilt,
    *,
    on_progress: OnProgress = None,
    **options: Unpack[SolveKeywords],
) -> tuple[FloatArray, FloatArray]:
    """Find the best value at each angle between the antenna and the vertical: what a level vehicle reaches.

    With a tilt t and a mount m a vehicle reaches the angles from m - t to m + t, and the best value of these.

    Args:
        found: with the scenario.
        on_progress: called with how many angles are done and how many there are.
        options: as for :func:`nullpose.solver.solve`; the gap is 1e-3 unless it is stated.

    Returns:
        Angles [deg] and values, (n,) each; the best pose's angle is one of them.

    Raises:
        UsageError: the antenna is not the same all round its axis and upside down.
    """
    scenario = found.omnidirectional.scenario
    antenna = scenario.antenna_record
    require_usage(
        antenna.is_axisymmetric and antenna.is_even,
        f"values by angle: given a {antenna.label}; allowed: one that is the same all round its axis and "
        "upside down",
    )
    angles_deg, values = np.linspace(0.0, 90.0, _ANGLES), []
    options["gap"] = options.get("gap") or _GAP
    for angle_deg in report_steps(angles_deg.tolist(), on_progress):
        level = Airframe(tilt_max_deg=0.0, mount_deg=angle_deg)
        try:
            result = uninterrupted(solve(scenario.model_copy(update={"airframe": level}), **options))
            values.append(result.objective.value)
        except SolveError:  # no pose at that angle reaches every node
            values.append(0.0)
    best_deg = angle_from_vertical_deg(found.omnidirectional)
    return np.append(angles_deg, best_deg), np.append(values, found.omnidirectional.objective.value)


def angle_from_vertical_deg(result: Result) -> float:
    """Measure the angle between the antenna and the vertical [deg]; folded where both ends are alike."""
    upwards = float(result.pose.antenna_axis[2])
    upwards = abs(upwards) if result.scenario.antenna_record.is_even else upwards
    return math.degrees(math.acos(min(1.0, max(-1.0, upwards))))


class TiltSearch(VehicleSearch):
    """The solves of one scenario, at tilts in steps."""

    def sides(self, mount_deg: float) -> MountTilt:
        """Find a tilt that suffices and one that does not, as near to each other as may be.

        Raises:
            KeyboardInterrupt: Ctrl-C ended a proof.
        """
        good, bad, reason = self._at_least_tilt(self.whole, mount_deg), None, ""
        least, most, steps = _MOST_STEPS if good is None else _steps(good), -1, 0
        while least - most > 1 and not reason:
            tilt = Airframe(tilt_max_deg=_degrees(steps), mount_deg=mount_deg)
            try:
                result = uninterrupted(self.solved(tilt))
            except SolveError:  # which proves nothing
                reason = "no pose was found that reaches every node"
                continue
            if (other := self._at_least_tilt(result, mount_deg)) is not None:
                least, good = min(_steps(other), steps), other
            elif self.judge(result) is Sufficiency.FALLS_SHORT:
                most, bad = steps, result
            else:
                reason = self.whole.reason or result.reason.replace(AS_NEEDED, "") or "proofs come no nearer"
            steps = (least + most) // 2
        return MountTilt(
            mount_deg=mount_deg,
            suffices_deg=None if good is None else _degrees(least),
            result=good,
            fails_deg=None if bad is None else _degrees(most),
            upper_bound=None if bad is None else bad.objective.upper_bound,
            reason=reason,
        )

    def _at_least_tilt(self, result: Result, mount_deg: float) -> Result | None:
        """Fly a result's pose by the least tilt; None where it does not suffice."""
        flown = self.flown(result, Airframe(tilt_max_deg=180.0, mount_deg=mount_deg))
        return flown if self.judge(flown) is Sufficiency.SUFFICES else None

    def result_of(self, mount: MountTilt) -> Result:
        """Fly a mount's pose, certified where both sides are proved; the best of all without a tilt."""
        result = mount.result or self.flown(
            self.whole, Airframe(tilt_max_deg=180.0, mount_deg=mount.mount_deg)
        )
        return replace(
            result,
            status=Status.CERTIFIED if mount.is_known else Status.GAP_NOT_REACHED,
            reason="" if mount.is_known else "the least tilt is not known to a step",
            objective=replace(result.objective, rigour=self.rigour),
        )

    def best(self) -> MountTilt:
        """Find the mount that needs least tilt: on a grid, or else that of the best pose."""
        angle_deg = min(90.0, angle_from_vertical_deg(self.whole))
        found: list[MountTilt] = []
        for mount_deg in (_GRID_DEG * round(angle_deg / _GRID_DEG), round(angle_deg, 1), angle_deg):
            found.append(self.sides(mount_deg))
            if found[-1].suffices_deg == 0.0:
                break
        return min(found, key=lambda each: math.inf if each.suffices_deg is None else each.suffices_deg)


def _steps(result: Result) -> int:
    return math.ceil(math.degrees(result.pose.tilt_rad) / STEP_DEG - _SAME_TILT)


def _degrees(steps: int) -> float:
    return round(steps * STEP_DEG, 6)


def uninterrupted(result: Result) -> Result:
    """Go on with an interrupt that ended a proof.

    Raises:
        KeyboardInterrupt: it did.
    """
    if result.interrupted:
        raise KeyboardInterrupt
    return result
