"""A pose: where the drone hovers and how it is turned; and many poses at once, as arrays."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import AnyAntenna
from nullpose.errors import checked, require_usage
from nullpose.physics.rotation import (
    antenna_axis,
    attitude_from_axis,
    attitude_of,
    attitude_of_axis,
    rotation_world_from_body,
)
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario
from nullpose.scenario.section import read_only

FARTHEST_M = 1e100
"""How far from the origin a pose may be, along each axis [m]: the square of a distance is still a number."""


def as_position(position_m: ArrayLike) -> FloatArray:
    """Check one position, shape ``(3,)``, metres, and copy it.

    Raises:
        UsageError: it has another shape, or a number is not finite.

    Example:
        >>> as_position([0, 0, 8])
        array([0., 0., 8.])
    """
    position = np.array(position_m, dtype=float)
    require_usage(
        position.shape == (3,),
        f"position_m: given an array of shape {position.shape}; allowed: three finite numbers, metres, "
        "an array of shape (3,); of several positions give one at a time, as in positions_m[0]",
    )
    require_usage(
        np.all(np.abs(position) <= FARTHEST_M),
        f"position_m: given {position.tolist()}; allowed: three finite numbers, metres, up to {FARTHEST_M:g}",
    )
    return position


@checked
@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A position and an attitude, in the world frame (ENU).

    Args:
        position_m: shape ``(3,)``, metres.
        roll_rad: roll of paper eq. 1.1, radians.
        pitch_rad: pitch, radians.
        yaw_rad: yaw, radians.
        mount_rad: angle of the dipole from the body's vertical, towards the body's x axis, radians.

    Raises:
        UsageError: a number is not finite, or the position has another shape.

    Example:
        >>> import math
        >>> import nullpose
        >>> pose = nullpose.Pose([0.0, 25.0, 8.0], roll_rad=0.0, pitch_rad=math.radians(-30.0))
        >>> pose.antenna_axis.round(3) + 0.0
        array([-0.5  ,  0.   ,  0.866])
    """

    position_m: FloatArray
    roll_rad: float
    pitch_rad: float
    yaw_rad: float = 0.0
    mount_rad: float = 0.0

    def __post_init__(self) -> None:
        position_m = as_position(self.position_m)
        names = ("roll_rad", "pitch_rad", "yaw_rad", "mount_rad")
        angles = tuple(float(getattr(self, name)) for name in names)
        require_usage(
            all(map(math.isfinite, angles)),
            f"{', '.join(names)}: given {angles}; allowed: finite angles, radians",
        )
        object.__setattr__(self, "position_m", read_only(position_m, (3,)))
        for name, angle in zip(names, angles, strict=True):
            object.__setattr__(self, name, angle)

    @classmethod
    @checked
    def from_axis(cls, position_m: ArrayLike, axis: ArrayLike, yaw_rad: float = 0.0) -> Pose:
        """Return the pose at a position whose dipole lies along an axis.

        Args:
            position_m: shape ``(3,)``, metres.
            axis: the dipole's direction, shape ``(3,)``, of any length but zero and of either sign.
            yaw_rad: the yaw to hold, radians; the dipole's symmetry leaves it free.
        """
        roll_rad, pitch_rad = attitude_from_axis(axis, yaw_rad)
        return cls(np.asarray(position_m, dtype=float), float(roll_rad), float(pitch_rad), yaw_rad)

    @classmethod
    @checked
    def of_airframe(cls, scenario: Scenario, position_m: ArrayLike, axis: ArrayLike) -> Pose:
        """Turn the scenario's vehicle so that its antenna lies along an axis, by the least tilt and then yaw.

        Every reported attitude comes from here, so that the same axis has the same angles everywhere.

        Args:
            scenario: with its airframe; without one the antenna is upright on the body, which takes any
                attitude.
            position_m: shape ``(3,)``, metres.
            axis: the dipole's direction, shape ``(3,)``, of any length but zero; one that is reached. Or the
                rotation to the world from the antenna's axes, shape ``(3, 3)``, of which only the axis counts
                for an antenna that is the same all round.
        """
        airframe, antenna = scenario.airframe, scenario.antenna_record
        tilt_max_rad, mount_rad = (
            (math.pi, 0.0) if airframe is None else (airframe.tilt_max_rad, airframe.mount_rad)
        )
        if (axis := np.asarray(axis, dtype=float)).ndim == 2 and not antenna.is_axisymmetric:
            angles = attitude_of(axis @ rotation_world_from_body(0.0, mount_rad, 0.0).T, tilt_max_rad)
        else:
            along = axis[:, 2] if axis.ndim == 2 else axis
            angles = attitude_of_axis(along, tilt_max_rad, mount_rad, is_even=antenna.is_even)
        return cls(np.asarray(position_m, dtype=float), *angles, mount_rad)

    @property
    def antenna_axis(self) -> FloatArray:
        """Unit vector along the dipole, shape ``(3,)``, world frame (paper eq. 1.1)."""
        return antenna_axis(self.roll_rad, self.pitch_rad, self.yaw_rad, self.mount_rad)

    @property
    def rotation_world_from_antenna(self) -> FloatArray:
        """Rotation to the world from the antenna's axes, the third along the dipole, ``(3, 3)``."""
        body = rotation_world_from_body(self.roll_rad, self.pitch_rad, self.yaw_rad)
        return np.asarray(body @ rotation_world_from_body(0.0, self.mount_rad, 0.0))

    def orientation(self, antenna: AnyAntenna) -> FloatArray:
        """Orient an antenna, as its gain needs it.

        Returns:
            Unit axis, shape ``(3,)``; for an antenna with a pattern the rotation to the world from its axes,
            ``(3, 3)``.
        """
        return self.antenna_axis if antenna.is_quadratic else self.rotation_world_from_antenna

    @property
    def tilt_rad(self) -> float:
        """Angle between the body's vertical and the world's, radians."""
        if self.roll_rad == 0.0 and abs(self.pitch_rad) <= math.pi:
            return abs(self.pitch_rad)  # to the last digit
        across = np.hypot(np.sin(self.roll_rad), np.cos(self.roll_rad) * np.sin(self.pitch_rad))
        return float(np.arctan2(across, np.cos(self.roll_rad) * np.cos(self.pitch_rad)))

    def to_dict(self) -> dict[str, object]:
        """Return the pose as plain data for JSON, angles in radians."""
        angles = ("roll_rad", "pitch_rad", "yaw_rad", "tilt_rad", "mount_rad")
        return {
            "position_m": [float(x) for x in self.position_m],
            **{name: getattr(self, name) for name in angles},
            "antenna_axis": [float(x) for x in self.antenna_axis],
        }

    def __eq__(self, other: object) -> bool:
        return NotImplemented if not isinstance(other, Pose) else self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[float, ...]:
        angles = (self.roll_rad, self.pitch_rad, self.yaw_rad, self.mount_rad)
        return (*(float(x) for x in self.position_m), *angles)


