"""Altitudes of areas: read, or named; what is safe for a zone is not for a fence."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import Any

import pytest
import shapely
from geo_files import kml, kml_of, placemark, scene, write_geojson, zones, zones_of

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario, load

SQUARE = shapely.box(14.498, 49.999, 14.502, 50.001)
WORDS = ["altitude", "alt", "height", "ceiling", "floor", "elevation", "agl", "amsl"]
ENDS = ["max", "min", "upper", "Lower", "MAX"]
KEYS = [
    *(f"{end}{word.capitalize()}" for end, word in product(ENDS, WORDS)),
    *(f"{end}_{word}" for end, word in product(ENDS, WORDS)),
    *(f"{word}{unit}" for word, unit in product(("altitude", "height", "top", "ceiling"), ("", "_ft", "M"))),
    *(
        "maxalt",
        "UPPER_VAL",
        "upperLimit",
        "CEILING",
        "z",
        "zmax",
        "flightLevel",
        "verticalLimits",
        "roof",
        "base",
    ),
]


def fence_of(folder: Path, properties: dict[str, Any], shape: Any = SQUARE) -> tuple[Scenario, list[str]]:
    """Return the scenario with a fence, and the notes of loading it."""
    write_geojson(folder / "f.geojson", [(shape, properties)])
    notes: list[str] = []
    path = scene(folder, 'altitude_m = [10.0, 120.0]\ngeofence_from = "f.geojson"')
    return load(path, on_note=notes.append), notes


def test_a_key_that_looks_like_an_altitude_is_named_in_a_zone_and_refused_in_a_fence(tmp_path: Path) -> None:
    """A zone counts at all altitudes then, which is safe; a fence would allow what its file does not."""
    features = [(SQUARE, {"name": f"{index}", key: 40}) for index, key in enumerate(KEYS)]
    scenario, notes = zones(tmp_path, features)
    assert all(zone.altitude_m is None for zone in scenario.airspace.no_fly)
    for index, key in enumerate(KEYS):
        assert f'z.geojson: "{index}" counts at all altitudes; not read: {key}' in notes
        with pytest.raises(ScenarioError, match=f"is a fence and may bound the altitude .*: {key};"):
            fence_of(tmp_path, {key: 40})


@pytest.mark.parametrize(
    "properties",
    [
        {"maxAltitude": "40 m"},
        {"layer": {"upperLimit": 40}},
        {"limits": {"top": {"value": 40}}},
        {"description": "Max. 40 m AGL"},
        {"note": "Hauteur maximale de 50 m"},
        {"name": "D12 GND-FL95"},
        {"layer": {"lower": 0, "upper": 100, "uom": "m"}, "maxHeight": 40},
    ],
)
def test_a_fence_whose_altitude_is_stated_in_another_way_is_refused(
    properties: dict[str, Any], tmp_path: Path
) -> None:
    """In texts and in tables; with what is ours beside it, that alone counts, and the rest is named."""
    with pytest.raises(ScenarioError, match="write altitude_m"):
        fence_of(tmp_path, properties)
    scenario, notes = fence_of(tmp_path, {"altitude_m": [0, 35], **properties})
    assert scenario.airspace.altitude_m == (10.0, 35.0)
    assert any("counts at altitude_m; not read:" in note for note in notes)


@pytest.mark.parametrize(
    "properties",
    [{}, {"alt_name": "B2"}, {"ceiling": "UNL"}, {"speed_limit": 9}, {"highway": 1}, {"limitedUse": 1}],
)
def test_a_fence_without_an_altitude_is_one_at_all(properties: dict[str, Any], tmp_path: Path) -> None:
    """What states no number bounds nothing."""
    assert fence_of(tmp_path, properties)[0].airspace.altitude_m == (10.0, 120.0)


def test_heights_of_corners_are_named_in_a_zone_and_refused_in_a_fence(tmp_path: Path) -> None:
    """In GeoJSON and others nothing says what they are; zeros are none."""
    raised, flat = (shapely.force_3d(SQUARE, height) for height in (40.0, 0.0))
    _, notes = zones(tmp_path, [(raised, {}), (flat, {})])
    assert notes[1:] == ['z.geojson: "features[0]" counts at all altitudes; not read: heights of its corners']
    with pytest.raises(ScenarioError, match="heights of its corners"):
        fence_of(tmp_path, {}, raised)
    assert fence_of(tmp_path, {}, flat)[0].airspace.altitude_m == (10.0, 120.0)


def limits(low: float, high: float, unit: str = "FT", datum: str = "MSL") -> dict[str, Any]:
    """Return the limits of an airspace as openAIP has them."""
    values = zip(("lowerLimit", "upperLimit"), (low, high), strict=True)
    return {key: {"value": value, "unit": unit, "referenceDatum": datum} for key, value in values}


@pytest.mark.parametrize("datum", ["FL", "STD"])
def test_the_weather_widens_a_zone_and_narrows_a_fence(datum: str, tmp_path: Path) -> None:
    """A flight level may be 600 m off: a zone forbids what it may reach, a fence allows what it must."""
    stated = limits(20, 60, "FL", "STD") if datum == "FL" else limits(2000, 6000, "FT", "STD")
    low_m, high_m = 609.6, 1828.8
    zone, _ = zones(tmp_path, [(SQUARE, stated)])
    assert zone.airspace.no_fly[0].altitude_m == pytest.approx((low_m - 700.0, high_m + 500.0))  # sea: -100 m
    write_geojson(tmp_path / "f.geojson", [(SQUARE, stated)])
    notes: list[str] = []
    path = scene(tmp_path, 'altitude_m = [10.0, 9000.0]\ngeofence_from = "f.geojson"')
    assert load(path, on_note=notes.append).airspace.altitude_m == pytest.approx(
        (low_m + 500.0, high_m - 700.0)
    )
    assert any("narrowed, being a fence, by 600 m for the weather" in note for note in notes)
    write_geojson(tmp_path / "f.geojson", [(SQUARE, limits(0, 10, "FL", "STD"))])
    with pytest.raises(ScenarioError, match="600 m for the weather"):
        load(path)


def test_every_range_of_a_fence_bounds_the_airspace(tmp_path: Path) -> None:
    """The least of them counts, whatever their order."""
    ranges = {"altitude_m": [20, 80], "altitude_msl_m": [150, 160]}  # the sea is 100 m below
    for properties in (ranges, dict(reversed(ranges.items()))):
        assert fence_of(tmp_path, properties)[0].airspace.altitude_m == pytest.approx((50.0, 60.0))


RAISED = shapely.force_3d(SQUARE, 30.0)
FAR = shapely.force_3d(shapely.box(14.52, 50.01, 14.53, 50.02), 60.0)
MODE = "<altitudeMode>relativeToGround</altitudeMode>"


def of_kml(folder: Path, inner: str) -> list[tuple[float, float] | None]:
    """Return the altitudes of the zones of a placemark."""
    (folder / "z.kml").write_text(kml(f"<Placemark><name>p</name>{inner}</Placemark>"), encoding="utf-8")
    return [zone.altitude_m for zone in zones_of(folder, "z.kml")[0].airspace.no_fly]


def test_each_member_of_kml_has_its_own_altitudes(tmp_path: Path) -> None:
    """An area without any is not bounded by another's height, nor is a sheet by another sheet's."""
    plain, extruded = kml_of(SQUARE), kml_of(FAR, f"<extrude>1</extrude>{MODE}")
    for parts in (plain + extruded, extruded + plain):
        found = of_kml(tmp_path, f"<MultiGeometry>{parts}</MultiGeometry>")
        assert sorted(found, key=str) == [(-1e6, 60.0), None]
    sheets = kml_of(RAISED, MODE) + kml_of(FAR, MODE)
    assert of_kml(tmp_path, f"<MultiGeometry>{sheets}</MultiGeometry>") == [None, None]
    floor, roof = (kml_of(shapely.force_3d(SQUARE, height), MODE) for height in (20.0, 50.0))
    solid = f"<MultiGeometry>{floor}{roof}{kml_of(FAR, MODE)}</MultiGeometry>"
    assert of_kml(tmp_path, solid) == [(20.0, 50.0), None]


@pytest.mark.parametrize(
    ("mode", "extrude", "height_m", "expected"),
    [
        ("relativeToGround", 1, 40.0, (-1e6, 40.0)),
        ("absolute", 1, 140.0, (-1000100.0, 40.0)),
        ("relativeToGround", 0, 40.0, None),
        ("absolute", 0, 101.0, None),
        ("absolute", 1, 99.0, None),
        ("relativeToGround", 1, 0.0, None),
        ("clampToGround", 1, 40.0, None),
        ("clampToGround", 0, 40.0, None),
    ],
)
def test_roof_and_floor_are_those_of_solids(
    mode: str, extrude: int, height_m: float, expected: Any, tmp_path: Path
) -> None:
    """A face by itself may follow the terrain: its area counts at all altitudes, as one on the ground."""
    corners = [(x, y, height_m + 0.9 * (x > 14.5) * bool(height_m)) for x, y in SQUARE.exterior.coords]
    sloped = shapely.Polygon(corners)
    more = f"<extrude>{extrude}</extrude><altitudeMode>{mode}</altitudeMode>"
    (found,) = of_kml(tmp_path, kml_of(sloped, more))
    assert (found is None) == (expected is None)
    assert found is None or found == pytest.approx(expected, abs=0.91)


def test_a_mode_that_is_not_read_is_named(tmp_path: Path) -> None:
    """Heights over the sea's floor, or under a word that is none of KML's."""
    for mode in ("relativeToSeaFloor", "absolut"):
        more = f"<extrude>1</extrude><altitudeMode>{mode}</altitudeMode>"
        (tmp_path / "z.kml").write_text(kml(placemark(RAISED, {"name": "p"}, more)), encoding="utf-8")
        scenario, notes = zones_of(tmp_path, "z.kml")
        assert scenario.airspace.no_fly[0].altitude_m is None
        assert notes[1:] == [f'z.kml: "p" counts at all altitudes; not read: heights of its corners ({mode})']


def test_a_fence_of_kml_ends_at_its_lowest_roof(tmp_path: Path) -> None:
    """Under a roof that slopes a zone reaches up to its highest corner; as a solid a fence of it is none."""
    corners = list(SQUARE.exterior.coords)
    roof = shapely.Polygon([(x, y, 30.0 if x < 14.5 else 60.0) for x, y in corners])
    floor = shapely.force_3d(SQUARE, 20.0)

    def load_fence(*faces: Any, more: str = MODE) -> tuple[float, float]:
        text = "".join(kml_of(face, more) for face in faces)
        mark = f"<Placemark><MultiGeometry>{text}</MultiGeometry></Placemark>"
        (tmp_path / "f.kml").write_text(kml(mark), encoding="utf-8")
        return load(scene(tmp_path, 'altitude_m = [10, 120]\ngeofence_from = "f.kml"')).airspace.altitude_m

    assert load_fence(roof, more=f"<extrude>1</extrude>{MODE}") == (10.0, 30.0)
    assert of_kml(tmp_path, kml_of(roof, f"<extrude>1</extrude>{MODE}")) == [(-1e6, 60.0)]
    assert load_fence(floor, shapely.force_3d(SQUARE, 60.0)) == (20.0, 60.0)
    with pytest.raises(ScenarioError, match="heights of its corners"):
        load_fence(floor, roof)
    solid = f"<MultiGeometry>{kml_of(floor, MODE)}{kml_of(roof, MODE)}</MultiGeometry>"
    assert of_kml(tmp_path, solid) == [(20.0, 60.0)]
