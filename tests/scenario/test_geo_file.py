"""Geographic files: what they keep out is what shapely says, whatever the format, or they are refused."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import numpy as np
import pyogrio
import pytest
import shapely
from geo_files import (
    HERE,
    WRITERS,
    Feature,
    filled,
    in_metres,
    kml,
    placemark,
    require_kept_out,
    require_refusal,
    scene,
    star,
    write_gdal,
    write_geojson,
    write_kml,
    zones,
    zones_of,
)
from sizes import diagonal

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario, load


@pytest.mark.parametrize(("ending", "seed"), diagonal([*WRITERS], range(3)))
def test_what_is_kept_out_is_shapelys_union(ending: str, seed: int, tmp_path: Path) -> None:
    """Of polygons, multi-polygons and collections in any order; 2,000 positions are as shapely says."""
    rng = np.random.default_rng([seed, len(ending)])
    features: list[Feature] = []
    for index in range(8):
        parts = [star(rng) for _ in range(rng.integers(1, 4))]
        whole = shapely.union_all(parts)
        if ending != ".gpkg" and index % 3 == 2:
            whole = shapely.GeometryCollection(
                [shapely.Point(HERE), shapely.MultiPolygon([parts[0]]), *parts[1:]]
            )
        features.append((whole, {"name": f"zone {index // 2}"}))
    scenario, notes = zones(tmp_path, features, ending)
    areas = [
        in_metres(filled(shapely.union_all([part for part in _leaves(shape) if part.geom_type == "Polygon"])))
        for shape, _ in features
    ]
    expected = shapely.union_all(areas)
    require_kept_out(scenario, expected)
    assert notes[0].startswith(f"z{ending}: zones: 8 of 8 in reach (")
    low, high = np.array(expected.bounds[:2]) - 50.0, np.array(expected.bounds[2:]) + 50.0
    positions_m = np.column_stack([rng.uniform(low, high, (2000, 2)), np.full(2000, 60.0)])
    clear = shapely.distance(expected.boundary, shapely.points(positions_m[:, :2])) > 1e-3
    assert clear.sum() > 1900
    allowed = scenario.airspace.allows(positions_m)
    np.testing.assert_array_equal(allowed[clear], ~shapely.contains_xy(expected, positions_m[:, :2])[clear])


def _leaves(shape: Any) -> list[Any]:
    return [leaf for part in shape.geoms for leaf in _leaves(part)] if hasattr(shape, "geoms") else [shape]


SQUARE = shapely.box(14.502, 50.002, 14.504, 50.004)


@pytest.mark.parametrize("ending", WRITERS)
def test_every_feature_is_accounted_for(ending: str, tmp_path: Path) -> None:
    """Points without a radius and open lines are counted, closed lines are zones, walls cover nothing."""
    ring = shapely.LineString([(14.51, 50.0), (14.512, 50.0), (14.512, 50.002), (14.51, 50.0)])
    wall = shapely.Polygon([(14.5, 50.01), (14.501, 50.01), (14.5, 50.01)])
    far = shapely.box(20.0, 52.0, 20.1, 52.1)
    features: list[Feature] = [
        (SQUARE, {"name": "A"}),
        (SQUARE.buffer(0.001) - SQUARE, {"name": "A"}),
        (ring, {"name": 7}),
        (shapely.Point(14.49, 49.99), {"name": "mast", "radius_m": 30.0}),
        (shapely.Point(14.49, 49.99), {"name": "tree"}),
        (shapely.LineString([(14.5, 50.0), (14.6, 50.1)]), {"name": "road"}),
        (wall, {"name": "wall"}),
        (far, {"name": "far"}),
    ]
    scenario, notes = zones(tmp_path, features, ending)
    assert sorted(zone.name for zone in scenario.airspace.no_fly) == ["7", "A", "A 2", "mast"]
    assert notes == [
        f"z{ending}: zones: 4 of 5 in reach (3 polygons, 1 cylinder); passed over: 1 point, 1 line, 1 wall; "
        "holes filled: 1"
    ]


def test_roof_floor_and_walls_are_one_zone(tmp_path: Path) -> None:
    """Of a solid in KML, in any order; its absolute heights are the zone's."""
    ring = [(14.502, 50.002), (14.504, 50.002), (14.504, 50.004), (14.502, 50.004)]
    faces = [shapely.Polygon([(*corner, height) for corner in ring]) for height in (130.0, 180.0)]
    for (a, b), (c, d) in zip(ring, [*ring[1:], ring[0]], strict=True):
        faces.append(shapely.Polygon([(a, b, 130.0), (c, d, 130.0), (c, d, 180.0), (a, b, 180.0)]))
    for seed in range(4):
        random.Random(seed).shuffle(faces)
        solid = shapely.GeometryCollection(faces)
        text = kml(placemark(solid, {"name": "D"}, "<altitudeMode>absolute</altitudeMode>"))
        (tmp_path / "z.kml").write_text(text, encoding="utf-8")
        scenario, notes = zones_of(tmp_path, "z.kml")
        (zone,) = scenario.airspace.no_fly
        assert zone.altitude_m == pytest.approx((30.0, 80.0))
        expected = in_metres(shapely.Polygon(ring))
        assert shapely.Polygon(zone.polygon_m).symmetric_difference(expected).area < 1e-6 * expected.area
        assert notes == ["z.kml: zones: 1 of 1 in reach (1 polygon)"]


