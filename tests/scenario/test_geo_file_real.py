"""Geographic files as they are found: damaged, as large as a country, with small faults."""

from __future__ import annotations

import json
import random
import time
import zipfile
from pathlib import Path

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
    kept_out,
    kml,
    kml_of,
    placemark,
    require_refusal,
    scene,
    star,
    write_gdal,
    write_geojson,
    zones,
    zones_of,
)
from shapely.geometry import mapping

from nullpose.errors import ScenarioError
from nullpose.scenario import load
from nullpose.scenario.loading import files_of
from scenes import require_fault


@pytest.mark.parametrize("count", [40, pytest.param(150, marks=pytest.mark.slow)])
@pytest.mark.parametrize("ending", [".geojson", ".kml", ".gpkg"])
def test_damaged_files_are_read_right_or_refused(ending: str, count: int, tmp_path: Path) -> None:
    """Files with a piece cut out, doubled or overwritten: no traceback, and no zone is lost in silence.

    Of a file that is accepted, a zone whose coordinates are as they were keeps out all that it did.
    """
    rng = random.Random(ending)
    source = np.random.default_rng(5)
    features: list[Feature] = [(star(source), {"name": f"zone {index}"}) for index in range(4)]
    WRITERS[ending](tmp_path / f"z{ending}", features)
    content = (tmp_path / f"z{ending}").read_bytes()
    written = {
        ".geojson": lambda shape: json.dumps(mapping(shape)["coordinates"]).encode(),
        ".kml": lambda shape: kml_of(shape).encode(),
        ".gpkg": shapely.to_wkb,
    }[ending]
    coordinates = [written(shape) for shape, _ in features]
    assert all(each in content for each in coordinates)
    refused = compared = 0
    for _ in range(count):
        at, size = rng.randrange(len(content)), rng.choice([1, 1, 2, 5, 20, 200])
        piece = bytes(rng.randrange(32, 127) for _ in range(size))
        middle = rng.choice([b"", content[at : at + size] * 2, piece])
        damaged = content[:at] + middle + content[at + size :]
        (tmp_path / f"z{ending}").write_bytes(damaged)
        try:
            scenario, notes = zones_of(tmp_path, f"z{ending}")
        except ScenarioError:
            refused += 1
            continue
        assert " in reach" in notes[0]
        for (shape, _), whole in zip(features, coordinates, strict=True):
            if whole in damaged:
                area = in_metres(filled(shape))
                assert (area - kept_out(scenario)).area <= 1e-6 * area.area
                compared += 1
    assert refused > 0.1 * count
    assert compared > 0.3 * count


def test_a_country_loads_quickly(tmp_path: Path) -> None:
    """2,000 polygons, of which a few dozen are near."""
    rng = np.random.default_rng(8)
    centres = np.array(HERE) + rng.uniform([-6.0, -3.0], [6.0, 3.0], (2000, 2))
    areas = shapely.buffer(shapely.points(centres), 0.01)
    write_geojson(tmp_path / "z.geojson", [(area, {"name": f"zone {n}"}) for n, area in enumerate(areas)])
    began = time.process_time()
    scenario, notes = zones_of(tmp_path, "z.geojson")
    took_s = time.process_time() - began
    assert "of 2000 in reach" in notes[0]
    assert 4 < len(scenario.airspace.no_fly) < 500
    assert took_s < 30.0


@pytest.mark.parametrize("lat", [0.0, -50.0, 68.0, 84.0])
def test_a_zone_may_cover_a_country(lat: float, tmp_path: Path) -> None:
    """What lies beyond the reach of the origin is cut off, however far north a degree is narrow."""
    country = shapely.box(HERE[0] - 40.0, lat - 5.0, HERE[0] + 40.0, lat + 5.0)
    scenario, notes = zones(tmp_path, [(country, {"name": "country"})], here=(HERE[0], lat))
    assert notes == ["z.geojson: zones: 1 of 1 in reach (1 polygon)"]
    assert kept_out(scenario).contains(shapely.box(-6e4, -6e4, 6e4, 6e4))


def test_the_edge_at_which_a_zone_is_cut_crosses_no_other(tmp_path: Path) -> None:
    """In degrees it is straight, in metres a parallel is curved: a bay may end just short of it."""
    x, y = HERE
    country = shapely.box(x - 2.0, y - 2.0, x + 2.0, y + 2.0)
    for tip in np.linspace(y - 0.556, y - 0.536, 21):
        bay = shapely.Polygon([(x, tip), (x + 0.01, y + 2.1), (x - 0.01, y + 2.1)])
        scenario, _ = zones(tmp_path, [(country - bay, {})])
        assert kept_out(scenario).area > 0.9 * 1.2e5**2


SQUARE = shapely.Point(HERE).buffer(0.01, quad_segs=1)
WALLS = [(shapely.LineString([HERE] * 4), {}), (shapely.Polygon([HERE] * 4), {})]
HOLED = shapely.Polygon(SQUARE.exterior, [[HERE] * 4])  # a hole of one place takes nothing away


