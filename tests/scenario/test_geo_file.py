"""Geographic files: what they keep out is what shapely says, whatever the format, or they are refused."""

from __future__ import annotations

import json
import random
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyogrio
import pytest
import shapely
from shapely.geometry import mapping

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario, load
from nullpose.scenario.geodesy import enu_from_geodetic

HERE = (14.5, 50.0)
SCENE = """\
[origin]
lat_deg = {lat}
lon_deg = {lon}
alt_m = 0.0
alt_msl_m = 100.0
[receiver]
noise_w = 1e-3
reference_gain_db = 0.0
[airspace]
{airspace}
[[nodes]]
lat_deg = {lat}
lon_deg = {lon}
alt_agl_m = 1.5
power_w = 1.0
"""

Feature = tuple[Any, dict[str, Any]]


def scene(folder: Path, airspace: str, here: tuple[float, float] = HERE) -> Path:
    """Return the path of a scenario file."""
    path = folder / "scene.toml"
    path.write_text(SCENE.format(lon=here[0], lat=here[1], airspace=airspace), encoding="utf-8")
    return path


def zones_of(folder: Path, file: str, here: tuple[float, float] = HERE) -> tuple[Scenario, list[str]]:
    """Return the scenario with the zones of a file, and the notes of loading it."""
    notes: list[str] = []
    path = scene(folder, f'altitude_m = [10.0, 120.0]\nno_fly_from = "{file}"', here)
    return load(path, on_note=notes.append), notes


def write_geojson(path: Path, features: list[Feature]) -> None:
    """Write features as GeoJSON."""
    members = [
        {"type": "Feature", "geometry": mapping(shape), "properties": properties}
        for shape, properties in features
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": members}), encoding="utf-8")


def kml_of(shape: Any, more: str = "") -> str:
    """Return a geometry as KML."""
    kind = shape.geom_type
    if hasattr(shape, "geoms"):
        return f"<MultiGeometry>{''.join(kml_of(part, more) for part in shape.geoms)}</MultiGeometry>"

    def chain(line: Any) -> str:
        places = " ".join(",".join(repr(x) for x in place) for place in line.coords)
        return f"<coordinates>{places}</coordinates>"

    if kind != "Polygon":
        return f"<{kind}>{more}{chain(shape)}</{kind}>"
    rings = f"<outerBoundaryIs><LinearRing>{chain(shape.exterior)}</LinearRing></outerBoundaryIs>"
    for ring in shape.interiors:
        rings += f"<innerBoundaryIs><LinearRing>{chain(ring)}</LinearRing></innerBoundaryIs>"
    return f"<Polygon>{more}{rings}</Polygon>"


def kml(*placemarks: str) -> str:
    """Return a KML document, its placemarks in two folders."""
    half = len(placemarks) // 2
    folders = "".join(
        f"<Folder><name>areas</name>{''.join(some)}</Folder>"
        for some in (placemarks[:half], placemarks[half:])
    )
    return f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{folders}</Document></kml>'


def placemark(shape: Any, properties: dict[str, Any], more: str = "") -> str:
    """Return a placemark."""
    data = "".join(
        f'<Data name="{key}"><value>{value}</value></Data>'
        for key, value in properties.items()
        if key != "name"
    )
    name = f"<name>{properties['name']}</name>" if "name" in properties else ""
    return f"<Placemark>{name}<ExtendedData>{data}</ExtendedData>{kml_of(shape, more)}</Placemark>"


def write_kml(path: Path, features: list[Feature]) -> None:
    """Write features as KML."""
    path.write_text(kml(*(placemark(*feature) for feature in features)), encoding="utf-8")


def write_kmz(path: Path, features: list[Feature]) -> None:
    """Write features as KMZ."""
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("doc.kml", kml(*(placemark(*feature) for feature in features)))


def write_gdal(path: Path, features: list[Feature], crs: str | None = "EPSG:4326") -> None:
    """Write features by GDAL, in the format that the ending says."""
    keys = sorted({key for _, properties in features for key in properties})
    columns = [np.array([str(properties.get(key, "")) for _, properties in features], object) for key in keys]
    pyogrio.raw.write(
        path,
        shapely.to_wkb(np.array([shape for shape, _ in features])),
        columns,
        keys,
        crs=crs,
        geometry_type="Unknown" if path.suffix == ".gpkg" else features[0][0].geom_type,
    )


WRITERS: dict[str, Callable[[Path, list[Feature]], None]] = {
    ".geojson": write_geojson,
    ".kml": write_kml,
    ".kmz": write_kmz,
    ".gpkg": write_gdal,
}


def kept_out(scenario: Scenario) -> Any:
    """Return what the zones of a scenario cover, in metres."""
    return shapely.union_all([shapely.Polygon(zone.polygon_m) for zone in scenario.airspace.no_fly])


def in_metres(shape: Any, here: tuple[float, float] = HERE) -> Any:
    """Return a geometry of degrees in metres."""

    def metres(corners: np.ndarray) -> np.ndarray:
        places = np.column_stack([corners[:, 1], corners[:, 0], np.zeros(len(corners))])
        return enu_from_geodetic(places, [here[1], here[0], 0.0])[:, :2]

    return shapely.transform(shape, metres)


def star(rng: np.random.Generator, far: float = 0.01) -> Any:
    """Return a polygon of degrees near the origin, concave, sometimes with a hole."""
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(3, 12)))
    radii = rng.uniform(0.0005, 0.003, len(angles))
    centre = np.array(HERE) + rng.uniform(-far, far, 2)
    polygon = shapely.Polygon(centre + radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)]))
    if not polygon.is_valid or polygon.area < 1e-8:
        return star(rng, far)
    inner = polygon.buffer(-2e-4)
    return polygon - inner if rng.uniform() < 0.3 and inner.geom_type == "Polygon" else polygon