LAYER = {"lowerReference": "AGL", "upperReference": "AGL", "uom": "m"}


@pytest.mark.parametrize(
    ("properties", "expected"),
    [
        ({"altitude_m": [0, 30]}, (0.0, 30.0)),
        ({"altitude_msl_m": [150, 200]}, (50.0, 100.0)),
        ({"layer": LAYER | {"lower": 100, "upper": 200, "uom": "ft"}},
         (30.48, 60.96)),
        ({"layer": LAYER | {"lower": 0, "upper": 120, "upperReference": "AMSL"}},
         (None, 20.0)),
        ({"layer": LAYER | {"lower": 50, "upper": 200, "upperReference": "AMSL"}},
         (50.0, 100.0)),
        ({"lowerCeiling": {"value": 8000, "unit": "FT", "referenceDatum": "MSL"},
          "upperCeiling": {"value": 100, "unit": "FL", "referenceDatum": "STD"}}, (2338.4, 3548.0)),
        ({"lowerLimit": {"value": 0, "unit": 1, "referenceDatum": 0},
          "upperLimit": {"value": 1000, "unit": 1, "referenceDatum": 1}}, (None, 204.8)),
    ],
)  # fmt: skip
def test_altitudes_are_read(properties: dict[str, Any], expected: tuple[Any, float], tmp_path: Path) -> None:
    """Own keys, ED-318's layer and openAIP's ceilings, over ground, sea and standard pressure."""
    scenario, notes = zones(tmp_path, [(SQUARE, {"name": "A", **properties})])
    low_m, high_m = scenario.airspace.no_fly[0].altitude_m or (0.0, 0.0)
    assert high_m == pytest.approx(expected[1])
    assert low_m == pytest.approx(expected[0]) if expected[0] is not None else low_m < -1e5
    assert len(notes) == 1


def test_limits_that_are_not_read_are_said(tmp_path: Path) -> None:
    """A property that looks like a limit or a time, under a name that is not known."""
    features = [(SQUARE, {"name": "X", "upper_limit": 5}), (SQUARE, {"name": "Y", "schedule": 1})]
    scenario, notes = zones(tmp_path, features)
    assert all(zone.altitude_m is None for zone in scenario.airspace.no_fly)
    assert 'z.geojson: "X" counts at all altitudes; not read: upper_limit' in notes
    assert any('"Y" counts at all times; not read: schedule' in note for note in notes)


def test_altitudes_over_different_things_need_an_origin_that_states_both(tmp_path: Path) -> None:
    """A zone between the ground and the sea is refused by name, with the key that is missing."""
    layer = LAYER | {"lower": 50, "upper": 200, "upperReference": "WGS84"}
    write_geojson(tmp_path / "z.geojson", [(SQUARE, {"name": "A", "layer": layer})])
    path = scene(tmp_path, 'altitude_m = [10.0, 120.0]\nno_fly_from = "z.geojson"')
    assert load(path).airspace.no_fly[0].altitude_m == pytest.approx((50.0, 200.0))
    path.write_text(path.read_text().replace("alt_m = 0.0\n", ""), encoding="utf-8")
    with pytest.raises(ScenarioError, match=r"features\[0\].*add alt_m to \[origin\]"):
        load(path)


