"""Places on the Earth: against ECEF coordinates worked out here, against pymap3d, and there and back."""

import math

import numpy as np
from earth import east_north_up, ecef_m
from hypothesis import given, strategies as st

from nullpose.scenario.geodesy import enu_from_geodetic, geodetic_from_enu, ned_from_enu

origins = st.tuples(st.floats(-90.0, 90.0), st.floats(-180.0, 180.0), st.floats(-500.0, 9000.0))
sideways = st.floats(-20e3, 20e3)
positions = st.tuples(sideways, sideways, st.floats(-5e3, 20e3))


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
