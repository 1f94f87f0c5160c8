"""A place and a pose in the frames of maps and autopilots, as lines for a terminal."""

from __future__ import annotations

import math

from nullpose.physics import FramePose, Geodetic, pose_frames
from nullpose.scenario import Origin
from nullpose.solve import ArraySolution, Solution

__all__ = ["frame_rows", "place_words"]


def place_words(place: Geodetic | Origin) -> str:
    """Return a place on the Earth in words, to about a millimetre.

    Args:
        place: latitude, longitude and altitude over the ellipsoid.
    """
    lat, lon = f"{place.lat_deg:z.8f}", f"{place.lon_deg:z.8f}"
    return f"lat {lat} deg, lon {lon} deg, alt {place.alt_m:z.3f} m over the WGS-84 ellipsoid"


def frame_rows(solution: Solution | ArraySolution) -> list[tuple[str, str]]:
    """Return a solution's pose on the Earth, in NED and as quaternions: a name and words for each.

    Empty for a scenario without an origin.

    Args:
        solution: what was found.
    """
    frames = pose_frames(solution.scenario, solution.pose)
    if frames.geodetic is None:
        return []
    north, east, down = (f"{component:z.4f}" for component in frames.ned.position_m)
    angles = (frames.ned.roll_rad, frames.ned.pitch_rad, frames.ned.yaw_rad)
    roll, pitch, yaw = (f"{math.degrees(angle):z.3f}" for angle in angles)
    return [
        ("on the Earth", place_words(frames.geodetic)),
        ("NED, body FRD", f"north {north} m, east {east} m, down {down} m"),
        ("", f"roll {roll} deg, pitch {pitch} deg, yaw {yaw} deg"),
        ("quaternion wxyz", f"{_quaternion_words(frames.enu)} in ENU, body FLU"),
        ("", f"{_quaternion_words(frames.ned)} in NED, body FRD"),
    ]


def _quaternion_words(pose: FramePose) -> str:
    return f"({', '.join(f'{component:z.6f}' for component in pose.quaternion_wxyz)})"