_BLOCK = 8192  # poses worked out together: their arrays stay in the processor's cache


@checked
@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """Many positions and attitudes in the world frame (ENU), as arrays; ``poses[i]`` is one :class:`Pose`.

    Args:
        position_m: shape ``(n, 3)``, metres; or ``(3,)``, the same position for every attitude.
        roll_rad: roll of paper eq. 1.1, shape ``(n,)`` or one number for all, radians.
        pitch_rad: pitch, likewise.
        yaw_rad: yaw, likewise.
        mount_rad: angle of the dipole from the body's vertical, towards the body's x axis, radians.

    Raises:
        UsageError: the shapes do not go together, or a number is not finite.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> poses = nullpose.Poses([-2.2, 23.8, 8.0], roll_rad=-0.3, pitch_rad=[-1.5, -1.4, -1.3])
        >>> nullpose.min_sinr(scenario, poses).round(3)
        array([1.2  , 1.248, 1.22 ])
    """

    position_m: FloatArray
    roll_rad: FloatArray
    pitch_rad: FloatArray
    yaw_rad: FloatArray | float = 0.0
    mount_rad: float = 0.0

    def __post_init__(self) -> None:
        names = ("position_m", "roll_rad", "pitch_rad", "yaw_rad")
        position_m, *angles = (np.asarray(getattr(self, name), dtype=float) for name in names)
        shapes = [position_m.shape, *(angle.shape for angle in angles)]
        counts = {shape[0] for shape in (position_m.shape[:-1], *shapes[1:]) if shape} or {1}
        fits = position_m.shape[-1:] == (3,) and max(position_m.ndim - 1, *(a.ndim for a in angles)) <= 1
        require_usage(
            fits and len(counts) == 1 and np.ndim(self.mount_rad) == 0,
            f"poses: given {', '.join(map('{} of shape {}'.format, names, shapes))}; "
            "allowed: position_m of shape (n, 3) or (3,), and angles of shape (n,) or one number",
        )
        finite = all(np.all(np.isfinite(each)) for each in (*angles, np.array(self.mount_rad)))
        require_usage(
            finite and np.all(np.abs(position_m) <= FARTHEST_M),
            f"poses: a number is not finite or beyond {FARTHEST_M:g} m",
        )
        object.__setattr__(self, "position_m", np.broadcast_to(position_m, (*counts, 3)))
        for name, angle in zip(names[1:], angles, strict=True):
            object.__setattr__(self, name, np.broadcast_to(angle, tuple(counts)))

    @classmethod
    @checked
    def from_axis(cls, position_m: ArrayLike, axis: ArrayLike) -> Poses:
        """Return the poses at yaw 0 whose dipoles lie along axes.

        Args:
            position_m: shape ``(n, 3)`` or ``(3,)``, metres.
            axis: directions, shape ``(n, 3)`` or ``(3,)``, of any length but zero and of either sign.

        Raises:
            UsageError: the shapes do not go together, or a number is not finite.
        """
        roll_rad, pitch_rad = attitude_from_axis(axis)
        return cls(np.asarray(position_m, dtype=float), roll_rad, pitch_rad)

    def __len__(self) -> int:
        return len(self.position_m)

    def __iter__(self) -> Iterator[Pose]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, index: int) -> Pose:
        roll, pitch, yaw = (
            float(angle[index]) for angle in (self.roll_rad, self.pitch_rad, np.asarray(self.yaw_rad))
        )
        return Pose(self.position_m[index], roll, pitch, yaw, self.mount_rad)

    def orientation(self, antenna: AnyAntenna) -> FloatArray:
        """Orient an antenna at every pose, as :meth:`Pose.orientation` does.

        Returns:
            Unit axes, shape ``(n, 3)``, or rotations to the world from the antenna's axes, ``(n, 3, 3)``.
        """
        angles = (self.roll_rad, self.pitch_rad, self.yaw_rad)
        if antenna.is_quadratic:
            return antenna_axis(*angles, self.mount_rad)
        return np.asarray(
            rotation_world_from_body(*angles) @ rotation_world_from_body(0.0, self.mount_rad, 0.0)
        )

    def blocks(self) -> Iterator[Poses]:
        """Yield the poses in order, some thousands at a time; one empty block if there are none."""
        names = ("position_m", "roll_rad", "pitch_rad", "yaw_rad")
        for start in range(0, max(1, len(self)), _BLOCK):
            block = slice(start, start + _BLOCK)
            yield replace(self, **{name: getattr(self, name)[block] for name in names})
