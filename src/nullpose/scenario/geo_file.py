"""Features of geographic files: GeoJSON, KML, KMZ, GeoPackage, shapefile and GPX.

GeoJSON is read here, since GDAL drops what ED-318 states inside a geometry; GDAL (pyogrio) reads the rest.
"""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from itertools import chain, count
from pathlib import Path
from typing import Any

import numpy as np
import shapely.geometry
from shapely.errors import ShapelyError
from shapely.geometry.base import BaseGeometry

from nullpose.files import PlainTable, parse_json
from nullpose.scenario.faults import EXCHANGED, call_each, raise_all, refusal, require
from nullpose.scenario.kml import kml_of_kmz, require_whole, root_of
from nullpose.scenario.toml_file import decoded
from nullpose.scenario.wording import described

ENDINGS = (".geojson", ".json", ".kml", ".kmz", ".gpkg", ".shp", ".gpx")
"""How the names of the files end."""
MOST_BYTES = 60_000_000
NAMES = ("name", "Name", "NAME", "title", "identifier", "designator")
"""The properties that may name a feature, the first first."""
_SIGNS = {".kmz": b"PK", ".gpkg": b"SQLite format 3\0", ".shp": b"\0\0\x27\x0a", ".kml": b"", ".gpx": b""}
_GEOMETRIES = ("Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon")
_WGS84 = ("CRS84", "CRS84h", "4326", "4979", "4258")  # as the names of reference systems end
# Of GDAL's warnings: rings are closed here; age, style and measures along lines change no place.
_NO_MATTER = ("Non closed ring", "bad application_id", "parsing kml Style", "Measured (M) geometry types")
_POINTS_OF_LINES = {"route_points", "track_points"}  # of GPX, which are in its lines too
_OF_DRAWING = {"id", "tessellate", "visibility", "drawOrder", "icon", "snippet"}  # GDAL's columns of KML


@dataclass(frozen=True, slots=True)
class Feature:
    """A feature as its file states it.

    Args:
        place: where it stands in the file, by index or by name.
        geometry: shapely's, x being longitudes and y latitudes in degrees; None without one.
        properties: by name, without those that are empty. What GeoJSON states in a geometry beside its
            coordinates (ED-318: layer, extent) is among them.
    """

    place: str
    geometry: BaseGeometry | None
    properties: PlainTable


def features_of(content: bytes, path: Path) -> list[Feature]:
    """Return the features of a file, one or more.

    Args:
        content: of the file.
        path: of the file, whose ending is one of ``ENDINGS``; a shapefile or a GeoPackage has further files
            beside it.

    Raises:
        ScenarioError: it cannot be read as a whole, or is not in latitude and longitude.
    """
    ending = path.suffix.lower()
    if ending in (".geojson", ".json"):
        return _features_of_json(decoded(content))
    require(
        content.startswith(_SIGNS[ending]),
        "",
        f"it does not begin as a {ending} file does; is it of another kind?",
    )
    is_kml = ending in (".kml", ".kmz")
    if ending == ".kmz":
        content = kml_of_kmz(content, MOST_BYTES)
    document = root_of(content, "kml" if is_kml else "gpx") if is_kml or ending == ".gpx" else None
    # GDAL knows an old GeoPackage by its ending, and reads the journal beside it
    features = list(_features_of_gdal(path if document is None else content, is_kml))
    if is_kml and document is not None:
        corners = shapely.get_num_coordinates([feature.geometry for feature in features]).sum()
        require_whole(document, len(features), corners)
    require(features, "", "there is no feature in it, must be one or more")
    return features


def _features_of_json(text: str) -> list[Feature]:
    data = parse_json(text)
    require(isinstance(data, dict), "", f"got {described(data)}, must be a FeatureCollection")
    kind, members = data.get("type"), data.get("features")
    is_ed_269 = isinstance(members, list) and any(isinstance(_of(each, "geometry"), list) for each in members)
    require(not is_ed_269, "", "this is ED-269 JSON, which is not read; convert it to ED-318, a GeoJSON")
    if kind in (*_GEOMETRIES, "GeometryCollection", "Feature"):
        kind, members = (
            "FeatureCollection",
            [data if kind == "Feature" else {"type": "Feature", "geometry": data}],
        )
    require(
        kind == "FeatureCollection",
        "type",
        f'got {described(kind)}, must be "FeatureCollection", "Feature" or a geometry',
    )
    require(
        isinstance(members, list) and members,
        "features",
        f"got {described(members)}, must be a list of one feature or more",
    )
    if "crs" in data:
        _require_wgs84(json.dumps(data["crs"]).rstrip('}"]'))
    features, faults = call_each(_features_of_member, enumerate(members))
    raise_all(faults)
    return list(chain.from_iterable(features))


