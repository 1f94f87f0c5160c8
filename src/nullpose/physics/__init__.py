"""What a pose receives: the paper's equations, one function each, plain and slow on purpose.

Every number that nullpose reports is evaluated here from the reported pose.
"""

from nullpose.physics.decibel import from_db, to_db
from nullpose.physics.evaluate import Link, evaluate, min_sinr
from nullpose.physics.gain import antenna_gain, elevation_cosine
from nullpose.physics.maximum_gain import (
    maximum_gain_axis,
    maximum_gain_sinr,
    maximum_gain_sinr_as_printed,
)
from nullpose.physics.pose import Pose
from nullpose.physics.rotation import antenna_axis, attitude_from_axis, rotation_world_from_body
from nullpose.physics.sinr import received_power_w, sinr
from nullpose.physics.zero_interference import zero_interference_axis, zero_interference_sinr

__all__ = [
    "Link",
    "Pose",
    "antenna_axis",
    "antenna_gain",
    "attitude_from_axis",
    "elevation_cosine",
    "evaluate",
    "from_db",
    "maximum_gain_axis",
    "maximum_gain_sinr",
    "maximum_gain_sinr_as_printed",
    "min_sinr",
    "received_power_w",
    "rotation_world_from_body",
    "sinr",
    "to_db",
    "zero_interference_axis",
    "zero_interference_sinr",
]
