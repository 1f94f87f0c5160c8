"""Ground points that are known only up to a set."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter

from nullpose.files import PlainTable
from nullpose.scenario.arrays import read_only
from nullpose.scenario.faults import Place
from nullpose.scenario.rules import ListOf, NumberOr, Quantity
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import ErrorMetres, RollPitchYaw

_SemiAxes = tuple[ErrorMetres, ErrorMetres, ErrorMetres]
_EXTENT = NumberOr(
    Quantity(
        "a radius in m (or a list of three semi-axes [a, b, c])", 0.0, 1e7, "an error is a size; 0 means none"
    ),
    TypeAdapter(Annotated[_SemiAxes, ListOf("a list of three semi-axes in m [a, b, c]", 3, 3)]),
)


class Uncertain(Section):
    """What a ground point has whose position is known only up to a set.

    Args:
        uncertainty_m: radius of a ball [m], or the three semi-axes of an ellipsoid [m], about the stated
            position; None for a position that is known.
        uncertainty_attitude_deg: roll, pitch and yaw [deg] of the ellipsoid's axes, which without it lie
            east, north and up; rotated as a body is (``Rz(yaw) Ry(pitch) Rx(roll)``).
    """

    uncertainty_m: Annotated[float | tuple[float, float, float], _EXTENT] | None = optional(
        "How far the true position may be from the stated one, in metres: the radius of a ball, "
        "or the three semi-axes [a, b, c] of an ellipsoid. Used by robust solving. Left out: exactly there.",
        3.0,
        [10.0, 2.0, 1.0],
    )
    uncertainty_attitude_deg: RollPitchYaw | None = optional(
        "How the ellipsoid is rotated, in degrees: [roll, pitch, yaw] of its axes, which lie "
        "east, north and up if this is left out. Only with three semi-axes.",
        [0.0, 0.0, 30.0],
    )

    @cached_property
    def uncertainty_matrix_m(self) -> NDArray[np.float64]:
        """The matrix A [m], (3, 3), of the set ``{position + A x : |x| <= 1}``; zero without uncertainty."""
        scaled = np.diag(np.broadcast_to(np.asarray(self.uncertainty_m or 0.0, dtype=np.float64), 3))
        if self.uncertainty_attitude_deg is None:
            return read_only(scaled, (3, 3))
        from scipy.spatial.transform import Rotation  # here, for it takes long to import

        rotation = Rotation.from_euler("xyz", self.uncertainty_attitude_deg, degrees=True)
        return read_only(rotation.as_matrix() @ scaled, (3, 3))

    @property
    def uncertainty_reach_m(self) -> float:
        """The greatest distance of the true position from the stated one [m]."""
        return float(np.max(self.uncertainty_m)) if self.uncertainty_m is not None else 0.0

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """Return the fault that an attitude is given of what is no ellipsoid."""
        yield from super().faults(raw)
        is_sound = self.uncertainty_m is not None or raw.get("uncertainty_m") is None
        if is_sound and self.uncertainty_attitude_deg and not isinstance(self.uncertainty_m, tuple):
            yield (
                ("uncertainty_attitude_deg",),
                "given without three semi-axes to rotate; write uncertainty_m = [a, b, c], or remove "
                "uncertainty_attitude_deg",
            )
