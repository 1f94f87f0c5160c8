"""Nodes in a file of their own: read from GeoJSON and CSV, and every fault at its place in that file."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nullpose.errors import Fault
from nullpose.scenario import Scenario, load
from nullpose.scenario.geodesy import enu_from_geodetic
from scenes import load_faults

SCENARIO = """\
nodes_from = "FILE"
[airspace]
altitude_m = [8.0, 30.0]
[receiver]
noise_w = 1e-3
reference_gain_db = 0.0
"""
ORIGIN = """\
[origin]
lat_deg = 50.0
lon_deg = 14.5
alt_m = 230.0
"""
PLACES = [[50.001, 14.502, 232.0], [50.002, 14.501, 231.0]]
GEODETIC = "name,lat_deg,lon_deg,alt_m,power_dbm\n"
LOCAL = "name,x_m,y_m,z_m,power_w\n"
CRS = {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}


def feature(coordinates: object = (14.502, 50.001, 232.0), **properties: Any) -> dict[str, Any]:
    """Returns a feature; a power is added unless one is given."""
    if not {"power_w", "power_dbm", "powr_w"} & properties.keys():
        properties["power_w"] = 1.0
    geometry = {"type": "Point", "coordinates": coordinates}
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def collection(*features: object, **others: Any) -> str:
    """Returns a GeoJSON text."""
    return json.dumps({"type": "FeatureCollection", "features": features} | others)


def written(folder: Path, file: str, content: str | None, scenario: str = SCENARIO + ORIGIN) -> Path:
    """Returns the path of a scenario file that names a file of nodes, with such a file beside it."""
    if content is not None:
        (folder / file).write_text(content, encoding="utf-8")
    path = folder / "scene.toml"
    path.write_text(scenario.replace("FILE", file), encoding="utf-8")
    return path


def faults_of(folder: Path, file: str, content: str | None, scenario: str = SCENARIO + ORIGIN) -> list[Fault]:
    """Returns the faults with which the scenario is refused."""
    return load_faults(written(folder, file, content, scenario))


def test_geojson(tmp_path: Path) -> None:
    """Points with properties are nodes; null properties are keys left out, and names come by place."""
    text = collection(
        feature([14.502, 50.001, 232.0], name="a", power_dbm=20.0, min_sinr_db=3.0),
        feature([14.501, 50.002], alt_m=231.0, power_w=2.0, weight=None),
        crs=CRS,
        name="a layer",
    )
    scenario = load(written(tmp_path, "nodes.geojson", text))
    np.testing.assert_array_equal(scenario.node_positions_m, enu_from_geodetic(PLACES, [50.0, 14.5, 230.0]))
    assert scenario.node_names == ("a", "S2")
    assert scenario.node_powers_w.tolist() == pytest.approx([0.1, 2.0])
    assert scenario.nodes[0].min_sinr_db == 3.0
    assert scenario.nodes_from is None
    assert Scenario.from_dict(scenario.to_dict()) == scenario


@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_csv_by_latitude(mark: str, tmp_path: Path) -> None:
    """A line is a node; empty cells, empty lines and blanks about the commas are left out."""
    text = f'{mark}{GEODETIC}"a, b", 50.001 ,14.502,232,20\n,,,,\n\n,50.002,14.501,231,2e1\n'
    scenario = load(written(tmp_path, "nodes.csv", text))
    np.testing.assert_array_equal(scenario.node_positions_m, enu_from_geodetic(PLACES, [50.0, 14.5, 230.0]))
    assert scenario.node_names == ("a, b", "S2")


def test_the_same_nodes_whichever_the_file(tmp_path: Path) -> None:
    """GeoJSON, CSV and tables in the scenario file itself make equal scenarios."""
    tables, rows, features = "", GEODETIC.replace("dbm", "w"), []
    for name, (lat, lon, alt) in zip("ab", PLACES, strict=True):
        place = f'name = "{name}"\nlat_deg = {lat}\nlon_deg = {lon}\nalt_m = {alt}\n'
        tables += f"[[nodes]]\n{place}power_w = 1.0\n"
        rows += f"{name},{lat},{lon},{alt},1\n"
        features.append(feature([lon, lat, alt], name=name))
    plain = SCENARIO.replace('nodes_from = "FILE"\n', "") + ORIGIN + tables
    scenarios = [
        load(written(tmp_path, "none", None, plain)),
        load(written(tmp_path, "n.csv", rows)),
        load(written(tmp_path, "n.json", collection(*features))),
    ]
    assert scenarios[0] == scenarios[1] == scenarios[2]


GEOJSON_CASES = [
    ("[1]", "", "got a list of one value, must be a FeatureCollection"),
    ("{", ": line 1, column 2", "this is not JSON"),
    ('{"type": 1, "type": 2}', ": line 1, column 22", 'the key "type" is given twice'),
    ('{"features": [0, {"id": 1, "id": 2}]}', ": line 1, column 35", 'the key "id" is given twice'),
    ("[" * 100_000, "", "nested too deeply"),
    (f'{{"a": {"9" * 5000}}}', "", "too many digits"),
    ('{"type": "Sketch"}', ": type", 'got the text "Sketch", must be "FeatureCollection"'),
    (collection(), ": features", "got an empty list, must be a list of one feature or more"),
    (collection(feature(), crs={"name": "EPSG::3857"}), ": crs", "must be WGS 84"),
    (collection(feature() | {"geometry": None}), "", "it has no point, .* it has 1 feature without a place"),
]
FEATURE_CASES = [
    (3, "", 'must be an object with "type": "Feature"'),
    (feature() | {"properties": [1]}, ".properties", "must be an object"),
    ({"type": "Feature", "properties": {}}, ".geometry", "missing; a feature without a place states null"),
    (feature() | {"geometry": {"type": "Polygon"}}, ".geometry", 'got the text "Polygon"'),
    (feature([14.5, 50.0]), ".geometry.coordinates", "add it .* or as a property alt_m"),
    (feature([14.5]), ".geometry", "must be a geometry with .longitude, latitude"),
    (feature(alt_m=3.0), ".properties.alt_m", "remove this property"),
    (feature(lat_deg=3.0), ".properties.lat_deg", "remove this property"),
    (feature([14.5, 91.0, 1]), ".geometry", "latitude"),
    (feature([14.5, 50.0, 1e9]), ".geometry.coordinates[2]", "altitude"),
    (feature([14.5, 50.0], alt_m=float("nan")), ".properties.alt_m", "got NaN, must be an altitude"),
    (feature([50.0, 14.5, 230.0]), "", "are latitude and longitude exchanged"),
    (feature(power_w=-1.0), ".properties.power_w", "got -1.0"),
    (feature(powr_w=1.0), ".properties.powr_w", 'did you mean "power_w"'),
    (feature([14.501, 50.001, 1.0]), ".geometry", r"the place of n.geojson: features\[0\] already"),
]


@pytest.mark.parametrize(
    ("text", "path", "words"),
    [
        *GEOJSON_CASES,
        *(
            (collection(feature([14.501, 50.001, 1.0]), each), f": features[1]{path}", words)
            for each, path, words in FEATURE_CASES
        ),
    ],
)
def test_faults_of_geojson(text: str, path: str, words: str, tmp_path: Path) -> None:
    """Each fault is told once, with its place in the GeoJSON file."""
    (fault,) = faults_of(tmp_path, "n.geojson", text)
    assert fault.path == f"n.geojson{path}"
    assert re.search(words, fault.message)


CSV_CASES = [
    ("", ": line 1", "the file is empty, must be a header line"),
    (LOCAL, "", "there is no line below the header"),
    (LOCAL + '"a,1,2,3,4\n', "", "this is not CSV"),
    (LOCAL.replace(",", ";") + "a;1;2;3;4\n", ": line 1", "columns separated by commas"),
    (LOCAL.replace("power_w", "pwr_w") + "a,1,2,3,4\n", ": line 1", 'did you mean "power_w"?'),
    (LOCAL.replace("name", "power_w") + "1,1,2,3,4\n", ": line 1", 'the column "power_w" is there twice'),
    (LOCAL.replace("x_m,", "") + "a,2,3,4\n", ": line 1", "y_m and z_m given without x_m"),
    ("name,power_w\na,1\n", ": line 1", "neither x_m and y_m and z_m nor lat_deg"),
    (LOCAL + "a,1,2,3,4\nb,1,2,3\n", ": line 3", "got 4 values, must be 5"),
    (LOCAL + "a,1,,3,4\n", ": line 2, column y_m", "got an empty text, must be a number"),
    (LOCAL + "a,1,2,3,x\n", ": line 2, column power_w", 'got the text "x"'),
    (LOCAL + "\n\na,1,2,3,1_000\n", ": line 4, column power_w", 'got the text "1_000"'),
    (LOCAL + "a,1,2,3,\n", ": line 2", "needs power_w or power_dbm"),
    (LOCAL + "a,1,2,3,4\na,5,6,7,8\n", ": line 3, column name", "the name of n.csv: line 2 already"),
    (LOCAL + "a,1,2,3,4\nb,1,2,3,4\n", ": line 3", "the place of n.csv: line 2 already"),
    (GEODETIC + "a,50,14.5,,3\n", ": line 2, column alt_m", "got an empty text"),
    (GEODETIC + "a,14.5,50,230,3\n", ": line 2", "are latitude and longitude exchanged"),
]


@pytest.mark.parametrize(("text", "path", "words"), CSV_CASES)
def test_faults_of_csv(text: str, path: str, words: str, tmp_path: Path) -> None:
    """Each fault is told once, with its line and column."""
    (fault,) = faults_of(tmp_path, "n.csv", text)
    assert fault.path == f"n.csv{path}"
    assert words in fault.message


@pytest.mark.parametrize(
    ("file", "path", "words"),
    [
        ("nodse.csv", "nodes_from", "there is no such file; check the path"),
        ("zero", "zero", "the name must end in one of .geojson, .json, .kml, .kmz, .gpkg, .shp, .gpx, .csv"),
        (".", ".", "the name must end in one of"),
        ("x.csv/..", "x.csv/..", "the name must end in one of"),
        ("", "nodes_from", "got an empty text, must be the name of a file of nodes"),
        ("no/where.csv", "nodes_from", "nor a folder"),
    ],
)
def test_files_that_are_none(file: str, path: str, words: str, tmp_path: Path) -> None:
    """A file that cannot be read is one fault, and a device is told by its name before it is read."""
    (tmp_path / "zero").symlink_to("/dev/zero")
    (fault,) = faults_of(tmp_path, file, None)
    assert fault.path == path
    assert words in fault.message


def test_nodes_in_both_places(tmp_path: Path) -> None:
    """Nodes in the scenario file and in another are refused, and those that are there are judged."""
    table = "[[nodes]]\nposition_m = [0, 0, 0]\npower_w = -1.0\n"
    faults = faults_of(tmp_path, "n.csv", LOCAL + "a,1,2,3,4\n", SCENARIO + table)
    assert [fault.path for fault in faults] == ["nodes_from", "nodes[0].power_w"]
    assert "in place of its own nodes; remove it or them" in faults[0].message


def test_all_faults_of_both_files_at_once(tmp_path: Path) -> None:
    """What is wrong with the lines, with the file and with the scenario comes in one report."""
    text = GEODETIC + "a,50.001,14.5,230,nan\na,50.002,14.5,230,20\nc,1,2\nd,50.003,x,230,20\n"
    scenario = SCENARIO.replace("[8.0, 30.0]", "[30.0, 8.0]") + ORIGIN.replace("230.0", '"230"')
    faults = faults_of(tmp_path, "n.csv", text, scenario)
    assert [fault.path for fault in faults] == [
        "n.csv: line 4",
        "n.csv: line 2, column power_dbm",
        "n.csv: line 3, column name",
        "n.csv: line 5, column lon_deg",
        "airspace.altitude_m",
        "origin.alt_m",
    ]


def test_nodes_from_elsewhere(tmp_path: Path) -> None:
    """By an absolute path, by dots or through a link they are refused unseen, unless the caller allows it."""
    folder = tmp_path / "scene"
    (folder / "below").mkdir(parents=True)
    (tmp_path / "n.csv").write_text(LOCAL + "secret,1,2,3,4\n", encoding="utf-8")
    (folder / "link.csv").symlink_to(tmp_path / "n.csv")
    (folder / "linked").symlink_to(tmp_path)
    for file in (str(tmp_path / "n.csv"), "../n.csv", "link.csv", "linked/n.csv", "../none.csv"):
        (fault,) = faults_of(folder, file, None)
        assert fault.path == "nodes_from"
        assert "outside the folder of the file that names it; put it there, or allow this by" in fault.message
        assert "secret" not in fault.message
    assert load(written(folder, "../n.csv", None), allow_outside=True).node_names == ("secret",)
    (folder / "below" / "n.csv").write_text(LOCAL + "a,1,2,3,4\n", encoding="utf-8")
    for file in ("below/n.csv", str(folder / "below" / "n.csv"), "../scene/below/n.csv"):
        assert load(written(folder, file, None)).node_names == ("a",)


def test_too_many_nodes(tmp_path: Path) -> None:
    """Files of more nodes than are allowed are refused for that."""
    text = collection(*[feature()] * 10_001)
    for file, content in (("n.csv", LOCAL + "a,1,2,3,4\n" * 10_001), ("n.json", text)):
        fault = faults_of(tmp_path, file, content)[-1]
        assert str(fault) == "nodes: there are more than 10000 members, the most that are allowed"