def filled(shape: Any) -> Any:
    """Return what a zone keeps out: its parts united, without their holes."""
    return shapely.MultiPolygon([shapely.Polygon(part.exterior) for part in shapely.get_parts(shape)])


@pytest.mark.parametrize("ending", WRITERS)
@pytest.mark.parametrize("seed", range(6))
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
    WRITERS[ending](tmp_path / f"zones{ending}", features)
    scenario, notes = zones_of(tmp_path, f"zones{ending}")
    areas = [
        in_metres(filled(shapely.union_all([part for part in _leaves(shape) if part.geom_type == "Polygon"])))
        for shape, _ in features
    ]
    expected = shapely.union_all(areas)
    assert kept_out(scenario).symmetric_difference(expected).area <= 1e-6 * expected.area
    assert notes[0].startswith(f"zones{ending}: zones: 8 of 8 in reach (")
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
    WRITERS[ending](tmp_path / f"z{ending}", features)
    scenario, notes = zones_of(tmp_path, f"z{ending}")
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
    write_geojson(tmp_path / "z.geojson", [(SQUARE, {"name": "A", **properties})])
    scenario, notes = zones_of(tmp_path, "z.geojson")
    low_m, high_m = scenario.airspace.no_fly[0].altitude_m or (0.0, 0.0)
    assert high_m == pytest.approx(expected[1])
    assert low_m == pytest.approx(expected[0]) if expected[0] is not None else low_m < -1e5
    assert len(notes) == 1


def test_limits_that_are_not_read_are_said(tmp_path: Path) -> None:
    """A property that looks like a limit or a time, under a name that is not known."""
    write_geojson(
        tmp_path / "z.geojson",
        [(SQUARE, {"name": "X", "upper_limit": 500}), (SQUARE, {"name": "Y", "limitedApplicability": [1]})],
    )
    scenario, notes = zones_of(tmp_path, "z.geojson")
    assert all(zone.altitude_m is None for zone in scenario.airspace.no_fly)
    assert 'z.geojson: "X" counts at all altitudes; its upper_limit = 500 is not read' in notes
    assert any('"Y" counts at all times; its limitedApplicability' in note for note in notes)


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
    expected = in_metres(SQUARE)
    assert kept_out(scenario).symmetric_difference(expected).area < 1e-6 * expected.area
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
    write_geojson(tmp_path / "z.geojson", [(parts if split else ring, {"name": "A"})])
    scenario, _ = zones_of(tmp_path, "z.geojson", here)
    expected = in_metres(crossing, here)
    assert kept_out(scenario).symmetric_difference(expected).area < 1e-6 * expected.area
    assert (
        load(scene(tmp_path, f"altitude_m = [10.0, 120.0]\nno_fly = {_as_toml(scenario)}", here)) == scenario
    )


