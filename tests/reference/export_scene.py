"""A pose on the Earth without zeros or symmetry, so that every exchange of numbers shows; its airspace."""

from typing import Any

ORIGIN = (50.0, 14.5, 230.0)
SEA_M = 45.0  # the ellipsoid lies so far below the sea
ANGLES_DEG = {"roll_deg": 25.0, "pitch_deg": -35.0, "yaw_deg": 63.0}
POSITION_M = (21.0, -17.5, 26.0)
AIRSPACE: dict[str, Any] = {
    "altitude_m": [8.0, 30.0],
    "geofence_m": [[-50.0, -40.0], [60.0, -40.0], [70.0, 80.0]],
    "no_fly": [
        {"name": "mast", "centre_m": [30.0, 40.0], "radius_m": 10.0},
        {"name": "barn", "x_m": [15.0, 25.0], "y_m": [-20.0, -10.0], "altitude_m": [0.0, 12.0]},
        {"name": "wood", "polygon_m": [[-30.0, 20.0], [-20.0, 20.0], [-25.0, 35.0]]},
    ],
}
