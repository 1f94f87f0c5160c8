"""Features of geographic files: GeoJSON, KML, KMZ, GeoPackage, shapefile and GPX.

GeoJSON is read here, since GDAL drops what ED-318 states inside a geometry; GDAL (pyogrio) reads the rest.
"""

from __future__ import annotations

import io
import json
import re
import warnings
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.errors import Fault, ScenarioError
from nullpose.files import parse_json
from nullpose.scenario.faults import EXCHANGED, Raw, refusal
from nullpose.scenario.toml_file import decoded
from nullpose.scenario.wording import described

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from shapely.geometry.base import BaseGeometry

# What reads files is imported where one is read: most scenarios name none.

ENDINGS = (".geojson", ".json", ".kml", ".kmz", ".gpkg", ".shp", ".gpx")
"""How the names of the files end."""
MOST_BYTES = 60_000_000
NAMES = ("name", "Name", "NAME", "title", "identifier", "designator")
"""The properties that may name a feature, the first first."""
_MOST_FAULTS = 100  # of one file
_SIGNS = {".kmz": b"PK", ".gpkg": b"SQLite format 3\0", ".shp": b"\0\0\x27\x0a", ".kml": b"", ".gpx": b""}
_GEOMETRIES = ("Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon")
_WGS84 = ("CRS84", "CRS84h", "4326", "4979", "4258")  # as the names of reference systems end
# Of GDAL's warnings: rings are closed here; age, style and measures along lines change no place.
_NO_MATTER = (
    "Non closed ring",
    "bad application_id",
    "parsing kml Style",
    "Measured (M) geometry types",
)
_POINTS_OF_LINES = {"route_points", "track_points"}  # of GPX, which are in its lines too
_OF_DRAWING = {"id", "tessellate", "visibility", "drawOrder", "icon", "snippet"}  # GDAL's columns of KML
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_PLACE = re.compile(rf"{_NUMBER},{_NUMBER}(?:,(?:{_NUMBER})?)?")


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
    properties: Raw


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
        return list(_features_of_json(decoded(content)))
    if not content.startswith(_SIGNS[ending]):
        raise refusal("", f"it does not begin as a {ending} file does; is it of another kind?")
    content = _kml_of_kmz(content) if ending == ".kmz" else content
    is_kml = ending in (".kml", ".kmz")
    expected = _placemarks(content) if is_kml else (0, 0)
    if ending == ".gpx":
        _root(content, "gpx")
    # GDAL knows an old GeoPackage by its ending, and reads the journal beside it
    source = path if ending in (".shp", ".gpkg") else content
    features = list(_features_of_gdal(source, is_kml))
    if is_kml and (len(features), min(_corners(features), expected[1])) != expected:
        raise refusal(
            "",
            f"GDAL reads {len(features)} placemarks with {_corners(features)} coordinates, and it has "
            f"{expected[0]} with {expected[1]}; is a polygon without its outerBoundaryIs, or a LinearRing by "
            "itself? Export it anew",
        )
    if not features:
        raise refusal("", "there is no feature in it, must be one or more")
    return features


def _features_of_json(text: str) -> Iterator[Feature]:
    data = parse_json(text)
    if not isinstance(data, dict):
        raise refusal("", f"got {described(data)}, must be a FeatureCollection")
    kind, members = data.get("type"), data.get("features")
    if isinstance(members, list) and any(isinstance(_of(each, "geometry"), list) for each in members):
        raise refusal("", "this is ED-269 JSON, which is not read; convert it to ED-318, which is GeoJSON")
    if kind in (*_GEOMETRIES, "GeometryCollection", "Feature"):
        members = [data if kind == "Feature" else {"type": "Feature", "geometry": data}]
    elif kind != "FeatureCollection":
        allowed = 'must be "FeatureCollection", "Feature" or a geometry'
        raise refusal("type", f"got {described(kind)}, {allowed}")
    if not isinstance(members, list) or not members:
        raise refusal("features", f"got {described(members)}, must be a list of one feature or more")
    if "crs" in data:
        _require_wgs84(json.dumps(data["crs"]).rstrip('}"]'))
    faults: list[Fault] = []
    for index, member in enumerate(members):
        try:
            yield from _features_of_member(f"features[{index}]", member)
        except ScenarioError as error:
            faults += error.faults
        if len(faults) > _MOST_FAULTS:
            break
    if faults:
        raise ScenarioError(faults)