def _features_of_member(numbered: tuple[int, Any]) -> list[Feature]:
    index, member = numbered
    place = f"features[{index}]"
    geometry, properties = _of(member, "geometry"), _of(member, "properties")
    require(
        _of(member, "type") == "Feature",
        place,
        f'got {described(_of(member, "type"))}, must be an object with "type": "Feature"',
    )
    require("geometry" in member, f"{place}.geometry", "missing; a feature without a place states null")
    require(
        isinstance(properties, dict | None),
        f"{place}.properties",
        f"got {described(properties)}, must be an object",
    )
    parts = _of(geometry, "geometries")
    if isinstance(parts, list) and any({"layer", "extent"} & set(each) for each in parts if each):
        shapes = {f"{place}.geometry.geometries[{index}]": each for index, each in enumerate(parts)}
    else:
        shapes = {f"{place}.geometry": geometry}
    features = []
    for where, shape in shapes.items():
        geometric = ("type", "coordinates", "geometries")
        beside = {key: shape[key] for key in shape if key not in geometric} if isinstance(shape, dict) else {}
        found = {key: value for key, value in {**(properties or {}), **beside}.items() if value is not None}
        features.append(
            Feature(where.removesuffix(".geometry"), _shape(shapely.geometry.shape, shape, where), found)
        )
    return features


def _of(value: object, key: str) -> Any:
    return value.get(key) if isinstance(value, dict) else None


def _shape(read: Callable[[Any], BaseGeometry], geometry: object, place: str) -> BaseGeometry | None:
    """Read a geometry, whose coordinates are longitudes, which may go on beyond 180, and latitudes."""
    if geometry is None:
        return None
    try:
        shape = read(geometry)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError, ShapelyError) as error:
        got = described(geometry["type"] if isinstance(geometry, dict) and "type" in geometry else geometry)
        raise refusal(
            place, f"got {got}, must be a geometry with [longitude, latitude] in degrees ({error})"
        ) from None
    places = shapely.get_coordinates(shape)
    wrong = ~(np.abs(places) <= [360.0, 90.0]).all(axis=1)  # NaN too
    for lon, lat in places[wrong][:1]:
        raise refusal(place, f"got longitude {lon:g} and latitude {lat:g}, must be degrees; {EXCHANGED}")
    return shape


def _layers_of_gdal(source: Path | bytes) -> list[tuple[str, Any]]:
    """Read the layers of a file, by name; refuse it where GDAL warns of what may change a place."""
    try:
        import pyogrio
    except ImportError:
        raise refusal("", "all but GeoJSON and CSV needs pyogrio; pip install 'nullpose[gis]'") from None
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            names = [str(name) for name, _ in pyogrio.list_layers(source)]
            kept = [index for index, name in enumerate(names) if name not in _POINTS_OF_LINES]
            layers = [(names[index], pyogrio.raw.read(source, layer=index)) for index in kept]
        except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError, RuntimeError) as error:
            raise refusal("", f"GDAL cannot read it: {str(error)[:200]}") from None
    for words in (str(warning.message) for warning in said):
        require(
            any(harmless in words for harmless in _NO_MATTER),
            "",
            f"GDAL reads it in part only: {words[:200]}; export it anew",
        )
    return layers


def _features_of_gdal(source: Path | bytes, is_kml: bool) -> Iterator[Feature]:
    numbers, left_out = count(), _OF_DRAWING if is_kml else set()
    read_wkb = partial(shapely.from_wkb, on_invalid="fix")
    for layer, (meta, _, shapes, columns) in _layers_of_gdal(source):
        if shapes is None:  # a table, such as of styles
            shapes = [None] * len(columns[0]) if columns else []
        else:
            _require_wgs84(str(meta["crs"]))
        for index, shape in enumerate(shapes):
            found = {
                key: value
                for key, column in zip(meta["fields"], columns, strict=True)
                if key not in left_out and (value := _cell(column[index], key in NAMES)) not in (None, "")
            }
            name, number = found.get("Name", found.get("name")), next(numbers)
            label = f"[{number}]" if name is None else f' "{name}"'
            place = f"{'Placemark' if is_kml else layer}{label}"
            yield Feature(place, _shape(read_wkb, shape, place), found)


def _cell(value: object, is_name: bool) -> object:
    """Return a value of a table as plain data; numbers and lists in texts as such, but in names; or None."""
    if isinstance(value, np.generic):
        value = value.item() if value.dtype.kind != "M" else None if np.isnat(value) else str(value)
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, str) and not is_name:
        with suppress(ValueError, RecursionError):
            return json.loads(value)
    return None if value is None or value != value else value


def _require_wgs84(system: str) -> None:
    if not system.endswith(_WGS84):
        name = re.search(r'"([^"]+)"', system)
        got = f"got {name[1] if name else system[:60]}" if system != "None" else "there is none"
        raise refusal("crs", f"{got}, must be WGS 84 (EPSG:4326) or EPSG:4258; convert the file")
