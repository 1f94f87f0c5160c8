"""The points of a result, and where they are on the Earth: what every format of maps shares."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from numpy.typing import ArrayLike

from nullpose.errors import UsageError
from nullpose.files import PlainTable
from nullpose.physics import Pose, pose_frames
from nullpose.report.geometry import azimuth_rad, tilt_rad
from nullpose.report.links import binding_nodes
from nullpose.report.words import channel_words
from nullpose.scenario import GroundPoint, Origin, Scenario
from nullpose.scenario.radio import Powered, Uncertain
from nullpose.solver import Result
from nullpose.solver.robust import RobustDetails


def require_origin(scenario: Scenario) -> Origin:
    """Look up the origin that puts a scenario on the map.

    Raises:
        UsageError: it has none.
    """
    if scenario.origin is None:
        raise UsageError(
            "GeoJSON, KML and plans: the scenario has no origin, so where on the Earth it lies is not known; "
            "add a table headed [origin] with lat_deg, lon_deg and alt_m (or alt_msl_m) of the place where "
            "position_m is [0, 0, 0]"
        )
    return scenario.origin


def map_altitude_m(origin: Origin, place: Mapping[str, float]) -> float:
    """Return an altitude that autopilots and KML understand: over the sea if the origin states its own so.

    Otherwise it counts from the origin.

    Args:
        origin: of the scenario.
        place: on the Earth, as :meth:`Origin.place` states it.
    """
    return place.get("alt_msl_m", place.get("alt_m", 0.0) - (origin.alt_m or 0.0))


def marked_points(solution: Result) -> Iterator[tuple[ArrayLike, PlainTable]]:
    """Yield the pose and all points on the ground: position in metres, and properties."""
    scenario, binding = solution.scenario, binding_nodes(solution)
    objective = solution.objective
    properties: PlainTable = {
        "kind": "pose",
        "name": solution.label,
        "status": solution.status.value,
        "rigour": solution.rigour.value,
        "objective": objective.name,
        "value": objective.value,
        "value_db": objective.value_db,
        "upper_bound": objective.upper_bound,
    }
    channel = channel_words(scenario)
    properties |= {} if channel is None else {"channel": channel}
    yield solution.pose.position_m, properties | _angles(scenario, solution.pose)
    if isinstance(solution.details, RobustDetails):
        nominal = solution.details.nominal
        named = {"kind": "pose-as-stated", "name": "best pose as stated", "guaranteed": nominal.guaranteed}
        yield nominal.pose.position_m, named | _angles(scenario, nominal.pose)
    for node, link in zip(scenario.terminals, solution.links, strict=True):
        about: PlainTable = {"kind": type(node).__name__.lower(), "name": node.name}
        yield node.position_m, about | {"binding": node.name in binding} | dict(link.values)
    others: tuple[GroundPoint, ...] = (*scenario.jammers, *scenario.eavesdroppers, *scenario.sources)
    for point in others:
        about = {"kind": type(point).__name__.lower(), "name": point.name}
        about |= {"power_w": point.transmit_power_w} if isinstance(point, Powered) else {}
        about |= {"uncertainty_m": point.uncertainty_reach_m} if isinstance(point, Uncertain) else {}
        yield point.position_m, about


def _angles(scenario: Scenario, pose: Pose) -> dict[str, object]:
    """Convert the attitude to the frames of other programs, and the antenna's axis to two angles."""
    frames, is_even = pose_frames(scenario, pose), scenario.antenna_record.is_even
    return {
        **{
            f"{name}_{angle}_deg": math.degrees(getattr(frame, f"{angle}_rad"))
            for name, frame in (("enu", frames.enu), ("ned", frames.ned))
            for angle in ("roll", "pitch", "yaw")
        },
        "enu_quaternion_wxyz": list(frames.enu.quaternion_wxyz),
        "ned_quaternion_wxyz": list(frames.ned.quaternion_wxyz),
        "antenna_tilt_deg": math.degrees(tilt_rad(pose, is_even)),
        "antenna_bearing_deg": (90.0 - math.degrees(azimuth_rad(pose, is_even))) % 360.0,
    }
