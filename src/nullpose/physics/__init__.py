"""What a pose receives: the paper's equations, one function each, plain and slow on purpose.

Every number that nullpose reports is evaluated here from the reported pose.
"""

from nullpose.physics.array import (
    array_channels,
    digital_sinr,
    digital_weights,
    element_positions,
    steering_vectors,
)
from nullpose.physics.decibel import from_db, to_db
from nullpose.physics.error_case import ErrorCase, rotation_between
from nullpose.physics.evaluate import (
    Link,
    evaluate,
    min_margin,
    min_secrecy_rate,
    min_sinr,
    objective_of_links,
)
from nullpose.physics.frames import (
    FramePose,
    Geodetic,
    PoseFrames,
    flu_from_frd,
    frd_from_flu,
    pose_frames,
)
from nullpose.physics.gain import antenna_gain, dipole_gain, interferer_gains, link_gain
from nullpose.physics.pose import Pose, Poses
from nullpose.physics.reception import (
    Reception,
    allowed_value,
    node_values,
    objective_value,
    ratios_under,
)
from nullpose.physics.rotation import (
    antenna_axis,
    attitude_from_axis,
    attitude_of_axis,
    rotation_world_from_body,
)
from nullpose.physics.sinr import (
    destination_snr,
    eavesdropper_snr,
    node_snr,
    received_from_sources_w,
    received_power_w,
    secrecy_rate,
    sinr,
)

__all__ = [
    "ErrorCase",
    "FramePose",
    "Geodetic",
    "Link",
    "Pose",
    "PoseFrames",
    "Poses",
    "Reception",
    "allowed_value",
    "antenna_axis",
    "antenna_gain",
    "array_channels",
    "attitude_from_axis",
    "attitude_of_axis",
    "destination_snr",
    "digital_sinr",
    "digital_weights",
    "dipole_gain",
    "eavesdropper_snr",
    "element_positions",
    "evaluate",
    "flu_from_frd",
    "frd_from_flu",
    "from_db",
    "interferer_gains",
    "link_gain",
    "min_margin",
    "min_secrecy_rate",
    "min_sinr",
    "node_snr",
    "node_values",
    "objective_of_links",
    "objective_value",
    "pose_frames",
    "ratios_under",
    "received_from_sources_w",
    "received_power_w",
    "rotation_between",
    "rotation_world_from_body",
    "secrecy_rate",
    "sinr",
    "steering_vectors",
    "to_db",
]