@pytest.mark.parametrize(
    ("features", "area", "notes"),
    [
        (
            [(shapely.Point(0, 0).buffer(0.1), {})],
            0,
            ["zones: 0 of 1 in reach; are latitude and longitude exchanged?"],
        ),
        (
            [*WALLS, (HOLED, {})],
            in_metres(SQUARE).area,
            ["zones: 1 of 1 in reach (1 polygon); passed over: 2 walls"],
        ),
    ],
    ids=["far", "walls"],
)
def test_the_account_says_what_became_of_each(
    features: list[Feature], area: float, notes: list[str], tmp_path: Path
) -> None:
    """No zone in reach is no fault; what has no area is a wall."""
    scenario, found = zones(tmp_path, features)
    assert found == [f"z.geojson: {note}" for note in notes]
    assert kept_out(scenario).area == pytest.approx(area, rel=1e-6)


def test_no_node_lies_where_zones_do_not_count(tmp_path: Path) -> None:
    """Its zones would be left out as being out of reach, and the vehicle sent among them."""
    far = (HERE[0], HERE[1] + 0.7)
    write_geojson(tmp_path / "z.geojson", [(shapely.Point(far).buffer(0.01), {})])
    path = scene(tmp_path, 'altitude_m = [10.0, 120.0]\nno_fly_from = "z.geojson"')
    text = path.read_text()
    start = text.index("[[nodes]]")
    path.write_text(text[:start] + text[start:].replace(f"lat_deg = {HERE[1]}", f"lat_deg = {far[1]}"))
    with pytest.raises(ScenarioError, match=r"its zones count up to 60 km .* node S1 is 78 km away"):
        load(path)


def test_zones_with_too_many_corners_are_cut_once(tmp_path: Path) -> None:
    """One line says to what, and remarks are on the zones that are left."""
    near, far = (shapely.Point(HERE[0] + x, HERE[1]).buffer(0.01, quad_segs=1200) for x in (0.03, 0.5))
    _, notes = zones(tmp_path, [(near, {"name": "near", "upper": 1}), (far, {"name": "far", "upper": 1})])
    assert notes == [
        "z.geojson: zones: 1 of 2 in reach (1 polygon)",
        "z.geojson: they are cut to x_m = [-30000.0, 30000.0] and y_m = [-30000.0, 30000.0], since all have "
        "too many corners",
        'z.geojson: "near" counts at all altitudes; not read: upper',
    ]


def test_zones_with_too_many_corners_are_cut_to_the_fence(tmp_path: Path) -> None:
    """A fence that is at fault is told, and stops nothing."""
    x, y = HERE
    rings = [shapely.Point(x + east, y).buffer(0.01, quad_segs=1200) for east in (0.0105, 0.2)]
    write_geojson(tmp_path / "z.geojson", [(ring, {}) for ring in rings])
    airspace = 'altitude_m = [10, 120]\nno_fly_from = "z.geojson"\ngeofence_lat_lon_deg = '
    fence = f"[[{y}, {x}], [{y}, {x + 1e-3}], [{y + 1e-3}, {x}]]"
    assert len(load(scene(tmp_path, airspace + fence)).airspace.no_fly) == 1
    with pytest.raises(ScenarioError, match="geofence_lat_lon_deg: got 3, must be a list"):
        load(scene(tmp_path, f"{airspace}3"))


def test_borders_with_small_crossings_keep_out_all_inside(tmp_path: Path) -> None:
    """Real sets have them: a loop at a corner, a ring that runs twice around, a hole around its border."""
    x, y = HERE
    looped = [(x, y), (x + 0.02, y), (x + 0.02, y + 0.02)]
    looped += [(x + 0.0001, y + 0.02), (x - 0.0001, y + 0.0199), (x, y + 0.0201)]
    square = shapely.box(x + 0.03, y, x + 0.06, y + 0.03)
    swapped = shapely.Polygon(square.buffer(-0.01).exterior, [square.exterior])
    corners = [(x - 0.01, y), (x - 0.01, y - 0.01), (x, y - 0.01), (x, y - 0.005)]
    twice = shapely.Polygon(corners * 2)
    features: list[Feature] = [(shapely.Polygon(looped), {"name": "loop"}), (swapped, {}), (twice, {})]
    scenario, notes = zones(tmp_path, features)
    assert notes == [
        "z.geojson: zones: 3 of 3 in reach (4 polygons); borders that cross, all inside counts: 3"
    ]
    rings = shapely.node(shapely.LineString([*looped, looped[0]]))
    inside = shapely.union_all([*shapely.get_parts(shapely.polygonize([rings])), square])
    assert not in_metres(inside).difference(kept_out(scenario).buffer(0.3)).area
    with pytest.raises(ScenarioError, match="its border crosses itself"):
        load(scene(tmp_path, 'altitude_m = [10.0, 120.0]\ngeofence_from = "z.geojson"'))
    bow = shapely.Polygon([(x, y), (x + 0.01, y + 0.01), (x + 0.01, y), (x, y + 0.01)])
    write_geojson(tmp_path / "bow.geojson", [(bow, {})])
    require_refusal(tmp_path, "bow.geojson", "its border crosses itself")


