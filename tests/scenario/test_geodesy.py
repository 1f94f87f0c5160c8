"""Places on the Earth: against ECEF coordinates worked out here, against pymap3d, and there and back."""

import math

import numpy as np
from hypothesis import given, strategies as st

from nullpose.scenario.geodesy import enu_from_geodetic, geodetic_from_enu, ned_from_enu

SEMI_MAJOR_M = 6378137.0
FLATTENING = 1.0 / 298.257223563
ECCENTRICITY_SQUARED = FLATTENING * (2.0 - FLATTENING)

origins = st.tuples(st.floats(-90.0, 90.0), st.floats(-180.0, 180.0), st.floats(-500.0, 9000.0))
sideways = st.floats(-20e3, 20e3)
positions = st.tuples(sideways, sideways, st.floats(-5e3, 20e3))


def ecef_m(geodetic: tuple[float, float, float]) -> np.ndarray:
    """Returns Earth-centred coordinates from the textbook's closed form."""
    lat, lon = math.radians(geodetic[0]), math.radians(geodetic[1])
    normal_m = SEMI_MAJOR_M / math.sqrt(1.0 - ECCENTRICITY_SQUARED * math.sin(lat) ** 2)
    axial_m = (normal_m + geodetic[2]) * math.cos(lat)
    polar_m = (normal_m * (1.0 - ECCENTRICITY_SQUARED) + geodetic[2]) * math.sin(lat)
    return np.array([axial_m * math.cos(lon), axial_m * math.sin(lon), polar_m])


def east_north_up(origin: tuple[float, float, float]) -> np.ndarray:
    """Returns the three directions at a place as rows, in Earth-centred coordinates."""
    lat, lon = math.radians(origin[0]), math.radians(origin[1])
    east = np.array([-math.sin(lon), math.cos(lon), 0.0])
    up = np.array([math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat)])
    return np.stack([east, np.cross(up, east), up])


@given(origins, positions)
def test_there_and_back(origin: tuple[float, float, float], position_m: tuple[float, float, float]) -> None:
    """A position within 20 km comes back from latitude and longitude to within a micrometre."""
    geodetic = geodetic_from_enu(position_m, origin)
    np.testing.assert_allclose(enu_from_geodetic(geodetic, origin), position_m, rtol=0, atol=1e-6)


@given(origins, positions)
def test_positions_are_those_of_earth_centred_coordinates(
    origin: tuple[float, float, float], position_m: tuple[float, float, float]
) -> None:
    """The latitude and longitude of a position, taken to Earth-centred coordinates, are where it points."""
    lat_deg, lon_deg, alt_m = geodetic_from_enu(position_m, origin)
    assert -90.0 <= lat_deg <= 90.0
    assert -180.0 <= lon_deg <= 180.0
    offset_m = ecef_m((lat_deg, lon_deg, alt_m)) - ecef_m(origin)
    np.testing.assert_allclose(east_north_up(origin) @ offset_m, position_m, rtol=0, atol=1e-6)


def test_north_east_down() -> None:
    """East is second and up is down; twice is nothing, and no zero gets a sign."""
    assert ned_from_enu([1.0, 2.0, 3.0]).tolist() == [2.0, 1.0, -3.0]
    assert ned_from_enu(ned_from_enu([[1.0, 2.0, 3.0], [4.0, 5.0, 0.0]])).tolist() == [[1, 2, 3], [4, 5, 0]]
    assert math.copysign(1.0, ned_from_enu([0.0, 0.0, 0.0])[2]) == 1.0
