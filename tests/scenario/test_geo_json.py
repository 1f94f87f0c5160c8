"""JSON that holds areas: GeoJSON as a whole, plans of QGroundControl, and the names of what is not read."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from geo_files import HERE, in_metres, require_kept_out, require_refusal, scene, write_gdal, zones_of
from shapely.geometry import mapping

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario, load

SQUARE = shapely.box(14.498, 49.999, 14.502, 50.001)
POND = shapely.box(14.499, 49.9995, 14.4995, 50.0)
FEATURE = {"type": "Feature", "geometry": mapping(SQUARE), "properties": {}}


def collection(**more: Any) -> str:
    """Return a file of one square, with more members."""
    return json.dumps({"type": "FeatureCollection", "features": [FEATURE], **more})


ED_269 = {"identifier": "X", "geometry": [{"horizontalProjection": {"type": "Circle", "radius": 50}}]}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ({"features": [ED_269]}, "ED-269 JSON, .*convert it to ED-318"),
        ({"UASZoneList": [ED_269]}, "ED-269"),
        ([ED_269], "ED-269"),
        ({"type": "FeatureCollection", "features": [ED_269]}, "ED-269"),
        ({"geometryType": "esriGeometryPolygon", "features": [{"geometry": {"rings": []}}]}, "f=geojson"),
        ({"version": 0.6, "elements": [{"type": "way"}]}, "Overpass JSON, .*GeoJSON"),
        ({"type": "Topology", "objects": {}}, "TopoJSON"),
        ({"volumes": [{"outline_circle": {}}]}, "ASTM"),
        ({"areas": [{"sub_areas": []}]}, "DJI"),
        ({"limit": 1, "items": [FEATURE]}, "openAIP"),
        ({"type": "FeatureCollection", "features": 5}, "got 5, must be a list"),
    ],
)
def test_other_json_is_refused_by_its_name(content: Any, words: str, tmp_path: Path) -> None:
    """With the way out."""
    (tmp_path / "z.json").write_text(json.dumps(content), encoding="utf-8")
    require_refusal(tmp_path, "z.json", words)


@pytest.mark.parametrize("sign", ["", "\x1e"])
def test_geojson_in_lines_is_refused_by_its_name(sign: str, tmp_path: Path) -> None:
    """Of two features or more; a line by itself is GeoJSON."""
    line = sign + json.dumps(FEATURE)
    (tmp_path / "z.json").write_text(f"{line}\n{line}\n", encoding="utf-8")
    require_refusal(tmp_path, "z.json", "GeoJSON in lines")
    (tmp_path / "z.json").write_text(json.dumps(FEATURE) + "\n", encoding="utf-8")
    assert len(zones_of(tmp_path, "z.json")[0].airspace.no_fly) == 1


@pytest.mark.parametrize(
    "more", [{"exceededTransferLimit": True}, {"numberMatched": 900, "numberReturned": 1}]
)
def test_a_part_of_a_list_is_refused(more: dict[str, Any], tmp_path: Path) -> None:
    """A server says so where it sends no more at once."""
    (tmp_path / "z.json").write_text(collection(**more), encoding="utf-8")
    require_refusal(tmp_path, "z.json", "a part of what its server holds")


@pytest.mark.parametrize("name", ["EPSG:4326", "urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4258",
                                  "http://www.opengis.net/def/crs/OGC/1.3/CRS84", "CRS84"])  # fmt: skip
def test_names_of_wgs_84(name: str, tmp_path: Path) -> None:
    """Each as it is in use; the code alone, too."""
    crs = {"type": "name", "properties": {"name": name}}
    (tmp_path / "z.json").write_text(collection(crs=crs), encoding="utf-8")
    assert len(zones_of(tmp_path, "z.json")[0].airspace.no_fly) == 1


@pytest.mark.parametrize("name", ["EPSG:14326", "urn:ogc:def:crs:EPSG::3857", "EPSG:43260", "NOTCRS84"])
def test_other_reference_systems_are_named(name: str, tmp_path: Path) -> None:
    """Whatever they end in."""
    crs = {"type": "name", "properties": {"name": name}}
    (tmp_path / "z.json").write_text(collection(crs=crs), encoding="utf-8")
    require_refusal(tmp_path, "z.json", f"crs: got {name}, must be WGS 84")


def plan(shapes: Sequence[Any] = (), radii: Sequence[Any] = (), **more: Any) -> str:
    """Return a plan with its fence: each polygon or radius, and whether it is to be stayed in."""
    listed = [
        {"polygon": [[y, x] for x, y in shape.exterior.coords[:-1]], "inclusion": inside, "version": 1}
        for shape, inside in shapes
    ]
    rounds = [
        {"circle": {"center": [HERE[1], HERE[0]], "radius": radius_m}, "inclusion": inside, "version": 1}
        for radius_m, inside in radii
    ]
    fence = {"polygons": listed, "circles": rounds, "version": 2, **more}
    home = [HERE[1], HERE[0], 100.0]
    return json.dumps(
        {"fileType": "Plan", "version": 1, "geoFence": fence, "mission": {"plannedHomePosition": home}}
    )


def fenced(folder: Path, file: str, content: str, origin: bool = True) -> tuple[Scenario, list[str]]:
    """Return the scenario whose fence is in a file, and the notes of loading it."""
    (folder / file).write_text(content, encoding="utf-8")
    path = scene(folder, f'altitude_m = [10.0, 120.0]\ngeofence_from = "{file}"')
    if not origin:
        path.write_text(
            "[receiver]" + path.read_text(encoding="utf-8").partition("[receiver]")[2], encoding="utf-8"
        )
    notes: list[str] = []
    return load(path, on_note=notes.append), notes


def test_a_plan_is_a_fence_with_zones(tmp_path: Path) -> None:
    """What is included is the fence, what is excluded are zones; its home is a point."""
    scenario, notes = fenced(tmp_path, "p.plan", plan([(SQUARE, True), (POND, False)], [(20.0, False)]))
    fence = shapely.Polygon(scenario.airspace.geofence_m)
    assert fence.symmetric_difference(in_metres(SQUARE)).area < 1e-6 * fence.area
    pond, tower = scenario.airspace.no_fly
    assert shapely.Polygon(pond.polygon_m).symmetric_difference(in_metres(POND)).area < 1e-3
    assert (tower.centre_m, tower.radius_m) == (pytest.approx((0.0, 0.0), abs=1e-6), 20.0)
    assert notes == [
        "p.plan: fence: 1 polygon; passed over: 1 point",
        "p.plan: zones: 2 of 2 in reach (1 polygon, 1 cylinder)",
    ]


def test_the_zones_of_a_plan(tmp_path: Path) -> None:
    """Without a fence it has zones alone; one that would be lost is refused."""
    (tmp_path / "z.plan").write_text(plan([(POND, False)]), encoding="utf-8")
    require_kept_out(zones_of(tmp_path, "z.plan")[0], in_metres(POND))
    (tmp_path / "z.plan").write_text(plan([(SQUARE, True), (POND, False)]), encoding="utf-8")
    require_refusal(tmp_path, "z.plan", "an area to stay in")


def test_the_home_of_a_plan_is_the_origin_where_none_is_stated(tmp_path: Path) -> None:
    """Its altitude is over the sea."""
    text = plan([(SQUARE, True)])
    scenario, notes = fenced(tmp_path, "p.plan", text, origin=False)
    assert scenario.origin is not None
    assert (scenario.origin.lat_deg, scenario.origin.lon_deg) == (HERE[1], HERE[0])
    assert (scenario.origin.alt_msl_m, scenario.origin.alt_m) == (100.0, None)
    assert "its home is the origin" in notes[0]
    with pytest.raises(ScenarioError, match="origin"):
        fenced(tmp_path, "p.plan", text.replace("plannedHomePosition", "home"), origin=False)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (plan(), "0 areas"),
        (plan([(SQUARE, True), (POND, True)]), "2 areas"),
        (plan([(SQUARE, None)]), "must state inclusion"),
        (plan([], [(None, True)]), "the radius"),
        (plan(polygon=[[1, 2]]), "polygon is not read"),
        (plan(polygons=[{"polygon": 7, "inclusion": True}]), r"polygons\[0\]"),
        (plan(polygons=7), r"polygons\[0\]"),
    ],
)
def test_plans_that_are_refused(content: str, words: str, tmp_path: Path) -> None:
    """At their place in the plan."""
    with pytest.raises(ScenarioError, match=words):
        fenced(tmp_path, "p.plan", content)


@pytest.mark.parametrize("radius_m", [0.5, 100.0, 20_000.0])
def test_a_round_fence_is_a_polygon_in_its_circle(radius_m: float, tmp_path: Path) -> None:
    """No point of it is outside, and it is smaller by 0.015 % of the radius: that is said."""
    middle = {"type": "Point", "coordinates": HERE}
    content = json.dumps({"type": "Feature", "geometry": middle, "properties": {"radius_m": radius_m}})
    scenario, notes = fenced(tmp_path, "f.json", content)
    corners_m = np.array(scenario.airspace.geofence_m)
    inside = shapely.Polygon(corners_m)
    assert np.linalg.norm(corners_m, axis=1) == pytest.approx(radius_m, rel=3e-5)
    assert shapely.distance(inside.exterior, shapely.Point(0.0, 0.0)) > 0.9998 * radius_m
    assert f"its circle of {radius_m:g} m counts as a polygon of 180 sides in it" in notes[-1]


def test_a_file_of_zones_without_one_is_refused(tmp_path: Path) -> None:
    """A point whose radius is under another name and a line with a width are named."""
    features = [
        {"type": "Feature", "geometry": geometry, "properties": properties}
        for geometry, properties in (
            ({"type": "Point", "coordinates": HERE}, {"Radius": 120}),
            ({"type": "LineString", "coordinates": [[14.5, 50.0], [14.6, 50.0]]}, {"width_m": 60}),
        )
    ]
    text = json.dumps({"type": "FeatureCollection", "features": features})
    (tmp_path / "z.json").write_text(text, encoding="utf-8")
    require_refusal(
        tmp_path, "z.json", "nothing in it is a zone: .*1 point, 1 line; Radius, width_m is not read"
    )


ENDINGS = (".shp", ".shx", ".dbf")
SQUARES = [shapely.box(14.5 + east, 50.0, 14.501 + east, 50.001) for east in (0.0, 0.01, 0.02)]


def written(folder: Path, count: int) -> dict[str, bytes]:
    """Return the parts of a shapefile of squares, after writing them."""
    write_gdal(folder / "z.shp", [(square, {"name": f"{n}"}) for n, square in enumerate(SQUARES[:count])])
    return {ending: (folder / f"z{ending}").read_bytes() for ending in ENDINGS}


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_part_of_another_number_of_records_is_refused(ending: str, tmp_path: Path) -> None:
    """Of more, of fewer, or none: GDAL would read what all of them have, and say nothing."""
    two, three = (written(tmp_path, count) for count in (2, 3))
    (tmp_path / f"z{ending}").write_bytes(two[ending])
    require_refusal(tmp_path, "z.shp", "its parts do not agree")
    written(tmp_path, 2)
    (tmp_path / f"z{ending}").write_bytes(three[ending])
    require_refusal(tmp_path, "z.shp", "its parts do not agree")
    (tmp_path / f"z{ending}").unlink()
    require_refusal(tmp_path, "z.shp", "needs its .shx and its .dbf" if ending != ".shp" else "z.shp")


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("left", [0.3, 0.9, 0.99])
def test_a_part_that_is_cut_short_is_refused(ending: str, left: float, tmp_path: Path) -> None:
    """Wherever it ends."""
    whole = written(tmp_path, 3)[ending]
    (tmp_path / f"z{ending}").write_bytes(whole[: int(left * len(whole))])
    require_refusal(tmp_path, "z.shp", "do not agree|cannot be read")


def test_a_whole_one_is_read(tmp_path: Path) -> None:
    """Its endings may be in capitals."""
    written(tmp_path, 3)
    assert len(zones_of(tmp_path, "z.shp")[0].airspace.no_fly) == 3
    for ending in (*ENDINGS, ".prj"):
        (tmp_path / f"z{ending}").rename(tmp_path / f"z{ending.upper()}")
    assert len(zones_of(tmp_path, "z.SHP")[0].airspace.no_fly) == 3
