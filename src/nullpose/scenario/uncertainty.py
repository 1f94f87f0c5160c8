"""Ground points that are known only up to a set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, TypeAdapter
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.arrays import read_only
from nullpose.scenario.faults import Place, rejection
from nullpose.scenario.section import Section
from nullpose.scenario.units import ErrorMetres, SemiAxes, Turn
from nullpose.scenario.wording import described, plain

__all__ = ["Extent", "Uncertain"]


@dataclass(frozen=True, slots=True)
class _Extent:
    """A radius or three semi-axes, as metadata of an annotated number or tuple."""

    def read(self, value: object) -> object:
        value = plain(value)
        if isinstance(value, list | tuple):
            return _reader(SemiAxes).validate_python(value)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise rejection(
                f"got {described(value)}, must be a radius in m, or a list of three semi-axes in m [a, b, c]"
            )
        return _reader(ErrorMetres).validate_python(value)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        number = {"type": "number", "minimum": 0.0, "maximum": 1e7}
        limits = {"minimum": 0.0, "maximum": 1e7}
        return {"type": ["number", "array"]} | limits | {"items": number, "minItems": 3, "maxItems": 3}


@cache
def _reader(kind: Any) -> TypeAdapter[Any]:
    return TypeAdapter(kind)


Extent = Annotated[float | tuple[float, float, float], _Extent()]
"""The size of a set of positions: the radius of a ball, or the semi-axes of an ellipsoid [m]."""


class Uncertain(Section):
    """What a ground point has whose position is known only up to a set.

    Args:
        uncertainty_m: radius of a ball [m], or the three semi-axes of an ellipsoid [m], about the stated
            position; None for a position that is known.
        uncertainty_attitude_deg: roll, pitch and yaw [deg] of the ellipsoid's axes, which without it lie
            east, north and up; turned as a body is (``Rz(yaw) Ry(pitch) Rx(roll)``).
    """

    uncertainty_m: Extent | None = Field(
        default=None,
        description="How far the true position may be from the stated one, in metres: the radius of a ball, "
        "or the three semi-axes [a, b, c] of an ellipsoid. Used by robust solving. Left out: exactly there.",
        examples=[3.0, [10.0, 2.0, 1.0]],
    )
    uncertainty_attitude_deg: Turn | None = Field(
        default=None,
        description="How the ellipsoid is turned, in degrees: [roll, pitch, yaw] of its axes, which lie "
        "east, north and up if this is left out. Only with three semi-axes.",
        examples=[[0.0, 0.0, 30.0]],
    )

    @cached_property
    def uncertainty_matrix_m(self) -> NDArray[np.float64]:
        """The matrix A [m], (3, 3), of the set ``{position + A x : |x| <= 1}``; zero without uncertainty."""
        extent = 0.0 if self.uncertainty_m is None else self.uncertainty_m
        scaled = np.diag(np.broadcast_to(np.asarray(extent, dtype=np.float64), 3))
        if self.uncertainty_attitude_deg is None:
            return read_only(scaled, (3, 3))
        from scipy.spatial.transform import Rotation  # here, for it takes long to import

        turn = Rotation.from_euler("xyz", self.uncertainty_attitude_deg, degrees=True)
        return read_only(turn.as_matrix() @ scaled, (3, 3))

    @property
    def uncertainty_reach_m(self) -> float:
        """The greatest distance of the true position from the stated one [m]."""
        return float(np.max(self.uncertainty_m)) if self.uncertainty_m is not None else 0.0

    @classmethod
    def cross_faults(cls, data: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Returns the faults between several values of the raw table, as far as they can be judged."""
        yield from super().cross_faults(data)
        if data.get("uncertainty_attitude_deg") is None:
            return
        extent = plain(data.get("uncertainty_m"))
        if not isinstance(extent, list | tuple):
            message = (
                "given without three semi-axes to turn; write uncertainty_m = [a, b, c], or remove "
                "uncertainty_attitude_deg"
            )
            yield ("uncertainty_attitude_deg",), message
