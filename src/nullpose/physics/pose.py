"""A pose: where the drone hovers and how it is turned."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.rotation import antenna_axis, attitude_from_axis
from nullpose.physics.types import FloatArray

__all__ = ["Pose"]


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A position and an attitude, in the world frame (ENU).

    Args:
        position_m: shape ``(3,)``, metres.
        roll_rad: roll of paper eq. 1.1, radians.
        pitch_rad: pitch, radians.
        yaw_rad: yaw, radians.

    Raises:
        ValueError: a number is not finite, or the position has not three components.
    """

    position_m: FloatArray
    roll_rad: float
    pitch_rad: float
    yaw_rad: float = 0.0

    def __post_init__(self) -> None:
        position_m = np.array(self.position_m, dtype=float)
        angles = (float(self.roll_rad), float(self.pitch_rad), float(self.yaw_rad))
        if position_m.shape != (3,) or not np.all(np.isfinite(position_m)) or not np.all(np.isfinite(angles)):
            raise ValueError(
                "a pose takes three finite coordinates and three finite angles; "
                f"given {self.position_m!r}, {angles}"
            )
        position_m.flags.writeable = False
        object.__setattr__(self, "position_m", position_m)
        for name, angle in zip(("roll_rad", "pitch_rad", "yaw_rad"), angles, strict=True):
            object.__setattr__(self, name, angle)

    @classmethod
    def from_axis(cls, position_m: ArrayLike, axis: ArrayLike, yaw_rad: float = 0.0) -> Pose:
        """Return the pose at a position whose dipole lies along an axis.

        Args:
            position_m: shape ``(3,)``, metres.
            axis: the dipole's direction, shape ``(3,)``, of any length but zero and of either sign.
            yaw_rad: the yaw to hold, radians; the dipole's symmetry leaves it free.
        """
        roll_rad, pitch_rad = attitude_from_axis(axis, yaw_rad)
        return cls(np.asarray(position_m, dtype=float), float(roll_rad), float(pitch_rad), yaw_rad)

    @property
    def antenna_axis(self) -> FloatArray:
        """Unit vector along the dipole, shape ``(3,)``, world frame (paper eq. 1.1)."""
        return antenna_axis(self.roll_rad, self.pitch_rad, self.yaw_rad)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Pose):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[float, ...]:
        return (*(float(x) for x in self.position_m), self.roll_rad, self.pitch_rad, self.yaw_rad)
