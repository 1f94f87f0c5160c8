"""Numbers with a unit and a range, and the types of the scenario's fields made of them."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, WithJsonSchema

from nullpose.scenario.faults import EXCHANGED, described, rejection, require_value
from nullpose.scenario.rules import Limits, ListOf, ascending

GEODETIC_KEYS = ("lat_deg", "lon_deg", "alt_m")
"""The keys that state a place on the Earth: all three, or none."""

ALTITUDE_KEYS = ("alt_m", "alt_msl_m", "alt_agl_m")
"""The keys that may state an altitude: over the ellipsoid, over the sea, above the ground at the origin."""

PLACE_KEYS = {"position_m", "lat_deg", "lon_deg", *ALTITUDE_KEYS}
"""The keys that may state the place of a point."""

EARTHLY_CORNERS = {
    "geofence_lat_lon_deg": "geofence_m",
    "polygon_lat_lon_deg": "polygon_m",
    "centre_lat_lon_deg": "centre_m",
}
"""The keys that state outlines in degrees, and those in metres that follow from them."""

EARTHLY_RANGES = {"altitude_msl_m": "alt_msl_m", "altitude_ellipsoid_m": "alt_m"}
"""The keys that state a range of absolute altitudes, and the origin's altitude over the same."""

EARTHLY = {
    **dict.fromkeys(("lat_deg", "lon_deg", *ALTITUDE_KEYS), "position_m"),
    **EARTHLY_CORNERS,
    "courtyards_lat_lon_deg": "courtyards_m",
    **dict.fromkeys(EARTHLY_RANGES, "altitude_m"),
}
"""The keys that state something on the Earth, and those in metres that follow from the origin."""

MOST_OVER_FED_DB = 0.5
"""How far a stated gain's mean over the sphere may be above 1; 2.15 dBi of a short dipole are 0.4 dB."""
HALF_DB = 3.01
"""What an antenna gains by radiating into half the sphere."""

SPEED_OF_LIGHT_M_PER_S = 299_792_458.0
"""Speed of light in vacuum, exact by definition of the metre [m/s]."""


Watts = Annotated[
    float,
    Limits(
        "a power in W",
        1e-30,
        1e30,
        "a power is never zero or negative; a value in dBm belongs to the key that ends in _dbm",
    ),
]
DecibelMilliwatts = Annotated[
    float, Limits("a power in dBm", -270.0, 330.0, "a value in W belongs to the key that ends in _w")
]
Decibels = Annotated[float, Limits("a gain in dB", -300.0, 300.0, "0 dB is a gain of 1, 10 dB one of 10")]
DecibelsIsotropic = Annotated[
    float,
    Limits(
        "a gain in dBi", -100.0, 100.0, "1.76 for a short dipole, 2.15 for a half-wave dipole; 0 is isotropic"
    ),
]
ElevationDegrees = Annotated[
    float, Limits("an elevation in degrees", -90.0, 90.0, "0 is the horizon, 90 right above")
]
NullDepthDecibels = Annotated[
    float,
    Limits("a depth in dB", 0.0, 200.0, "30 is a null 30 dB below the broadside gain; it is not negative"),
]
LossDecibels = Annotated[
    float, Limits("a loss in dB", 0.0, 200.0, "a loss is never negative; 20 dB leave a hundredth")
]
Hertz = Annotated[float, Limits("a frequency in Hz", 1e3, 1e13, "2.4 GHz is written 2.4e9")]
Metres = Annotated[
    float, Limits("a length in m", -1e7, 1e7, "use metres from a nearby local origin: east, north and up")
]
Seconds = Annotated[
    float, Limits("a time in s", 0.0, 1e9, "times count in seconds from the first instant of the scene")
]
Speed = Annotated[float, Limits("a speed in m/s", -1e5, 1e5, "36 km/h are 10 m/s")]
MarginMetres = Annotated[float, Limits("a length in m", 0.0, 1e7, "a margin is never negative; 0 means none")]
RadiusMetres = Annotated[float, Limits("a radius in m", 1e-3, 1e7, "a shape has an inside")]
ErrorMetres = Annotated[
    float, Limits("a length in m", 0.0, 1e7, "an error is a size, never negative; 0 means none")
]
AttitudeDegrees = Annotated[
    float, Limits("an angle in degrees", -360.0, 360.0, "angles in files are in degrees")
]
RatioDecibels = Annotated[
    float, Limits("a ratio in dB", -300.0, 300.0, "0 dB is a ratio of 1, 10 dB one of 10")
]
Weight = Annotated[
    float, Limits("a weight", 1e-30, 1e30, "a weight is never zero or negative; 1 is the one of the others")
]
Component = Annotated[
    float, Limits("a component of a direction", -1e9, 1e9, "[0, 0, 1] is upright, [1, 0, 0] points east")
]