def test_kmz_that_is_damaged_or_holds_two_documents_is_refused(tmp_path: Path) -> None:
    """The reason is the archive's own."""
    text = kml(placemark(SQUARE, {}))
    for names in (["doc.kml"], ["doc.kml", "more.kml"]):
        with zipfile.ZipFile(tmp_path / f"{len(names)}.kmz", "w", zipfile.ZIP_DEFLATED) as archive:
            for name in names:
                archive.writestr(name, text)
    content, start = (tmp_path / "1.kmz").read_bytes(), 30 + len("doc.kml")  # of the packed text
    (tmp_path / "1.kmz").write_bytes(content[:start] + b"\xff" * 9 + content[start + 9 :])
    require_refusal(tmp_path, "1.kmz", "1.kmz: this is not KMZ: Error -3")
    require_refusal(tmp_path, "2.kmz", "2.kmz: it has 2 KML files")


def test_styles_measures_and_missing_marks_are_no_faults(tmp_path: Path) -> None:
    """None changes a place; what has lost the mark of a GeoPackage is one by its ending."""
    style = "<Style><LineStyle><width>2</width></LineStyle></Style>"
    (tmp_path / "z.kml").write_text(kml(style, placemark(SQUARE, {})))
    wkt = SQUARE.wkt.replace("POLYGON", "POLYGON M").replace(",", " 7,").replace("))", " 7))")
    shapes = np.array([shapely.to_wkb(shapely.from_wkt(wkt), flavor="iso")], object)
    columns, kind = [np.array(["a"], object)], "Measured Polygon"
    pyogrio.raw.write(tmp_path / "z.shp", shapes, columns, ["name"], geometry_type=kind, crs="EPSG:4326")
    write_gdal(tmp_path / "z.gpkg", [(SQUARE, {"name": "old"})])
    content = (tmp_path / "z.gpkg").read_bytes()
    (tmp_path / "z.gpkg").write_bytes(content[:68] + bytes(4) + content[72:])
    for file in ("z.kml", "z.shp", "z.gpkg"):
        assert len(zones_of(tmp_path, file)[0].airspace.no_fly) == 1


@pytest.mark.parametrize(("name", "shown"), [("", "[0]"), ("gauge", ' "gauge"')])
def test_an_altitude_is_never_guessed(name: str, shown: str, tmp_path: Path) -> None:
    """A KML point that is clamped to the ground states no altitude, and is refused with what would do."""
    (tmp_path / "n.kml").write_text(kml(placemark(shapely.Point(*HERE, 0.0), {"name": name} if name else {})))
    path = scene(tmp_path, "altitude_m = [10.0, 120.0]")
    path.write_text('nodes_from = "n.kml"\n' + path.read_text().partition("[[nodes]]")[0])
    require_fault(
        lambda: load(path),
        f"n.kml: Placemark{shown}.geometry.coordinates",
        "alt_m (ellipsoid), alt_msl_m (sea) or alt_agl_m (above the ground)",
    )


def test_zones_are_cut_to_the_airspace_with_its_changes(tmp_path: Path) -> None:
    """A change of x_m on loading counts before zones are left out for their corners: none is lost by it."""
    rng = np.random.default_rng(8)
    centres = np.array(HERE) + rng.uniform(-0.1, 0.1, (200, 2))
    write_geojson(tmp_path / "z.geojson", [(shapely.Point(centre).buffer(0.001), {}) for centre in centres])
    bounds = "x_m = [-100, 100]\ny_m = [-100, 100]"
    path = scene(tmp_path, f'altitude_m = [10, 120]\n{bounds}\nno_fly_from = "z.geojson"')
    changes, notes = ["airspace.x_m=[-2000, 2000]", "airspace.y_m = [-2000, 2000]"], list[str]()
    small = load(path, on_note=notes.append)
    large = load(path, overrides=changes, on_note=notes.append)
    assert len(large.airspace.no_fly) > len(small.airspace.no_fly) + 5
    assert large.airspace.x_m == (-2000.0, 2000.0)
    with pytest.raises(ScenarioError, match=r"override airspace\.foo"):
        load(path, overrides=["airspace.foo=3"])


def test_another_fence_takes_the_place_of_the_first(tmp_path: Path) -> None:
    """Inside the folder, with its own altitudes; the file is an input that no output replaces."""
    around = shapely.box(14.49, 49.99, 14.51, 50.01)
    write_geojson(tmp_path / "g.geojson", [(around, {"altitude_m": [0, 40]})])
    path = scene(tmp_path, "altitude_m = [10, 120]\ngeofence_m = [[0, 0], [500, 0], [0, 500]]")
    changes = ["airspace.geofence_from=g.geojson", "nodes[0].power_w=2"]
    found = load(path, overrides=changes)
    assert found.airspace.altitude_m == (10.0, 40.0)
    assert len(found.airspace.geofence_m or ()) == 4
    assert found.nodes[0].power_w == 2.0
    assert files_of(path, changes)["airspace.geofence_from"] == tmp_path / "g.geojson"
    with pytest.raises(ScenarioError, match="outside the folder"):
        load(path, overrides=["airspace.geofence_from=../g.geojson"])