def _as_toml(scenario: Scenario) -> str:
    zones = scenario.to_dict()["airspace"]["no_fly"]
    keys = ("name", "polygon_lat_lon_deg")
    tables = (", ".join(f"{key} = {json.dumps(zone[key])}" for key in keys) for zone in zones)
    return f"[{', '.join(f'{{{table}}}' for table in tables)}]"


def test_doubled_corners_and_spikes_are_no_faults(tmp_path: Path) -> None:
    """Corners under a centimetre apart are one, a spike has no area; a crossing is refused by name."""
    corners = [(14.502, 50.002), (14.502, 50.002), (14.504, 50.002), (14.5045, 50.0015), (14.504, 50.002)]
    corners += [(14.504, 50.004), (14.504 + 5e-8, 50.004), (14.502, 50.004)]
    write_geojson(tmp_path / "z.geojson", [(shapely.Polygon(corners), {"name": "A"})])
    scenario, _ = zones_of(tmp_path, "z.geojson")
    expected = in_metres(SQUARE)
    assert kept_out(scenario).symmetric_difference(expected).area < 1e-6 * expected.area
    bow = shapely.Polygon([(14.502, 50.002), (14.504, 50.004), (14.504, 50.002), (14.502, 50.004)])
    write_geojson(tmp_path / "z.geojson", [(bow, {"name": "bow"}), (bow, {"name": "tie"})])
    with pytest.raises(ScenarioError) as caught:
        zones_of(tmp_path, "z.geojson")
    assert [fault.path for fault in caught.value.faults] == [
        f"airspace.no_fly_from: z.geojson: features[{index}]" for index in (0, 1)
    ]
    write_kml(tmp_path / "z.kml", [(bow, {"name": "bow"}), (bow, {"name": "tie"})])
    with pytest.raises(ScenarioError, match='Placemark "tie"'):
        zones_of(tmp_path, "z.kml")


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
    with pytest.raises(ScenarioError, match=words):
        zones_of(tmp_path, "z.kml")


def test_ed_269_and_other_reference_systems_are_refused_by_name(tmp_path: Path) -> None:
    """ETRS89 is WGS 84 to less than a metre, and accepted."""
    (tmp_path / "z.json").write_text(
        '{"features": [{"identifier": "A", "geometry": [{}]}]}', encoding="utf-8"
    )
    with pytest.raises(ScenarioError, match="ED-269"):
        zones_of(tmp_path, "z.json")
    write_gdal(tmp_path / "a.gpkg", [(SQUARE, {"name": "A"})], "EPSG:3857")
    with pytest.raises(ScenarioError, match="EPSG:3857, must be WGS 84"):
        zones_of(tmp_path, "a.gpkg")
    write_gdal(tmp_path / "b.gpkg", [(SQUARE, {"name": "A"})], "EPSG:4258")
    assert len(zones_of(tmp_path, "b.gpkg")[0].airspace.no_fly) == 1
    write_gdal(tmp_path / "c.shp", [(SQUARE, {"name": "A"})])
    assert len(zones_of(tmp_path, "c.shp")[0].airspace.no_fly) == 1
    (tmp_path / "c.prj").unlink()
    with pytest.raises(ScenarioError, match="there is none, must be WGS 84"):
        zones_of(tmp_path, "c.shp")


def test_a_file_of_another_kind_reads_no_other_file(tmp_path: Path) -> None:
    """GDAL goes by the content; a description of a virtual file that leads elsewhere is refused by us."""
    text = '<OGRVRTDataSource><OGRVRTLayer name="z"><SrcDataSource>/etc/passwd</SrcDataSource></OGRVRTLayer>'
    for ending in (".kml", ".gpkg", ".shp", ".gpx", ".kmz", ".geojson"):
        (tmp_path / f"z{ending}").write_text(f"{text}</OGRVRTDataSource>", encoding="utf-8")
        with pytest.raises(ScenarioError):
            zones_of(tmp_path, f"z{ending}")


def test_layers_need_no_name_of_their_own(tmp_path: Path) -> None:
    """Of folders with one name, as of those without any, none is left out; a table of styles is no area."""
    for text in (
        kml(placemark(SQUARE, {"name": 1}), placemark(SQUARE, {"name": 2})),
        kml(placemark(SQUARE, {})),
    ):
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