Latitude = Annotated[
    float, Limits("a latitude in degrees", -90.0, 90.0, f"north of the equator is positive; {EXCHANGED}")
]
Longitude = Annotated[float, Limits("a longitude in degrees", -180.0, 180.0, "east of Greenwich is positive")]
Altitude = Annotated[
    float,
    Limits("an altitude in m over the WGS-84 ellipsoid", -1e4, 1e5, "not the height above the ground"),
]
SeaAltitude = Annotated[
    float, Limits("an altitude in m over the sea", -1e4, 1e5, "not the height above the ground")
]


Position = Annotated[
    tuple[Metres, Metres, Metres],
    ListOf("a list of three numbers [x, y, z]: metres east, north and up", 3, 3),
]
Range = Annotated[
    tuple[Metres, Metres],
    ListOf("a list of two numbers in m, the lowest first (equal ends fix the value)", 2, 2),
    AfterValidator(ascending),
]
PlanePoint = Annotated[
    tuple[Metres, Metres], ListOf("a list of two numbers [x, y]: metres east and north", 2, 2)
]
LatLon = Annotated[
    tuple[Latitude, Longitude],
    ListOf("a list of two numbers [latitude, longitude]: degrees north and east", 2, 2),
]


def _pointing(value: tuple[float, float, float]) -> tuple[float, float, float]:
    require_value(
        any(value),
        f"got {list(value)}, which has length 0 and no direction; must be a direction of any other "
        "length; [0, 0, 1] is upright",
    )
    return value


AxisDirection = Annotated[
    tuple[Component, Component, Component],
    ListOf("a list of three numbers [x, y, z]: a direction, east, north and up, of any length", 3, 3),
    AfterValidator(_pointing),
]


def power_w(watts: float | None, dbm: float | None) -> float:
    """Return a power however it was stated [W]; 0 where neither unit is given."""
    return watts_from_dbm(dbm) if dbm is not None else watts or 0.0


def watts_from_dbm(power_dbm: float) -> float:
    """Return the power in W: ``10^((power_dbm - 30) / 10)``."""
    return float(10.0 ** ((power_dbm - 30.0) / 10.0))


def ratio_from_db(ratio_db: float) -> float:
    """Return the ratio of powers: ``10^(ratio_db / 10)``."""
    return float(10.0 ** (ratio_db / 10.0))


def _line(value: object) -> str:
    if not isinstance(value, str):
        raise rejection(f"got {described(value)}, must be text in quotes")
    require_value(
        value.isprintable() and value == value.strip(),
        f"got {described(value)}, must be text on one line, without control characters "
        "and without blanks at its ends",
    )
    return str(value)


def _name(value: object) -> str:
    if value is None:
        return ""  # left out: named by its place
    require_value(
        not isinstance(value, str) or value.strip(),
        f"got {described(value)}, must be a name with at least one visible character",
    )
    return _line(value)


Title = Annotated[str, BeforeValidator(_line)]
"""A text on one line, possibly empty."""
Label = Annotated[str, BeforeValidator(_name), WithJsonSchema({"type": "string", "minLength": 1})]
"""A name by which results and overrides refer to a node or jammer, or the name of a file."""
