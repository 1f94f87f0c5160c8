"""Many poses at once, as arrays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import AnyAntenna
from nullpose.errors import checked, require_usage
from nullpose.physics.pose import FARTHEST_M, Pose
from nullpose.physics.rotation import antenna_axis, attitude_from_axis, rotation_world_from_body
from nullpose.physics.types import FloatArray

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
        position_m = np.asarray(self.position_m, dtype=float)
        names = ("roll_rad", "pitch_rad", "yaw_rad")
        angles = [np.asarray(getattr(self, name), dtype=float) for name in names]
        shapes = {"position_m": position_m.shape} | dict(zip(names, (a.shape for a in angles), strict=True))
        counts = {shape[0] for shape in (position_m.shape[:-1], *(a.shape for a in angles)) if shape} or {1}
        mount = np.asarray(self.mount_rad, dtype=float)
        if (
            position_m.shape[-1:] != (3,)
            or position_m.ndim > 2
            or max(a.ndim for a in angles) > 1
            or mount.ndim
        ):
            counts = set()
        require_usage(
            len(counts) == 1,
            f"poses: given {', '.join(f'{name} of shape {shape}' for name, shape in shapes.items())}; "
            "allowed: position_m of shape (n, 3) or (3,), and angles of shape (n,) or one number",
        )
        finite = all(np.all(np.isfinite(each)) for each in (*angles, mount))
        require_usage(
            finite and np.all(np.abs(position_m) <= FARTHEST_M),
            f"poses: a number is not finite or beyond {FARTHEST_M:g} m",
        )
        count = counts.pop()
        object.__setattr__(self, "position_m", np.broadcast_to(position_m, (count, 3)))
        for name, angle in zip(names, angles, strict=True):
            object.__setattr__(self, name, np.broadcast_to(angle, (count,)))

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
