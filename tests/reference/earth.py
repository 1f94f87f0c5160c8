"""Places on the Earth (WGS-84) by the textbook, apart from nullpose."""

import math

import numpy as np

SEMI_MAJOR_M = 6378137.0
FLATTENING = 1.0 / 298.257223563
ECCENTRICITY_SQUARED = FLATTENING * (2.0 - FLATTENING)

Place = tuple[float, float, float]


def ecef_m(geodetic: Place) -> np.ndarray:
    """Returns Earth-centred coordinates from the textbook's closed form."""
    lat, lon = math.radians(geodetic[0]), math.radians(geodetic[1])
    normal_m = SEMI_MAJOR_M / math.sqrt(1.0 - ECCENTRICITY_SQUARED * math.sin(lat) ** 2)
    axial_m = (normal_m + geodetic[2]) * math.cos(lat)
    polar_m = (normal_m * (1.0 - ECCENTRICITY_SQUARED) + geodetic[2]) * math.sin(lat)
    return np.array([axial_m * math.cos(lon), axial_m * math.sin(lon), polar_m])


def east_north_up(origin: Place) -> np.ndarray:
    """Returns the three directions at a place as rows, in Earth-centred coordinates."""
    lat, lon = math.radians(origin[0]), math.radians(origin[1])
    east = np.array([-math.sin(lon), math.cos(lon), 0.0])
    up = np.array([math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat)])
    return np.stack([east, np.cross(up, east), up])


def local_m(lat_deg: float, lon_deg: float, alt_m: float, origin: Place) -> np.ndarray:
    """Returns metres east, north and up of an origin."""
    return east_north_up(origin) @ (ecef_m((lat_deg, lon_deg, alt_m)) - ecef_m(origin))
