"""Writers of geographic files, and what they keep out by shapely, for the tests of the readers."""

from __future__ import annotations

import json
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


def require_refusal(folder: Path, file: str, words: str) -> None:
    """Check that zones of a file are refused in these words."""
    with pytest.raises(ScenarioError, match=words):
        zones_of(folder, file)


def require_kept_out(scenario: Scenario, expected: Any) -> None:
    """Check that the zones of a scenario cover these metres to a millionth of their area."""
    assert kept_out(scenario).symmetric_difference(expected).area <= 1e-6 * expected.area


def write_geojson(path: Path, features: list[Feature]) -> None:
    """Write features as GeoJSON."""
    members = [
        {"type": "Feature", "geometry": shape and mapping(shape), "properties": properties}
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


def zones(
    folder: Path, features: list[Feature], ending: str = ".geojson", here: tuple[float, float] = HERE
) -> tuple[Scenario, list[str]]:
    """Return the scenario with these zones, and the notes of loading them from a file."""
    WRITERS[ending](folder / f"z{ending}", features)
    return zones_of(folder, f"z{ending}", here)


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