@pytest.mark.parametrize("ending", [".geojson", ".kml", ".gpkg"])
def test_damaged_files_are_read_right_or_refused(ending: str, tmp_path: Path) -> None:
    """300 files with a piece cut out, doubled or overwritten: no traceback, and no zone is lost in silence.

    What is accepted has as many zones as its account says, and a zone that is as it was keeps out the same.
    """
    rng = random.Random(ending)
    source = np.random.default_rng(5)
    features: list[Feature] = [(star(source), {"name": f"zone {index}"}) for index in range(4)]
    WRITERS[ending](tmp_path / f"z{ending}", features)
    content = (tmp_path / f"z{ending}").read_bytes()
    refused = 0
    for _ in range(300):
        at, size = rng.randrange(len(content)), rng.choice([1, 1, 2, 5, 20, 200])
        middle = rng.choice(
            [b"", content[at : at + size] * 2, bytes(rng.randrange(32, 127) for _ in range(size))]
        )
        (tmp_path / f"z{ending}").write_bytes(content[:at] + middle + content[at + size :])
        try:
            scenario, notes = zones_of(tmp_path, f"z{ending}")
        except ScenarioError:
            refused += 1
            continue
        assert f": {len(scenario.airspace.no_fly)} of " in notes[0] or "polygons" in notes[0]
        assert kept_out(scenario).is_valid
    assert refused > 30


def test_a_country_loads_quickly(tmp_path: Path) -> None:
    """5,000 polygons, of which a few dozen are near."""
    import time

    rng = np.random.default_rng(8)
    centres = np.array(HERE) + rng.uniform([-6.0, -3.0], [6.0, 3.0], (5000, 2))
    features = [
        (shapely.Point(centre).buffer(0.01), {"name": f"zone {n}"}) for n, centre in enumerate(centres)
    ]
    write_geojson(tmp_path / "z.geojson", features)
    began = time.process_time()
    scenario, notes = zones_of(tmp_path, "z.geojson")
    took_s = time.process_time() - began
    assert "of 5000 in reach" in notes[0]
    assert 10 < len(scenario.airspace.no_fly) < 500
    assert took_s < 4.0


@pytest.mark.parametrize("lat", [0.0, -50.0, 68.0, 84.0])
def test_a_zone_may_cover_a_country(lat: float, tmp_path: Path) -> None:
    """What lies beyond the reach of the origin is cut off, however far north a degree is narrow."""
    country = shapely.box(HERE[0] - 40.0, lat - 5.0, HERE[0] + 40.0, lat + 5.0)
    write_geojson(tmp_path / "z.geojson", [(country, {"name": "country"})])
    scenario, notes = zones_of(tmp_path, "z.geojson", (HERE[0], lat))
    assert notes == ["z.geojson: zones: 1 of 1 in reach (1 polygon)"]
    assert kept_out(scenario).contains(shapely.box(-6e4, -6e4, 6e4, 6e4))


def test_the_edge_at_which_a_zone_is_cut_crosses_no_other(tmp_path: Path) -> None:
    """In degrees it is straight, in metres a parallel is curved: a bay may end just short of it."""
    x, y = HERE
    country = shapely.box(x - 2.0, y - 2.0, x + 2.0, y + 2.0)
    for tip in np.linspace(y - 0.556, y - 0.536, 21):
        bay = shapely.Polygon([(x, tip), (x + 0.01, y + 2.1), (x - 0.01, y + 2.1)])
        write_geojson(tmp_path / "z.geojson", [(country - bay, {})])
        scenario, _ = zones_of(tmp_path, "z.geojson")
        assert kept_out(scenario).area > 0.9 * 1.2e5**2


def test_a_file_without_a_zone_in_reach_is_no_fault(tmp_path: Path) -> None:
    """The account says that there is none."""
    write_geojson(tmp_path / "far.geojson", [(shapely.Point(0.0, 0.0).buffer(0.1), {})])
    write_geojson(tmp_path / "points.geojson", [(shapely.Point(HERE), {})])
    assert zones_of(tmp_path, "far.geojson")[1] == [
        "far.geojson: zones: 0 of 1 in reach; are latitude and longitude exchanged?"
    ]
    scenario, notes = zones_of(tmp_path, "points.geojson")
    assert notes == ["points.geojson: zones: 0 of 0 in reach; passed over: 1 point"]
    assert not scenario.airspace.no_fly