def _features_of_member(place: str, member: Any) -> Iterator[Feature]:
    geometry, properties = _of(member, "geometry"), _of(member, "properties")
    if _of(member, "type") != "Feature":
        allowed = 'must be an object with "type": "Feature"'
        raise refusal(place, f"got {described(_of(member, 'type'))}, {allowed}")
    if "geometry" not in member:
        raise refusal(f"{place}.geometry", "missing; a feature without a place states null")
    if not isinstance(properties, dict | None):
        raise refusal(f"{place}.properties", f"got {described(properties)}, must be an object")
    parts = _of(geometry, "geometries")
    if isinstance(parts, list) and any({"layer", "extent"} & set(each) for each in parts if each):
        shapes = {f"{place}.geometry.geometries[{index}]": each for index, each in enumerate(parts)}
    else:
        shapes = {f"{place}.geometry": geometry}
    for where, shape in shapes.items():
        beside = dict(shape) if isinstance(shape, dict) else {}
        for key in ("type", "coordinates", "geometries"):
            beside.pop(key, None)
        found = {key: value for key, value in {**(properties or {}), **beside}.items() if value is not None}
        yield Feature(where.removesuffix(".geometry"), _shape(shape, where), found)


def _of(value: Any, key: str) -> Any:
    return value.get(key) if isinstance(value, dict) else None


def _shape(geometry: object, place: str) -> BaseGeometry | None:
    """Return a GeoJSON geometry as shapely's."""
    import shapely
    from shapely.geometry import shape

    if geometry is None:
        return None
    try:
        found = shape(geometry)
    except (
        AttributeError,
        IndexError,
        KeyError,
        TypeError,
        ValueError,
        shapely.errors.ShapelyError,
    ) as error:
        got = described(geometry["type"] if isinstance(geometry, dict) and "type" in geometry else geometry)
        raise refusal(
            place, f"got {got}, must be a geometry with [longitude, latitude] in degrees ({error})"
        ) from None
    return _on_earth(found, place)


def _on_earth(shape: BaseGeometry, place: str) -> BaseGeometry:
    """Return a geometry whose coordinates are longitudes, which may go on beyond 180, and latitudes."""
    import shapely

    places = shapely.get_coordinates(shape)
    wrong = ~(np.abs(places) <= [360.0, 90.0]).all(axis=1)  # NaN too
    if wrong.any():
        lon, lat = places[wrong.argmax()]
        raise refusal(place, f"got longitude {lon:g} and latitude {lat:g}, must be degrees; {EXCHANGED}")
    return shape


def _kml_of_kmz(content: bytes) -> bytes:
    import zipfile
    import zlib

    names, found = [], b""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            names = [name for name in archive.namelist() if name.lower().endswith(".kml")]
            for name in names[:1]:
                with archive.open(name) as file:
                    found = file.read(MOST_BYTES + 1)
    except (
        zipfile.BadZipFile,
        zlib.error,
        EOFError,
        OSError,
        NotImplementedError,
        RuntimeError,
        ValueError,
    ) as error:
        raise refusal(
            "", f"this is not KMZ: {str(error) or 'it ends early'}; export it anew, or as .kml"
        ) from None
    if len(names) != 1:
        raise refusal("", f"it has {len(names)} KML files, must be one; extract the one that counts")
    if len(found) > MOST_BYTES:
        raise refusal("", f"its KML is larger than {MOST_BYTES / 1e6:g} MB, the most that is read")
    return found


