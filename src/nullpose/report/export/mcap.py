"""Recordings (MCAP): a result for Foxglove, with the antenna's axis in the scene, and a flight for ROS 2."""

from __future__ import annotations

import math
from collections.abc import Iterator
from importlib.util import find_spec
from io import BytesIO
from typing import Any

import numpy as np

from nullpose.errors import install_command, require_usage
from nullpose.files import PlainTable
from nullpose.physics import Pose, pose_frames
from nullpose.report.export.places import marked_points
from nullpose.report.geometry import azimuth_rad, tilt_rad
from nullpose.scenario import Scenario
from nullpose.solver import Result
from nullpose.solver.trajectory import Trajectory

_COLOURS = {
    "pose": {"r": 0.0, "g": 0.6, "b": 0.2, "a": 1.0},
    "node": {"r": 0.1, "g": 0.4, "b": 0.8, "a": 1.0},
    "jammer": {"r": 0.8, "g": 0.2, "b": 0.1, "a": 1.0},
}
_SIZE = 0.02  # diameter of a sphere, shares of the scene's extent
_HEADER = """
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
===
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
_TRANSFORMS = f"""geometry_msgs/TransformStamped[] transforms
===
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
===
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
===
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
===
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
==={_HEADER}"""
_FIX = f"""std_msgs/Header header
sensor_msgs/NavSatStatus status
float64 latitude
float64 longitude
float64 altitude
float64[9] position_covariance
uint8 position_covariance_type
===
MSG: sensor_msgs/NavSatStatus
int8 status
uint16 service
==={_HEADER}"""


def require_foxglove(_: Scenario) -> None:
    """Make sure that the library that writes recordings is there.

    Raises:
        UsageError: it is not installed.
    """
    require_usage(find_spec("foxglove"), "--export: .mcap needs foxglove-sdk; " + install_command("flight"))


def mcap_file(result: Result) -> bytes:
    """Write a result as MCAP: topics ``/pose`` and ``/scene`` with a message each, at t = 0.

    Their schemas are foxglove.PoseInFrame and foxglove.SceneUpdate. Needs what ``require_foxglove`` checks.
    """
    from foxglove import Context, channels, messages, open_mcap

    stream, context = BytesIO(), Context()
    at = {"timestamp": messages.Timestamp(0, 0), "frame_id": "enu"}
    pose = messages.PoseInFrame(pose=_pose_message(result, result.pose), **at)
    entities = [messages.SceneEntity(**parts, **at) for parts in _entities(result)]
    with open_mcap(stream, context=context):
        channels.PoseInFrameChannel("/pose", context=context).log(pose, log_time=0)
        channels.SceneUpdateChannel("/scene", context=context).log(
            messages.SceneUpdate(entities=entities), log_time=0
        )
    return stream.getvalue()


def _entities(result: Result) -> Iterator[PlainTable]:
    """Yield the parts of an arrow along the antenna's axis, and of a sphere with its name for each point."""
    from foxglove.messages import ArrowPrimitive, Color, SpherePrimitive, TextPrimitive, Vector3

    points, pose = list(marked_points(result)), result.pose
    size_m = _SIZE * float(np.ptp([np.asarray(position_m) for position_m, _ in points], axis=0).max())
    is_even = result.scenario.antenna_record.is_even
    arrow = ArrowPrimitive(
        pose=_pose_message(
            result,
            Pose(pose.position_m, 0.0, tilt_rad(pose, is_even) - math.pi / 2.0, azimuth_rad(pose, is_even)),
        ),
        shaft_length=4.0 * size_m,
        shaft_diameter=0.3 * size_m,
        head_length=size_m,
        head_diameter=0.6 * size_m,
        color=Color(**_COLOURS["pose"]),
    )
    yield {"id": "antenna axis", "arrows": [arrow]}
    for position_m, properties in points:
        kind, name = properties["kind"], properties["name"]
        looks = {
            "pose": _pose_message(result, Pose(np.asarray(position_m), 0.0, 0.0)),
            "color": Color(**_COLOURS.get(kind, _COLOURS["jammer"])),
        }
        yield {
            "id": f"{kind} {name}",
            "spheres": [SpherePrimitive(size=Vector3(x=size_m, y=size_m, z=size_m), **looks)],
            "texts": [TextPrimitive(text=name, font_size=0.5 * size_m, **looks)],
        }


def _pose_message(result: Result, pose: Pose) -> Any:
    """Convert a pose to a message: ENU, the rotation to the world from the body."""
    from foxglove import messages

    enu = pose_frames(result.scenario, pose).enu
    return messages.Pose(
        position=messages.Vector3(**dict(zip("xyz", enu.position_m, strict=True))),
        orientation=messages.Quaternion(**dict(zip("xyzw", enu.quaternion_xyzw, strict=True))),
    )


def flight_mcap_file(flight: Trajectory) -> bytes:
    """Write a flight as MCAP for ROS 2: its stamps are those of the scene, from 0 seconds.

    Topic ``/tf`` (tf2_msgs/TFMessage) has frame ``base_link`` in ``map``, which is ENU; with an origin, topic
    ``/fix`` (sensor_msgs/NavSatFix) has the place on the Earth, the altitude over the ellipsoid, or NaN where
    the origin does not tell it. Needs mcap-ros2-support.
    """
    from mcap_ros2.writer import Writer

    stream, origin = BytesIO(), flight.scenario.origin
    with Writer(stream) as writer:
        transforms = writer.register_msgdef("tf2_msgs/msg/TFMessage", _TRANSFORMS.replace("===", 80 * "="))
        fix = writer.register_msgdef("sensor_msgs/msg/NavSatFix", _FIX.replace("===", 80 * "="))
        for row in flight.rows():
            time_ns = round(1e9 * row["time_s"])
            stamp = dict(zip(("sec", "nanosec"), divmod(time_ns, 10**9), strict=True))
            moved = {
                "translation": dict(zip("xyz", row["position_m"], strict=True)),
                "rotation": dict(zip("wxyz", row["wxyz"], strict=True)),
            }
            transform = {
                "header": {"stamp": stamp, "frame_id": "map"},
                "child_frame_id": "base_link",
                "transform": moved,
            }
            writer.write_message("/tf", transforms, {"transforms": [transform]}, time_ns, time_ns)
            if origin is not None:
                place = origin.place(np.array(row["position_m"]))
                message = {
                    "header": {"stamp": stamp, "frame_id": "base_link"},
                    "status": {"status": 0, "service": 1},  # a fix, by GPS
                    "latitude": place["lat_deg"],
                    "longitude": place["lon_deg"],
                    "altitude": place.get("alt_m", math.nan),
                    "position_covariance": [0.0] * 9,
                    "position_covariance_type": 0,  # unknown
                }
                writer.write_message("/fix", fix, message, time_ns, time_ns)
    return stream.getvalue()
