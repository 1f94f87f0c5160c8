"""A plan of QGroundControl: where to hover, the heading, the fence, and what is said of the attitude."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from earth import local_m
from export_scene import AIRSPACE, ORIGIN, POSITION_M
from scipy.spatial.transform import Rotation

import nullpose
from nullpose import Pose, Result, Scenario, min_sinr
from nullpose.report.export.plan import loss_words, plan_file

Placed = Callable[..., Result]
OVER_SEA, OVER_HOME = 0, 3  # MAV_FRAME_GLOBAL and MAV_FRAME_GLOBAL_RELATIVE_ALT of MAVLink's common.xml
HOVER = 17  # MAV_CMD_NAV_LOITER_UNLIM there


def plan_of(result: Result) -> dict[str, Any]:
    """Returns the plan as JSON has it, with the versions that QGroundControl's page on the format states."""
    plan = json.loads(plan_file(result))
    assert (plan["fileType"], plan["version"]) == ("Plan", 1)
    assert (plan["mission"]["version"], plan["geoFence"]["version"]) == (2, 2)
    assert plan["rallyPoints"] == {"points": [], "version": 2}
    return plan


def east_north_m(corners: list[list[float]]) -> np.ndarray:
    """Returns latitudes and longitudes at the origin's altitude in metres, east and north."""
    return np.array([local_m(lat_deg, lon_deg, ORIGIN[2], ORIGIN)[:2] for lat_deg, lon_deg in corners])


@pytest.mark.parametrize(
    ("stated", "frame", "base_m"), [("alt_m", OVER_HOME, 0.0), ("alt_msl_m", OVER_SEA, 185.0)]
)
def test_the_waypoint_is_the_pose(
    placed: Placed, turned: Rotation, stated: str, frame: int, base_m: float
) -> None:
    """It hovers at the pose's place; param 4 is where the nose points, clockwise from north."""
    (item,) = plan_of(placed(stated))["mission"]["items"]
    *_, heading_deg, lat_deg, lon_deg, altitude_m = item["params"]
    assert (item["command"], item["frame"], item["Altitude"]) == (HOVER, frame, altitude_m)
    found_m = local_m(lat_deg, lon_deg, altitude_m, (*ORIGIN[:2], base_m))
    np.testing.assert_allclose(found_m, POSITION_M, rtol=0, atol=1e-3)
    east, north, _ = turned.apply([1.0, 0.0, 0.0])  # forward
    assert heading_deg == pytest.approx(math.degrees(math.atan2(east, north)) % 360.0)


def test_the_fence_is_the_scenarios(placed: Placed) -> None:
    """The geofence is to be stayed in, zones to be stayed out of, circles with their radius."""
    fence = plan_of(placed("alt_m"))["geoFence"]
    inside, wood = fence["polygons"]
    (circle,) = fence["circles"]
    assert [each["inclusion"] for each in (inside, wood, circle)] == [True, False, False]
    for polygon, corners_m in ((inside, AIRSPACE["geofence_m"]), (wood, AIRSPACE["no_fly"][2]["polygon_m"])):
        found = shapely.Polygon(east_north_m(polygon["polygon"]))
        assert shapely.Polygon(corners_m).symmetric_difference(found).area < 1e-2
    (centre_m,) = east_north_m([circle["circle"]["center"]])
    assert centre_m == pytest.approx([30.0, 40.0], abs=1e-3)
    assert circle["circle"]["radius"] == 10.0


def test_a_zone_below_the_pose_is_left_out(placed: Placed) -> None:
    """A plan's zones have all altitudes: the barn under the pose would forbid it. That is said by name."""
    result = placed("alt_m")
    assert "left out, being above or below the pose: barn" in loss_words(result)
    beside = replace(result, pose=Pose((0.0, 0.0, 20.0), 0.0, 0.0))
    assert len(plan_of(beside)["geoFence"]["polygons"]) == 3
    assert "left out" not in loss_words(beside)


def test_a_zone_that_the_pose_touches_stays(placed: Placed) -> None:
    """The best pose often stands on the wall of a zone; that zone is the last to be left out."""
    touching = replace(placed("alt_m"), pose=Pose((40.0, 40.0, 20.0), 0.0, 0.0))
    assert len(plan_of(touching)["geoFence"]["circles"]) == 1


def test_what_is_lost_is_said(placed: Placed) -> None:
    """The attitude is dropped; the words have the value of a level hover with the yaw and the mount."""
    result = placed("alt_m")
    level = Pose(POSITION_M, 0.0, 0.0, result.pose.yaw_rad, result.pose.mount_rad)
    values_db = [10.0 * math.log10(min_sinr(result.scenario, each)) for each in (level, result.pose)]
    left, whole = (f"{value_db:.2f} dB".replace("-", "\N{MINUS SIGN}") for value_db in values_db)
    assert abs(values_db[0] - values_db[1]) > 0.1
    assert f"the smallest SINR is {left}; with the pose's attitude it is {whole}" in loss_words(result)
    assert "at yaw 27.0 deg clockwise from north" in loss_words(result)


def test_where_to_take_off_is_said(placed: Placed) -> None:
    """An altitude over home is right only from the origin's; one over the sea is right from anywhere."""
    assert "take off at the origin's altitude" in loss_words(placed("alt_m"))
    assert "take off" not in loss_words(placed("alt_msl_m"))


def test_home_is_over_what_the_waypoint_is_over(placed: Placed) -> None:
    """QGroundControl's home is over the sea; over what it is where the origin knows no sea is said."""
    for stated, height_m in (("alt_m", ORIGIN[2]), ("alt_msl_m", 185.0)):
        result = placed(stated)
        assert plan_of(result)["mission"]["plannedHomePosition"] == pytest.approx([*ORIGIN[:2], height_m])
        assert ("home's is over the ellipsoid" in loss_words(result)) == (stated == "alt_m")
    mission = plan_of(result)["mission"]
    over_home_m = mission["items"][0]["Altitude"] - mission["plannedHomePosition"][2]
    assert over_home_m == pytest.approx(result.pose.position_m[2], abs=1e-3)


def test_a_plan_is_read_back(placed: Placed, tmp_path: Path) -> None:
    """Its fence, its zones beside the pose and its home are those of the scene that it was written from."""
    result = placed("alt_msl_m")
    (tmp_path / "p.plan").write_bytes(plan_file(result))
    text = "nodes = [{ position_m = [0, 0, 1], power_w = 1 }]\n"
    text += "receiver = { noise_w = 1e-3, reference_gain_db = 0 }\n"
    airspace = 'airspace = { altitude_m = [10, 90], geofence_from = "p.plan" }\n'
    (tmp_path / "s.toml").write_text(text + airspace, encoding="utf-8")
    read, written = nullpose.load(tmp_path / "s.toml"), result.scenario
    assert read.origin.place([0.0, 0.0, 0.0]) == pytest.approx(written.origin.place([0.0, 0.0, 0.0]))
    fences = [shapely.Polygon(each.airspace.geofence_m) for each in (read, written)]
    assert fences[0].symmetric_difference(fences[1]).area < 1e-2
    kept = [zone for zone in written.airspace.no_fly if zone.name != "barn"]
    assert len(read.airspace.no_fly) == len(kept)


def test_a_scene_without_a_fence(paper: Scenario, placed: Placed) -> None:
    """Where nothing is fenced the plan fences nothing."""
    result = placed("alt_m")
    open_sky = result.scenario.model_copy(update={"airspace": paper.airspace})
    fence = plan_of(replace(result, scenario=open_sky))["geoFence"]
    assert fence == {"polygons": [], "circles": [], "version": 2}
