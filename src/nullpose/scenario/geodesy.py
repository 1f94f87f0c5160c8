"""Places on the Earth (WGS-84) and in a local frame: east, north, up (ENU) or north, east, down (NED)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

# pymap3d is imported where it is used: most scenarios have no place on the Earth.


def enu_from_geodetic(geodetic: ArrayLike, origin: ArrayLike) -> NDArray[np.float64]:
    """Convert places on the Earth to the local frame of an origin: east, north and up [m].

    ``(east, north, up) = S(lat0, lon0) (X - X0)``, with X Earth-centred Cartesian coordinates and the rows of
    S the directions east, north and up at the origin. The frame is straight: up is the origin's vertical
    everywhere, and a place at the origin's altitude d metres away has up = -d^2 / 2R, 0.8 m at 3.2 km.

    Source: EPSG Guidance Note 7-2, method 9837; WGS-84 as in NGA.STND.0036 (a = 6378137 m,
    1/f = 298.257223563). With ``geodetic_from_enu`` it closes within 1e-8 m up to 100 km from the origin.

    Args:
        geodetic: latitudes and longitudes [degrees] and altitudes over the ellipsoid [m], (..., 3).
        origin: the same of the origin, (3,).

    Returns:
        Array of shape (..., 3).
    """
    from pymap3d.enu import geodetic2enu

    places = np.moveaxis(np.asarray(geodetic, dtype=np.float64), -1, 0)
    return np.stack(geodetic2enu(*places, *np.asarray(origin)), axis=-1)


def geodetic_from_enu(position_m: ArrayLike, origin: ArrayLike) -> NDArray[np.float64]:
    """Convert local positions to latitude, longitude [degrees] and altitude over the ellipsoid [m].

    The inverse of ``enu_from_geodetic``. Longitudes lie in [-180, 180].

    Args:
        position_m: east, north and up from the origin [m], (..., 3).
        origin: latitude and longitude [degrees] and altitude [m] of the origin, (3,).

    Returns:
        Array of shape (..., 3).
    """
    from pymap3d.enu import enu2geodetic

    positions = np.asarray(position_m, dtype=np.float64)
    return np.stack(enu2geodetic(*np.moveaxis(positions, -1, 0), *np.asarray(origin)), axis=-1)


def wrapped(lon_deg: ArrayLike, about_deg: ArrayLike = 0.0) -> NDArray[np.float64]:
    """Move longitudes by whole turns to within half a turn of one.

    Args:
        lon_deg: longitudes [degrees], of any shape.
        about_deg: the one [degrees].
    """
    return np.asarray(np.subtract(lon_deg, 360.0 * np.round(np.subtract(lon_deg, about_deg) / 360.0)))


def ned_from_enu(vector: ArrayLike) -> NDArray[np.float64]:
    """Convert vectors to north, east, down: the first two components swapped, the third negated.

    Done twice, it gives the vectors back: so it leads from north, east, down to east, north, up too.

    Args:
        vector: components east, north and up, in any unit, (..., 3).

    Returns:
        Array of shape (..., 3).
    """
    return np.asarray(vector, dtype=np.float64)[..., [1, 0, 2]] * [1.0, 1.0, -1.0] + 0.0  # no negative zeros