def test_a_fence_bounds_the_altitude_and_its_holes_are_zones(tmp_path: Path) -> None:
    """An altitude beside a fence is no decoration."""
    fence = shapely.box(14.49, 49.99, 14.51, 50.01) - SQUARE
    write_geojson(tmp_path / "f.geojson", [(fence, {"altitude_msl_m": [90, 130]}), (shapely.Point(HERE), {})])
    notes: list[str] = []
    path = scene(tmp_path, 'altitude_m = [10.0, 120.0]\ngeofence_from = "f.geojson"')
    scenario = load(path, on_note=notes.append)
    assert scenario.airspace.altitude_m == pytest.approx((10.0, 30.0))
    require_kept_out(scenario, in_metres(SQUARE))
    assert notes == [
        "f.geojson: fence: 1 polygon; passed over: 1 point; holes that are zones: 1; "
        "altitude_msl_m = [90, 130]"
    ]
    write_geojson(tmp_path / "f.geojson", [(fence, {"altitude_msl_m": [300, 400]})])
    with pytest.raises(ScenarioError, match="has no altitude in common"):
        load(path)


@pytest.mark.parametrize("split", [False, True])
@pytest.mark.parametrize("lon", [179.999, -179.999])
def test_an_area_may_cross_the_antimeridian(split: bool, lon: float, tmp_path: Path) -> None:
    """In one ring or cut there, seen from either side."""
    here = (lon, 10.0)
    edge = [(180.0, 10.001), (180.002, 10.001), (180.002, 10.003), (180.0, 10.003)]
    crossing = shapely.Polygon([(179.998, 10.001), *(edge if split else edge[1:3]), (179.998, 10.003)])
    parts = shapely.MultiPolygon(
        [shapely.box(179.998, 10.001, 180.0, 10.003), shapely.box(-180.0, 10.001, -179.998, 10.003)]
    )
    ring = shapely.Polygon([(179.998, 10.001), (-179.998, 10.001), (-179.998, 10.003), (179.998, 10.003)])
    scenario, _ = zones(tmp_path, [(parts if split else ring, {"name": "A"})], here=here)
    require_kept_out(scenario, in_metres(crossing, here))
    assert Scenario.from_dict(json.loads(json.dumps(scenario.to_dict()))) == scenario


def test_doubled_corners_and_spikes_are_no_faults(tmp_path: Path) -> None:
    """Corners under a centimetre apart are one, a spike has no area; a crossing is refused by name."""
    corners = [(14.502, 50.002), (14.502, 50.002), (14.504, 50.002), (14.5045, 50.0015), (14.504, 50.002)]
    corners += [(14.504, 50.004), (14.504 + 5e-8, 50.004), (14.502, 50.004)]
    scenario, _ = zones(tmp_path, [(shapely.Polygon(corners), {"name": "A"})])
    require_kept_out(scenario, in_metres(SQUARE))
    bow = shapely.Polygon([(14.502, 50.002), (14.504, 50.004), (14.504, 50.002), (14.502, 50.004)])
    write_geojson(tmp_path / "z.geojson", [(bow, {"name": "bow"}), (bow, {"name": "tie"})])
    with pytest.raises(ScenarioError) as caught:
        zones_of(tmp_path, "z.geojson")
    assert [fault.path for fault in caught.value.faults] == [
        f"airspace.no_fly_from: z.geojson: features[{index}]" for index in (0, 1)
    ]
    write_kml(tmp_path / "z.kml", [(bow, {"name": "bow"}), (bow, {"name": "tie"})])
    require_refusal(tmp_path, "z.kml", 'Placemark "tie"')


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (kml("<NetworkLink><Link><href>more.kml</href></Link></NetworkLink>"), "NetworkLink"),
        (kml("<Placemark><Polygon><LinearRing><coordinates>14,50 15,50 15,51 14,50</coordinates></LinearRing>"
             "</Polygon></Placemark>"), "without its outerBoundaryIs"),
        (kml("<GroundOverlay><LatLonBox/></GroundOverlay>"), "GroundOverlay"),
        (kml('<Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>14.5, 50.0 14.6, 50.0 14.6, 50.1'
             '</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>'), "without blanks"),
    ],
)  # fmt: skip
def test_kml_that_is_not_read_is_refused_by_name(text: str, words: str, tmp_path: Path) -> None:
    """What may hold areas and is not read, and coordinates that would be read as others."""
    (tmp_path / "z.kml").write_text(text, encoding="utf-8")
    require_refusal(tmp_path, "z.kml", words)


