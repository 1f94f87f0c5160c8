"""Antennas whose power gain is a quadratic form of their axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from nullpose.antenna.harmonics import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class QuadraticAntenna:
    """An antenna of gain ``g = (1 - e) sin^2(gamma) + e``: 1 broadside, and e along its axis.

    Its link to a point at r, gain over squared distance, is ``u^T M(r) u`` for a unit axis u, with
    ``M(r) = (1 - e) T(r) + e I / |r|^2`` and ``T(r) = (|r|^2 I - r r^T) / |r|^4``. Solver and certificate
    need no more than e of it. It is polarised as a short dipole is.

    Args:
        name: as in a scenario file.
        label: in sentences and tables.
        leak: e, the gain along the axis, a power ratio from 0 to 1; 0 is a perfect null.
    """

    is_quadratic: ClassVar[Literal[True]] = True
    is_axisymmetric: ClassVar[bool] = True
    is_even: ClassVar[bool] = True
    has_polarisation: ClassVar[bool] = True
    peak: ClassVar[float] = 1.0

    name: str
    label: str
    leak: float

    @property
    def mean(self) -> float:
        """Mean gain over the sphere."""
        return (2.0 + self.leak) / 3.0

    def gain(self, sine_squared: FloatArray) -> FloatArray:
        """Evaluate the power gain at an angle from the axis, 1 broadside.

        Args:
            sine_squared: ``sin^2(gamma)``, of any shape.
        """
        return self.leak + (1.0 - self.leak) * sine_squared
