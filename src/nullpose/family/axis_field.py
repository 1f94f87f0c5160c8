"""Which axes a scheme may use at each position."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["AxisField"]

AxisFieldArrays: TypeAlias = tuple[int, NDArray[np.float64], NDArray[np.float64]]


@dataclass(frozen=True, slots=True, eq=False)
class AxisField:
    """A free axis, or one that the position determines: ``u(p) = offset + matrix p``, of any length.

    The paper's three fixed orientations are all affine in the position once their length is left out, which
    the ratios do not depend on: vertical ``e3``; zero interference ``m - p``; maximum gain
    ``(s1 - p) x (s2 - p) = s1 x s2 + (s2 - s1) x p``.

    Args:
        is_free: whether the axis is to be chosen; the arrays are then zero.
        offset: shape ``(3,)``.
        matrix: shape ``(3, 3)``.
    """

    is_free: bool
    offset: NDArray[np.float64]
    matrix: NDArray[np.float64]

    def __post_init__(self) -> None:
        for name, shape in (("offset", (3,)), ("matrix", (3, 3))):
            array = np.array(getattr(self, name), dtype=float)
            if array.shape != shape or not np.all(np.isfinite(array)):
                raise ValueError(f"axis field {name} must be finite, of shape {shape}; given {array!r}")
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @classmethod
    def free(cls) -> AxisField:
        """Return the field that leaves the axis to the solver."""
        return cls(is_free=True, offset=np.zeros(3), matrix=np.zeros((3, 3)))

    @classmethod
    def affine(cls, offset: ArrayLike, matrix: ArrayLike) -> AxisField:
        """Return the field ``u(p) = offset + matrix p``.

        Args:
            offset: shape ``(3,)``.
            matrix: shape ``(3, 3)``.
        """
        return cls(
            is_free=False, offset=np.asarray(offset, dtype=float), matrix=np.asarray(matrix, dtype=float)
        )

    @classmethod
    def vertical(cls) -> AxisField:
        """Return the field that is vertical everywhere (paper section 4, case 4)."""
        return cls.affine([0.0, 0.0, 1.0], np.zeros((3, 3)))

    @classmethod
    def towards(cls, point_m: ArrayLike) -> AxisField:
        """Return the field ``u(p) = q - p``, a null on q (paper eq. 3.1, its length left out).

        Args:
            point_m: ``q``, shape ``(3,)``, metres.
        """
        return cls.affine(point_m, -np.eye(3))

    @classmethod
    def broadside(cls, first_m: ArrayLike, second_m: ArrayLike) -> AxisField:
        """Return the field ``(s1 - p) x (s2 - p) = s1 x s2 + (s2 - s1) x p`` (paper eq. 3.4, any length).

        Args:
            first_m: ``s1``, shape ``(3,)``, metres.
            second_m: ``s2``, shape ``(3,)``, metres.
        """
        first, second = np.asarray(first_m, dtype=float), np.asarray(second_m, dtype=float)
        x, y, z = second - first
        matrix = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        return cls.affine(np.cross(first, second), matrix)

    @property
    def arrays(self) -> AxisFieldArrays:
        """The field as the kernels take it: (0 free or 1 affine, offset, matrix)."""
        return (0 if self.is_free else 1, self.offset, self.matrix)
