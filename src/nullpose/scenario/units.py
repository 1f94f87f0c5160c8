"""Numbers with a unit and a range, and the types of the scenario's fields made of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.faults import rejection
from nullpose.scenario.wording import described, plain

__all__ = [
    "SPEED_OF_LIGHT_M_PER_S",
    "AttitudeDegrees",
    "Count",
    "DecibelMilliwatts",
    "Decibels",
    "ErrorDegrees",
    "ErrorMetres",
    "Hertz",
    "KeepOutMetres",
    "Metres",
    "MountDegrees",
    "PlanePoint",
    "Position",
    "Quantity",
    "RadiusMetres",
    "Range",
    "RatioDecibels",
    "SemiAxes",
    "TiltDegrees",
    "Turn",
    "Watts",
    "Wavelengths",
    "Weight",
    "power_w",
    "ratio_from_db",
    "watts_from_dbm",
]

SPEED_OF_LIGHT_M_PER_S = 299_792_458.0
"""Speed of light in vacuum, exact by definition of the metre [m/s]."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A finite number with a unit, between two limits; used as the metadata of an annotated float.

    The limits are wide enough for any radio scene and narrow enough that no product of such numbers in
    the physics overflows.

    Args:
        noun: what the number is, with its unit, as in ``a power in W``.
        low: smallest number allowed.
        high: largest number allowed.
        hint: what to try when a number is outside the limits.
    """

    noun: str
    low: float
    high: float
    hint: str

    @property
    def allowed(self) -> str:
        """The allowed numbers in words."""
        return f"{self.noun} from {self.low:g} to {self.high:g}"

    def read(self, value: object) -> float:
        """Returns the number, or raises the fault that says what is wrong with it."""
        value = plain(value)
        if isinstance(value, bool) or not isinstance(value, int | float):
            remedy = "; write it without quotes" if _is_quoted_number(value) else ""
            raise rejection(f"got {described(value)}, must be a number: {self.allowed}{remedy}")
        if not self.low <= value <= self.high:  # also refuses NaN
            raise rejection(f"got {described(value)}, must be {self.allowed} ({self.hint})")
        return float(value)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {"type": "number", "minimum": self.low, "maximum": self.high}


class Count(Quantity):
    """A whole number between two limits; used as the metadata of an annotated int."""

    def read(self, value: object) -> int:
        """Returns the whole number, or raises the fault that says what is wrong with it."""
        number = super().read(value)
        if not number.is_integer():
            raise rejection(f"got {described(value)}, must be a whole number: {self.allowed} ({self.hint})")
        return int(number)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return super().__get_pydantic_json_schema__(schema, handler) | {"type": "integer"}


def _is_quoted_number(value: object) -> bool:
    if not isinstance(value, str):
        return False
    try:
        float(value)
    except ValueError:
        return False
    return True


_POWER_HINT = "a power is never zero or negative; a value in dBm belongs to the key that ends in _dbm"
_METRES_HINT = "use metres from a nearby local origin: east, north and up"

Watts = Annotated[float, Quantity("a power in W", 1e-30, 1e30, _POWER_HINT)]
DecibelMilliwatts = Annotated[
    float, Quantity("a power in dBm", -270.0, 330.0, "a value in W belongs to the key that ends in _w")
]
Decibels = Annotated[float, Quantity("a gain in dB", -300.0, 300.0, "0 dB is a gain of 1, 10 dB one of 10")]
Hertz = Annotated[float, Quantity("a frequency in Hz", 1e3, 1e13, "2.4 GHz is written 2.4e9")]
Metres = Annotated[float, Quantity("a length in m", -1e7, 1e7, _METRES_HINT)]
KeepOutMetres = Annotated[
    float, Quantity("a radius in m", 1e-3, 1e7, "the model has no limit at a ground point")
]
RadiusMetres = Annotated[float, Quantity("a radius in m", 1e-3, 1e7, "a shape has an inside")]
ErrorMetres = Annotated[
    float, Quantity("a length in m", 0.0, 1e7, "an error is a size, never negative; 0 means none")
]
_ANGLE_HINT = "angles in files are in degrees"
TiltDegrees = Annotated[
    float, Quantity("an angle in degrees", 0.0, 180.0, "a tilt below 0 reaches no axis; 180 is any attitude")
]
MountDegrees = Annotated[
    float, Quantity("an angle in degrees", 0.0, 90.0, "0 is along the body's vertical, 90 across it")
]
ErrorDegrees = Annotated[
    float, Quantity("an angle in degrees", 0.0, 90.0, "an error is a size, never negative; 0 means none")
]
AttitudeDegrees = Annotated[float, Quantity("an angle in degrees", -360.0, 360.0, _ANGLE_HINT)]
RatioDecibels = Annotated[
    float, Quantity("a ratio in dB", -300.0, 300.0, "0 dB is a ratio of 1, 10 dB one of 10")
]
Weight = Annotated[
    float, Quantity("a weight", 1e-30, 1e30, "a weight is never zero or negative; 1 is the one of the others")
]
Wavelengths = Annotated[float, Quantity("a length in wavelengths", 1e-3, 1e3, "half a wavelength is 0.5")]


@dataclass(frozen=True, slots=True)
class _Row:
    """A list of a fixed number of lengths or angles, as metadata of an annotated tuple."""

    size: int
    noun: str
    ascending: bool = False
    low: float = -1e7
    high: float = 1e7

    def read(self, value: object) -> list[object]:
        value = plain(value)
        if not isinstance(value, list | tuple) or len(value) != self.size:
            raise rejection(f"got {described(value)}, must be {self.noun}")
        return list(value)

    def judge(self, row: tuple[float, ...]) -> tuple[float, ...]:
        if self.ascending and row[0] > row[1]:
            raise rejection(
                f"got [{row[0]!r}, {row[1]!r}], which is reversed and so holds nothing; "
                f"must be {self.noun}; try [{row[1]!r}, {row[0]!r}]"
            )
        return row

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        members = core_schema.no_info_before_validator_function(self.read, handler(source))
        return core_schema.no_info_after_validator_function(self.judge, members)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        # One "items" for all members, not "prefixItems": editors that know only older drafts read it too.
        number = {"type": "number", "minimum": self.low, "maximum": self.high}
        return {"type": "array", "items": number, "minItems": self.size, "maxItems": self.size}


Position = Annotated[
    tuple[Metres, Metres, Metres], _Row(3, "a list of three numbers [x, y, z]: metres east, north and up")
]
Range = Annotated[
    tuple[Metres, Metres],
    _Row(2, "a list of two numbers in m, the lowest first (equal ends fix the value)", ascending=True),
]
PlanePoint = Annotated[tuple[Metres, Metres], _Row(2, "a list of two numbers [x, y]: metres east and north")]
Turn = Annotated[
    tuple[AttitudeDegrees, AttitudeDegrees, AttitudeDegrees],
    _Row(3, "a list of three angles in degrees [roll, pitch, yaw]", low=-360.0, high=360.0),
]
SemiAxes = Annotated[
    tuple[ErrorMetres, ErrorMetres, ErrorMetres],
    _Row(3, "a list of three semi-axes in m [a, b, c]", low=0.0),
]


def power_w(watts: float | None, dbm: float | None) -> float | None:
    """Returns a power however it was stated [W], or None where neither unit is given."""
    if watts is not None:
        return watts
    return None if dbm is None else watts_from_dbm(dbm)


def watts_from_dbm(power_dbm: float) -> float:
    """Returns the power in W: ``10^((power_dbm - 30) / 10)``."""
    return float(10.0 ** ((power_dbm - 30.0) / 10.0))


def ratio_from_db(ratio_db: float) -> float:
    """Returns the ratio of powers: ``10^(ratio_db / 10)``."""
    return float(10.0 ** (ratio_db / 10.0))
