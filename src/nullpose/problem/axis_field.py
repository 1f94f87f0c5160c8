"""Which axes a scheme or an airframe may use at each position."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.errors import require_usage
from nullpose.problem.records import AFFINE_AXIS, BAND_AXIS, CONE_AXIS, FREE_AXIS, NARROW_AXIS, Axes
from nullpose.scenario.section import read_only

_NARROW = 0.1  # difference of a band's ends below which a straight step of the axis leaves it too soon


@dataclass(frozen=True, slots=True, eq=False)
class AxisField:
    """A free axis, perhaps within a band of elevations, or one that the position determines.

    The latter is ``u(p) = offset + matrix p``, of any length. A band holds the unit axes with ``c_lo <= u_z^2
    <= c_hi``: what a dipole mounted at an angle from the body's vertical reaches on a vehicle that can tilt
    by so much, its yaw free.

    The paper's three fixed orientations are all affine in the position once their length is left out, which
    the ratios do not depend on: vertical ``e3``; zero interference ``m - p``; maximum gain
    ``(s1 - p) x (s2 - p) = s1 x s2 + (s2 - s1) x p``.

    Args:
        is_free: whether the axis is to be chosen; the arrays are then zero.
        offset: shape ``(3,)``.
        matrix: shape ``(3, 3)``.
        band: least and greatest ``u_z^2`` of a free axis.
    """

    is_free: bool
    offset: NDArray[np.float64]
    matrix: NDArray[np.float64]
    band: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        for name, shape in (("offset", (3,)), ("matrix", (3, 3))):
            array = np.array(getattr(self, name), dtype=float)
            require_usage(
                array.shape == shape and np.all(np.isfinite(array)),
                f"axis field {name} must be finite, of shape {shape}; given {array.tolist()}",
            )
            object.__setattr__(self, name, read_only(array, shape))
        low, high = self.band
        require_usage(
            0.0 <= low <= high <= 1.0,
            f"axis field band must be 0 <= low <= high <= 1; given {self.band!r}",
        )

    @classmethod
    def free(cls) -> AxisField:
        """Build the field that leaves the axis to the solver."""
        return cls(is_free=True, offset=np.zeros(3), matrix=np.zeros((3, 3)))

    @classmethod
    @cache
    def within(cls, least: float, greatest: float) -> AxisField:
        """Build the field of all axes with ``least <= u_z^2 <= greatest``, the vertical one if both are 1.

        Args:
            least: smallest squared vertical component of a unit axis.
            greatest: largest.

        Raises:
            ValueError: not ``0 <= least <= greatest <= 1``.
        """
        if least == greatest == 1.0:
            return cls.vertical()
        return cls(is_free=True, offset=np.zeros(3), matrix=np.zeros((3, 3)), band=(least, greatest))

    @classmethod
    def affine(cls, offset: ArrayLike, matrix: ArrayLike) -> AxisField:
        """Build the field ``u(p) = offset + matrix p``, of shapes ``(3,)`` and ``(3, 3)``."""
        return cls(
            is_free=False, offset=np.asarray(offset, dtype=float), matrix=np.asarray(matrix, dtype=float)
        )

    @classmethod
    def vertical(cls) -> AxisField:
        """Build the field that is vertical everywhere (paper section 4, case 4)."""
        return cls.affine([0.0, 0.0, 1.0], np.zeros((3, 3)))

    @classmethod
    def towards(cls, point_m: ArrayLike) -> AxisField:
        """Build the field ``u(p) = q - p``, a null on q (paper eq. 3.1, its length left out)."""
        return cls.affine(point_m, -np.eye(3))

    @classmethod
    def broadside(cls, first_m: ArrayLike, second_m: ArrayLike) -> AxisField:
        """Build the field ``(s1 - p) x (s2 - p) = s1 x s2 + (s2 - s1) x p`` (eq. 3.4, of any length)."""
        first, second = np.asarray(first_m, dtype=float), np.asarray(second_m, dtype=float)
        x, y, z = second - first
        return cls.affine(np.cross(first, second), np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]))

    def axis_at(self, position_m: ArrayLike) -> NDArray[np.float64]:
        """Return the unit axis of an affine field, shape (..., 3); not a number where the field vanishes.

        Args:
            position_m: shape (..., 3), metres.
        """
        axis = self.offset + np.asarray(position_m, dtype=float) @ self.matrix.T
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(axis / np.linalg.norm(axis, axis=-1, keepdims=True))

    @property
    def arrays(self) -> Axes:
        """The field as the kernels take it: (kind, offset, matrix).

        The ends of a band stand in place of the offset's first two numbers. A band whose ends are one is a
        cone. One that is narrow, and does not hold the vertical, is a kind of its own for the search alone.
        """
        low, high = self.band
        # writable copies, as those are that kernels make: they are compiled for one kind of array
        offset, matrix = self.offset.copy(), self.matrix.copy()
        if not self.is_free:
            return Axes(AFFINE_AXIS, offset, matrix)
        offset[:2] = low, high
        wide = FREE_AXIS if (low, high) == (0.0, 1.0) else BAND_AXIS
        narrow = CONE_AXIS if low == high else NARROW_AXIS
        return Axes(narrow if high < 1.0 and high < low + _NARROW else wide, offset, matrix)