def _root(content: bytes, kind: str) -> Element:
    """Return the root of an XML document of a kind."""
    from xml.etree import ElementTree

    try:
        root = ElementTree.fromstring(b"" if b"<!DOCTYPE" in content else content)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise refusal("", f"this is not {kind.upper()}: {error}; export it anew") from None
    if _kind(root) != kind:
        raise refusal("", f"its root is {_kind(root)!r}, must be {kind!r}")
    return root


def _corners(features: Sequence[Feature]) -> int:
    import shapely

    return int(sum(shapely.get_num_coordinates([feature.geometry for feature in features])))


def _placemarks(content: bytes) -> tuple[int, int]:
    """Count placemarks and coordinates of a KML document; refuse what else may hold areas."""
    root = _root(content, "kml")
    kinds, corners = Counter(map(_kind, root.iter())), 0
    for kind, words in (("NetworkLink", "a link to another file"), ("GroundOverlay", "a picture on a map")):
        if kinds[kind]:
            raise refusal("", f"it has a {kind}, {words}, which is not read; save what it shows as KML")
    for placemark in (each for each in root.iter() if _kind(each) == "Placemark"):
        for each in placemark.iter():
            places = (each.text or "").split() if _kind(each) == "coordinates" else []
            corners += len(places)
            wrong = next((word for word in places if not _PLACE.fullmatch(word)), None)
            if wrong is not None:
                name = f'Placemark "{placemark.findtext("{*}name", "").strip()}"'
                raise refusal(name, f'got "{wrong[:60]}", must be longitude,latitude without blanks')
    return kinds["Placemark"], corners


def _kind(element: Element) -> str:
    return element.tag.rpartition("}")[2]


def _features_of_gdal(source: Path | bytes, is_kml: bool) -> Iterator[Feature]:
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
    for warning in said:
        if not any(words in str(warning.message) for words in _NO_MATTER):
            raise refusal("", f"GDAL reads it in part only: {str(warning.message)[:200]}; export it anew")
    numbers = count()
    for layer, (meta, _, shapes, columns) in layers:
        if shapes is None:  # a table, such as of styles
            shapes = [None] * len(columns[0]) if columns else []
        else:
            _require_wgs84(str(meta["crs"]))
        for index, shape in enumerate(shapes):
            cells = {
                key: _cell(column[index], key in NAMES)
                for key, column in zip(meta["fields"], columns, strict=True)
            }
            if is_kml:
                cells = {key: cells[key] for key in cells.keys() - _OF_DRAWING}
            found = {key: value for key, value in cells.items() if value not in (None, "")}
            name = found.get("Name", found.get("name"))
            kind = "Placemark" if is_kml else layer
            place = f"{kind}[{next(numbers) if is_kml else index}]" if name is None else f'{kind} "{name}"'
            yield Feature(place, _shape_of_wkb(shape, place), found)


def _cell(value: Any, is_name: bool) -> Any:
    """Return a value of a table as plain data; numbers and lists in texts as such, but in names; or None."""
    if isinstance(value, np.generic):
        value = value.item() if value.dtype.kind != "M" else None if np.isnat(value) else str(value)
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, str) and not is_name:
        with suppress(ValueError, RecursionError):
            return json.loads(value)
    return None if value is None or value != value else value


def _shape_of_wkb(shape: bytes | None, place: str) -> BaseGeometry | None:
    import shapely

    try:
        return None if shape is None else _on_earth(shapely.from_wkb(shape, on_invalid="fix"), place)
    except shapely.GEOSException as error:
        raise refusal(place, f"its geometry cannot be used: {error}") from None


def _require_wgs84(system: str) -> None:
    if not system.endswith(_WGS84):
        name = re.search(r'"([^"]+)"', system)
        got = f"got {name[1] if name else system[:60]}" if system != "None" else "there is none"
        raise refusal("crs", f"{got}, must be WGS 84 (EPSG:4326) or EPSG:4258; convert the file")