def test_no_node_lies_where_zones_do_not_count(tmp_path: Path) -> None:
    """Its zones would be left out as being out of reach, and the vehicle sent among them."""
    far = (HERE[0], HERE[1] + 0.7)
    write_geojson(tmp_path / "z.geojson", [(shapely.Point(far).buffer(0.01), {})])
    path = scene(tmp_path, 'altitude_m = [10.0, 120.0]\nno_fly_from = "z.geojson"')
    text = path.read_text()
    start = text.index("[[nodes]]")
    path.write_text(text[:start] + text[start:].replace(f"lat_deg = {HERE[1]}", f"lat_deg = {far[1]}"))
    with pytest.raises(
        ScenarioError, match=r"no_fly_from: its zones count up to 60 km .* node S1 is 78 km away"
    ):
        load(path)


def test_what_looks_like_a_radius_is_said(tmp_path: Path) -> None:
    """A point that is passed over may be a zone under another key."""
    write_geojson(tmp_path / "z.geojson", [(shapely.Point(HERE), {"Bufferzone": 150, "name": "station"})])
    assert zones_of(tmp_path, "z.geojson")[1] == [
        "z.geojson: zones: 0 of 0 in reach; passed over: 1 point",
        "z.geojson: of points Bufferzone is not read; a radius is radius_m",
    ]


def test_zones_with_too_many_corners_are_cut_once(tmp_path: Path) -> None:
    """One line says to what, and remarks are on the zones that are left."""
    near, far = (shapely.Point(HERE[0] + x, HERE[1]).buffer(0.01, quad_segs=1200) for x in (0.03, 0.5))
    write_geojson(
        tmp_path / "z.geojson", [(near, {"name": "near", "upper": 1}), (far, {"name": "far", "upper": 1})]
    )
    _, notes = zones_of(tmp_path, "z.geojson")
    assert notes == [
        "z.geojson: zones: 1 of 2 in reach (1 polygon)",
        "z.geojson: they are cut to x_m = [-30000.0, 30000.0] and y_m = [-30000.0, 30000.0], since all have "
        "too many corners",
        'z.geojson: "near" counts at all altitudes; its upper = 1 is not read',
    ]


def test_borders_with_small_crossings_keep_out_all_inside(tmp_path: Path) -> None:
    """Real sets have them: a loop at a corner, a ring that runs twice around, a hole around its border."""
    x, y = HERE
    looped = [
        (x, y),
        (x + 0.02, y),
        (x + 0.02, y + 0.02),
        (x + 0.0001, y + 0.02),
        (x - 0.0001, y + 0.0199),
        (x, y + 0.0201),
    ]
    square = shapely.box(x + 0.03, y, x + 0.06, y + 0.03)
    swapped = shapely.Polygon(square.buffer(-0.01).exterior, [square.exterior])
    corners = [(x - 0.01, y), (x - 0.01, y - 0.01), (x, y - 0.01), (x, y - 0.005)]
    twice = shapely.Polygon(corners * 2)
    features: list[Feature] = [(shapely.Polygon(looped), {"name": "loop"}), (swapped, {}), (twice, {})]
    write_geojson(tmp_path / "z.geojson", features)
    scenario, notes = zones_of(tmp_path, "z.geojson")
    assert notes == [
        "z.geojson: zones: 3 of 3 in reach (4 polygons); borders that cross, all inside counts: 3"
    ]
    rings = shapely.node(shapely.LineString([*looped, looped[0]]))
    assert (
        not in_metres(shapely.union_all([*shapely.get_parts(shapely.polygonize([rings])), square]))
        .difference(kept_out(scenario).buffer(0.3))
        .area
    )
    with pytest.raises(ScenarioError, match="its border crosses itself"):
        load(scene(tmp_path, 'altitude_m = [10.0, 120.0]\ngeofence_from = "z.geojson"'))
    bow = shapely.Polygon([(x, y), (x + 0.01, y + 0.01), (x + 0.01, y), (x, y + 0.01)])
    write_geojson(tmp_path / "bow.geojson", [(bow, {})])
    with pytest.raises(ScenarioError, match="its border crosses itself"):
        zones_of(tmp_path, "bow.geojson")


