"""Fences and no-fly zones on the Earth: inline, from GeoJSON and from KML, all of them the same metres."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from geo_files import WRITERS, Feature, kml, placemark, write_geojson

from nullpose.scenario import Airspace, NoFlyZone, Scenario, apply_overrides, load
from nullpose.scenario.geodesy import enu_from_geodetic
from scenes import load_faults, require_fault, small

ORIGIN = [50.0, 14.5, 230.0]
FENCE = [[49.999, 14.498], [49.999, 14.506], [50.003, 14.506], [50.003, 14.498]]
ZONE = [[50.0005, 14.502], [50.0005, 14.503], [50.001, 14.5025]]
MAST = [50.0015, 14.501]
HEAD = """\
{top}
[origin]
lat_deg = 50.0
lon_deg = 14.5
alt_m = 230.0
{origin}
[receiver]
noise_w = 1e-3
reference_gain_db = 0.0
[airspace]
{airspace}
"""
NODES = """
[[nodes]]
lat_deg = 50.0
lon_deg = 14.5
alt_agl_m = 1.5
power_w = 1.0
[[nodes]]
lat_deg = 50.002
lon_deg = 14.504
alt_agl_m = 2.0
power_w = 1.0
"""


def scene(
    folder: Path, airspace: str, origin: str = "", zones: str = "", top: str = "", nodes: str = NODES
) -> Path:
    """Return the path of a scenario file."""
    path = folder / "scene.toml"
    text = HEAD.format(airspace=airspace, origin=origin, top=top) + zones + nodes
    path.write_text(text, encoding="utf-8")
    return path


def metres(corners: list[list[float]]) -> np.ndarray:
    """Return corners in degrees as east and north of the origin."""
    return enu_from_geodetic([[*corner, 230.0] for corner in corners], ORIGIN)[:, :2]


def area(corners: list[list[float]], **properties: Any) -> Feature:
    """Return an area with its properties."""
    return shapely.Polygon([corner[::-1] for corner in corners]), properties


def test_inline_fences_and_zones(tmp_path: Path) -> None:
    """Corners in degrees are the metres that their places are from the origin, and stay stated in degrees."""
    zones = f"[[airspace.no_fly]]\npolygon_lat_lon_deg = {ZONE}\naltitude_ellipsoid_m = [230.0, 260.0]\n"
    zones += f"[[airspace.no_fly]]\ncentre_lat_lon_deg = {MAST}\nradius_m = 20.0\n"
    airspace = f"altitude_ellipsoid_m = [250.0, 310.0]\ngeofence_lat_lon_deg = {FENCE}"
    scenario = load(scene(tmp_path, airspace, zones=zones))
    np.testing.assert_allclose(scenario.airspace.geofence_m, metres(FENCE), rtol=0, atol=1e-9)
    assert scenario.airspace.altitude_m == (20.0, 80.0)
    wood, mast = scenario.airspace.no_fly
    np.testing.assert_allclose(wood.polygon_m, metres(ZONE), rtol=0, atol=1e-9)
    np.testing.assert_allclose([mast.centre_m], metres([MAST]), rtol=0, atol=1e-9)
    assert (wood.altitude_m, mast.altitude_m, mast.shape) == ((0.0, 30.0), None, "cylinder")
    assert scenario.nodes[0].position_m == pytest.approx((0.0, 0.0, 1.5), abs=1e-6)
    assert Scenario.from_dict(json.loads(json.dumps(scenario.to_dict()))) == scenario


def test_files_give_the_same_scene(tmp_path: Path) -> None:
    """Inline, GeoJSON, KML, KMZ and GeoPackage state one scene; a file's zones come after the scenario's."""
    zones = f'[[airspace.no_fly]]\nname = "wood"\npolygon_lat_lon_deg = {ZONE}\n'
    inline = load(scene(tmp_path, f"altitude_m = [20, 80]\ngeofence_lat_lon_deg = {FENCE}", zones=zones))
    for ending, write in WRITERS.items():
        write(tmp_path / f"fence{ending}", [area(FENCE, stroke="#ff0000")])
        write(tmp_path / f"zones{ending}", [area(ZONE, name="wood")])
        airspace = f'altitude_m = [20, 80]\ngeofence_from = "fence{ending}"\nno_fly_from = "zones{ending}"'
        assert load(scene(tmp_path, airspace)) == inline
    mast = shapely.Point(MAST[::-1]), {"radius_m": 20.0, "altitude_m": [0, 30]}
    write_geojson(tmp_path / "mast.geojson", [mast])
    both = load(scene(tmp_path, 'altitude_m = [20, 80]\nno_fly_from = "mast.geojson"', zones=zones)).airspace
    assert [zone.shape for zone in both.no_fly] == ["polygon", "cylinder"]
    assert both.no_fly[1].altitude_m == (0.0, 30.0)


def test_what_is_set_later(tmp_path: Path) -> None:
    """When the origin moves, a fence in degrees stays on the Earth; metres drop what was stated there."""
    scenario = load(scene(tmp_path, f"altitude_ellipsoid_m = [250, 310]\ngeofence_lat_lon_deg = {FENCE}"))
    moved = apply_overrides(scenario, ["origin.lat_deg=50.001", "origin.alt_m=240"]).airspace
    expected = enu_from_geodetic([[*corner, 240.0] for corner in FENCE], [50.001, 14.5, 240.0])[:, :2]
    np.testing.assert_allclose(moved.geofence_m, expected, rtol=0, atol=1e-9)
    assert moved.altitude_m == (10.0, 70.0)
    fence = "airspace.geofence_m=[[-50, -50], [400, -50], [400, 300]]"
    changed = apply_overrides(scenario, [fence, "airspace.altitude_m=[30, 40]"]).airspace
    assert (changed.geofence_lat_lon_deg, changed.altitude_ellipsoid_m) == (None, None)
    copied = scenario.airspace.model_copy(update={"geofence_m": ((0, 0), (9, 0), (9, 9))})
    assert copied.geofence_lat_lon_deg is None


@pytest.mark.parametrize(
    ("mode", "key", "value"), [("absolute", "alt_msl_m", 187.0), ("relativeToGround", "alt_agl_m", 2.0)]
)
def test_nodes_from_kml(mode: str, key: str, value: float, tmp_path: Path) -> None:
    """KML states what its altitudes are over: the sea or the ground."""
    point = shapely.Point(14.5012, 50.0006, value)
    mark = placemark(point, {"name": "gauge", "power_dbm": 20}, f"<altitudeMode>{mode}</altitudeMode>")
    (tmp_path / "nodes.kml").write_text(kml(mark), encoding="utf-8")
    top = 'nodes_from = "nodes.kml"'
    path = scene(tmp_path, "altitude_m = [20, 80]", "alt_msl_m = 185.0", top=top, nodes="")
    (node,) = load(path).nodes
    assert (node.name, node.power_dbm, getattr(node, key)) == ("gauge", 20.0, value)
    expected = enu_from_geodetic([50.0006, 14.5012, 232.0], ORIGIN)
    np.testing.assert_allclose(node.position_m, expected, rtol=0, atol=1e-9)


def test_the_sea_is_below_the_ellipsoid_by_what_the_origin_says(tmp_path: Path) -> None:
    """Altitudes over the sea and over the ellipsoid go together where the origin states both."""
    nodes = NODES.replace("alt_agl_m = 1.5", "alt_msl_m = 186.5").replace("alt_agl_m = 2.0", "alt_m = 232.0")
    scenario = load(scene(tmp_path, "altitude_msl_m = [205, 265]", "alt_msl_m = 185.0", nodes=nodes))
    assert scenario.airspace.altitude_m == (20.0, 80.0)
    assert scenario.node_positions_m[:, 2] == pytest.approx([1.5, 2.0], abs=0.02)  # the Earth is round
    place = scenario.origin.place([0.0, 0.0, 20.0])
    assert (place["alt_m"], place["alt_msl_m"]) == pytest.approx((250.0, 205.0))


@pytest.mark.parametrize(
    ("features", "path", "words"),
    [
        ([], "features", "must be a list of one feature or more"),
        ([area(FENCE), area(ZONE)], "", "it has 2 areas, must be one polygon or circle, the fence"),
        ([(None, {})], "", "it has 0 areas"),
        ([area([corner[::-1] for corner in FENCE])], "features[0]", "are latitude and longitude exchanged?"),
        ([area([[lat, 91.0] for lat, _ in FENCE])], "", "it has 0 areas"),
        ([area([FENCE[0], FENCE[2], FENCE[1], FENCE[3]])], "features[0]", "crosses itself"),
    ],
)
def test_faults_of_a_fence_name_its_file(
    features: list[Feature], path: str, words: str, tmp_path: Path
) -> None:
    """What is wrong with a file of areas is told at its place in it, or at the fence as a whole."""
    write_geojson(tmp_path / "fence.geojson", features)
    faults = load_faults(scene(tmp_path, 'altitude_m = [20, 80]\ngeofence_from = "fence.geojson"'))
    assert any(words in fault.message for fault in faults)
    assert path in faults[0].path
    assert all(fault.path.startswith("airspace.geofence_from: fence.geojson") for fault in faults)


SQUARE = [[0, 0], [100, 0], [100, 100], [0, 100]]
EXCHANGED = "are latitude and longitude exchanged?) (and so in 2 more)"
EAST = [[121.0, 25.0], [121.1, 25.0], [121.1, 25.1]]


@pytest.mark.parametrize(
    ("airspace", "path", "words"),
    [
        ('no_fly_from = "../zones.kml"', "airspace.no_fly_from: ../zones.kml", "outside the folder"),
        (f"geofence_m = {SQUARE}\ngeofence_lat_lon_deg = {FENCE}", "airspace", "geofence_m and geofence_lat"),
        (f"geofence_lat_lon_deg = {EAST}", "airspace.geofence_lat_lon_deg[0][0]", EXCHANGED),
    ],
)
def test_faults_of_inline_areas(airspace: str, path: str, words: str, tmp_path: Path) -> None:
    """A file elsewhere, metres that disagree with degrees, and an exchange, told once for all corners."""
    require_fault(lambda: load(scene(tmp_path, f"altitude_m = [20, 80]\n{airspace}")), path, words)


@pytest.mark.parametrize("text", ["", "<kml", "<gpx/>", "<!DOCTYPE kml [<!ENTITY a 'b'>]><kml>&a;</kml>"])
def test_what_is_no_kml(text: str, tmp_path: Path) -> None:
    """Broken XML, and XML that declares entities, is refused."""
    (tmp_path / "fence.kml").write_text(text, encoding="utf-8")
    (fault,) = load_faults(scene(tmp_path, 'altitude_m = [20, 80]\ngeofence_from = "fence.kml"'))
    assert fault.path.startswith("airspace.geofence_from: fence.kml")


def test_degrees_need_an_origin() -> None:
    """Without a scenario, or without its origin, degrees and absolute altitudes are refused, not left out."""
    for make, path, words in (
        (
            lambda: Airspace(altitude_m=(8, 30), geofence_lat_lon_deg=FENCE),
            "geofence_lat_lon_deg",
            "needs the [ori",
        ),
        (lambda: NoFlyZone(centre_lat_lon_deg=MAST, radius_m=5), "centre_lat_lon_deg", "needs the [origin]"),
        (
            lambda: Scenario.from_dict(small(airspace={"altitude_msl_m": [2, 3]})),
            "origin",
            "by altitude_msl_m",
        ),
    ):
        require_fault(make, path, words)
