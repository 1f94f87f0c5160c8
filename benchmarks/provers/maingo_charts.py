"""Two ways to write the axis for MAiNGO, which relaxes functions of the few variables that it branches on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from benchmarks.provers.problem import Scaled

__all__ = ["AimChart", "AxisChart", "Chart"]

FloatArray = NDArray[np.float64]

_STEEPEST_RAD = 1.3  # beyond it the plane's points run away


class Chart(Protocol):
    """A parametrisation of the axis.

    Args:
        names: of its variables.
        bounds: of each of them.
        start: their values at the start.
        normed: whether the axis has to be held to length 1.
    """

    names: Sequence[str]
    bounds: Sequence[tuple[float, float]]
    start: Sequence[float]
    normed: bool

    def __init__(self, scaled: Scaled) -> None: ...

    def axis(self, own: Sequence[Any], position: Sequence[Any]) -> list[Any]:
        """Return the axis, not of length 1 if the chart is not normed, from numbers or expressions."""

    def swing(self, own: Sequence[Any], to_jammer: Sequence[Any]) -> tuple[list[Any], float]:
        """Return a vector whose cross product with the jammer's is the axis's, and the factor left out."""


class AxisChart:
    """The unit vector itself, on the upper half sphere."""

    names = ("ux", "uy", "uz")
    bounds = ((-1.0, 1.0), (-1.0, 1.0), (0.0, 1.0))
    normed = True

    def __init__(self, scaled: Scaled) -> None:
        self.start = [float(x) for x in scaled.start[1]]

    def axis(self, own: Sequence[Any], position: Sequence[Any]) -> list[Any]:
        """Return the variables themselves."""
        return list(own)

    def swing(self, own: Sequence[Any], to_jammer: Sequence[Any]) -> tuple[list[Any], float]:
        """Return the axis, nothing left out."""
        return list(own), 1.0


class AimChart:
    """The axis from the drone to a point of a plane through the jammer, in units that strong jamming shrinks.

    ``u = b + w / sqrt(J)`` with b the jammer's direction and w in the plane: ``u x b = w x b / sqrt(J)``, so
    that J drops out of the interference.
    """

    names = ("aim1", "aim2")
    normed = False

    def __init__(self, scaled: Scaled) -> None:
        low, high = scaled.box
        normal = scaled.jammer - (low + high) / 2.0
        normal /= np.linalg.norm(normal)
        first = np.cross(normal, [0.0, 0.0, 1.0])
        first /= np.linalg.norm(first)
        self._jammer, self._plane = scaled.jammer, (first, np.cross(normal, first))
        self._grown = math.sqrt(scaled.jamming)
        most = self._largest(scaled, normal)
        self.bounds = ((-most, most), (-most, most))
        self.start = self._aim(scaled, normal)

    def axis(self, own: Sequence[Any], position: Sequence[Any]) -> list[Any]:
        """Return the vector from the drone to the point."""
        w = self._in_plane(own)
        return [
            float(m) - x + y * (1.0 / self._grown) for m, x, y in zip(self._jammer, position, w, strict=True)
        ]

    def swing(self, own: Sequence[Any], to_jammer: Sequence[Any]) -> tuple[list[Any], float]:
        """Return the point's offset from the jammer, grown."""
        return self._in_plane(own), self._grown

    def _in_plane(self, own: Sequence[Any]) -> list[Any]:
        return [own[0] * float(a) + own[1] * float(b) for a, b in zip(*self._plane, strict=True)]

    def _largest(self, scaled: Scaled, normal: FloatArray) -> float:
        """Return how far from the jammer, grown, the axis of a pose as good as the start may aim.

        Raises:
            ValueError: so weak a jammer bounds nothing, or the plane is too steep for part of the box.
        """
        low, high = scaled.box
        corners = np.array(list(product(*zip(low, high, strict=True))))
        depths = (scaled.jammer - corners) @ normal
        slant = np.min(depths / np.linalg.norm(scaled.jammer - corners, axis=1))
        far = scaled.squared_distances(scaled.jammer)[1]
        sine2 = far * (scaled.budget - scaled.noise) / scaled.jamming
        if sine2 >= 1.0 or slant <= 0.0:
            raise ValueError("the plane through the jammer is met by no bounded set of axes")
        widest, swing = math.acos(slant), math.asin(math.sqrt(sine2))
        if widest + swing > _STEEPEST_RAD:
            raise ValueError("some axes nearly miss the plane through the jammer")
        # seen from a depth, the tangent grows fastest where the jammer is seen most slantedly
        reach = float(np.max(depths)) * (math.tan(widest + swing) - math.tan(widest))
        return reach * self._grown

    def _aim(self, scaled: Scaled, normal: FloatArray) -> list[float]:
        position, axis = scaled.start
        to_jammer = scaled.jammer - position
        point = axis * (to_jammer @ normal) / (axis @ normal)
        return [float((point - to_jammer) @ e) * self._grown for e in self._plane]