def test_shapes_of_one_place_are_walls(tmp_path: Path) -> None:
    """As the track of a receiver that stands still; a hole of one place takes nothing away."""
    square = shapely.Point(HERE).buffer(0.01, quad_segs=1)
    holed = shapely.Polygon(square.exterior, [[HERE] * 4])
    features: list[Feature] = [
        (shapely.LineString([HERE] * 4), {}),
        (shapely.Polygon([HERE] * 4), {}),
        (holed, {}),
    ]
    write_geojson(tmp_path / "z.geojson", features)
    scenario, notes = zones_of(tmp_path, "z.geojson")
    assert notes == ["z.geojson: zones: 1 of 1 in reach (1 polygon); passed over: 2 walls"]
    assert kept_out(scenario).area == pytest.approx(in_metres(square).area, rel=1e-6)


def test_kmz_that_is_damaged_or_holds_two_documents_is_refused(tmp_path: Path) -> None:
    """The reason is the archive's own."""
    text = kml(placemark(shapely.Point(HERE).buffer(0.01), {}))
    for names in (["doc.kml"], ["doc.kml", "more.kml"]):
        with zipfile.ZipFile(tmp_path / "z.kmz", "w", zipfile.ZIP_DEFLATED) as archive:
            for name in names:
                archive.writestr(name, text)
        if len(names) == 1:
            content = (tmp_path / "z.kmz").read_bytes()
            start = 30 + len("doc.kml")  # of the packed text
            (tmp_path / "z.kmz").write_bytes(content[:start] + b"\xff" * 9 + content[start + 9 :])
        words = "z.kmz: this is not KMZ: Error -3" if len(names) == 1 else "z.kmz: it has 2 KML files"
        with pytest.raises(ScenarioError, match=words):
            zones_of(tmp_path, "z.kmz")


def test_an_old_geopackage_keeps_its_zones(tmp_path: Path) -> None:
    """One without the mark of a GeoPackage is one by its ending."""
    zone = shapely.Point(HERE).buffer(0.01)
    write_gdal(tmp_path / "z.gpkg", [(zone, {"name": "old"})])
    content = (tmp_path / "z.gpkg").read_bytes()
    (tmp_path / "z.gpkg").write_bytes(content[:68] + bytes(4) + content[72:])
    scenario, _ = zones_of(tmp_path, "z.gpkg")
    assert [zone.name for zone in scenario.airspace.no_fly] == ["old"]


def test_styles_and_measures_are_no_faults(tmp_path: Path) -> None:
    """Neither changes a place."""
    zone = shapely.Point(HERE).buffer(0.01)
    (tmp_path / "z.kml").write_text(
        kml("<Style><LineStyle><width>2</width></LineStyle></Style>", placemark(zone, {}))
    )
    measured = shapely.from_wkt(
        zone.wkt.replace("POLYGON", "POLYGON M").replace(",", " 7,").replace("))", " 7))")
    )
    shapes = np.array([shapely.to_wkb(measured, flavor="iso")], object)
    pyogrio.raw.write(
        tmp_path / "z.shp",
        shapes,
        [np.array(["a"], object)],
        ["name"],
        geometry_type="Measured Polygon",
        crs="EPSG:4326",
    )
    for file in ("z.kml", "z.shp"):
        assert len(zones_of(tmp_path, file)[0].airspace.no_fly) == 1


def test_a_point_without_a_name_is_clamped_to_the_ground_too(tmp_path: Path) -> None:
    """Its height of 0 is none."""
    point = f"<Placemark><Point><coordinates>{HERE[0]},{HERE[1]},0</coordinates></Point></Placemark>"
    (tmp_path / "n.kml").write_text(kml(point))
    text = SCENE.format(lat=HERE[1], lon=HERE[0], airspace="altitude_m = [10.0, 120.0]").partition(
        "[[nodes]]"
    )[0]
    (tmp_path / "scene.toml").write_text('nodes_from = "n.kml"\n' + text)
    with pytest.raises(
        ScenarioError, match=r"n.kml: Placemark\[0\].geometry.coordinates: there is no altitude"
    ):
        load(tmp_path / "scene.toml")