def test_ed_269_and_other_reference_systems_are_refused_by_name(tmp_path: Path) -> None:
    """ETRS89 is WGS 84 to less than a metre, and accepted."""
    (tmp_path / "z.json").write_text('{"features": [{"identifier": "A", "geometry": [{}]}]}')
    require_refusal(tmp_path, "z.json", "ED-269")
    write_gdal(tmp_path / "a.gpkg", [(SQUARE, {"name": "A"})], "EPSG:3857")
    require_refusal(tmp_path, "a.gpkg", "EPSG:3857, must be WGS 84")
    write_gdal(tmp_path / "b.gpkg", [(SQUARE, {"name": "A"})], "EPSG:4258")
    assert len(zones_of(tmp_path, "b.gpkg")[0].airspace.no_fly) == 1
    write_gdal(tmp_path / "c.shp", [(SQUARE, {"name": "A"})])
    assert len(zones_of(tmp_path, "c.shp")[0].airspace.no_fly) == 1
    (tmp_path / "c.prj").unlink()
    require_refusal(tmp_path, "c.shp", "there is none, must be WGS 84")


def test_a_file_of_another_kind_reads_no_other_file(tmp_path: Path) -> None:
    """GDAL goes by the content; a description of a virtual file that leads elsewhere is refused by us."""
    text = '<OGRVRTDataSource><OGRVRTLayer name="z"><SrcDataSource>/etc/passwd</SrcDataSource></OGRVRTLayer>'
    for ending in (".kml", ".gpkg", ".shp", ".gpx", ".kmz", ".geojson"):
        (tmp_path / f"z{ending}").write_text(f"{text}</OGRVRTDataSource>", encoding="utf-8")
        with pytest.raises(ScenarioError):
            zones_of(tmp_path, f"z{ending}")


def test_layers_need_no_name_of_their_own(tmp_path: Path) -> None:
    """Of folders with one name, as of those without any, none is left out; a table of styles is no area."""
    two = kml(placemark(SQUARE, {"name": 1}), placemark(SQUARE, {"name": 2}))
    for text in (two, kml(placemark(SQUARE, {}))):
        for content in (text, text.replace("<name>areas</name>", "")):
            (tmp_path / "z.kml").write_text(content, encoding="utf-8")
            assert len(zones_of(tmp_path, "z.kml")[0].airspace.no_fly) == text.count("<Placemark>")
    write_gdal(tmp_path / "z.gpkg", [(SQUARE, {"name": "A"})])
    pyogrio.raw.write(tmp_path / "z.gpkg", None, [np.array(["x"], object)], ["style"], layer="s", append=True)
    scenario, notes = zones_of(tmp_path, "z.gpkg")
    assert [zone.name for zone in scenario.airspace.no_fly] == ["A"]
    assert "1 feature without a place" in notes[0]


def test_waypoints_of_gpx_are_nodes(tmp_path: Path) -> None:
    """Their elevation is over the sea; the track is passed over and counted."""
    text = '<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1">'
    text += '<wpt lat="50.001" lon="14.501"><ele>103</ele><name>W</name></wpt>'
    text += '<trk><trkseg><trkpt lat="50" lon="14"/><trkpt lat="51" lon="14"/></trkseg></trk></gpx>'
    (tmp_path / "n.gpx").write_text(text, encoding="utf-8")
    path = scene(tmp_path, "altitude_m = [10.0, 120.0]")
    plain = path.read_text(encoding="utf-8").split("[[nodes]]")[0]
    path.write_text(f'nodes_from = "n.gpx"\n{plain}', encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:  # a waypoint has no power
        load(path)
    (fault,) = caught.value.faults
    assert fault.path == 'n.gpx: waypoints "W"'
    assert "power_w" in fault.message
    dbm = text.replace("</name>", "</name><extensions><power_dbm>20</power_dbm></extensions>")
    (tmp_path / "n.gpx").write_text(dbm, encoding="utf-8")
    notes: list[str] = []
    (node,) = load(path, on_note=notes.append).nodes
    assert (node.name, node.alt_msl_m, node.power_dbm) == ("W", 103.0, 20.0)
    assert notes == ["n.gpx: nodes: 1; passed over: 1 line"]
