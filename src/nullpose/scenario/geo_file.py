"""Features of geographic files: GeoJSON, KML, KMZ, plans of QGroundControl, GeoPackage, shapefile and GPX.

GeoJSON and KML are read here, since GDAL drops what a geometry states beside its coordinates; GDAL (pyogrio)
reads the last three.
"""

from __future__ import annotations

import json
import struct
import warnings
from collections.abc import Callable, Iterable, Iterator
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

from nullpose.errors import install_command
from nullpose.files import PlainTable, read_bytes
from nullpose.scenario.faults import EXCHANGED, call_each, described, raise_all, refusal, require, value_of
from nullpose.scenario.geo_json import members_of, require_wgs84
from nullpose.scenario.kml import kml_of_kmz, placemarks_of, root_of
from nullpose.scenario.toml_file import decoded

_HEAD = 100  # bytes before the first record of .shp and of .shx


def require_whole(content: bytes, path: Path, most: int) -> None:
    """Refuse a shapefile that is cut short, or whose .shp, .shx and .dbf do not hold the same records.

    Args:
        content: of the .shp.
        path: of the .shp, beside which the others are.
        most: the largest part that is read, bytes.

    Raises:
        ScenarioError: a part is missing, or says other than the .shp.
    """
    beside = {each.suffix.lower(): each for each in path.parent.iterdir() if each.stem == path.stem}
    require(
        beside.keys() >= {".shx", ".dbf"}, "", "a .shp needs its .shx and its .dbf beside it; copy all of it"
    )
    try:
        index, table = (read_bytes(beside[ending], most) for ending in (".shx", ".dbf"))
        sizes = [2 * struct.unpack(">i", part[24:28])[0] - len(part) for part in (content, index)]
        places = list(struct.iter_unpack(">ii", index[_HEAD:]))
        rows, head, size = struct.unpack("<IHH", table[4:12])
        records = list(_records(content))
    except (OSError, struct.error) as error:
        raise refusal("", f"its parts cannot be read ({error}); export it anew") from None
    more = len(table) - head - rows * size  # a byte that ends it, or two
    require(
        not any(sizes) and records == places and rows == len(records) and 0 <= more <= size,
        "",
        f"its parts do not agree, or one is cut short: the .shp has {len(records)} records, the .shx "
        f"{len(places)}, the .dbf {rows}; export it anew",
    )


def _records(content: bytes) -> Iterator[tuple[int, int]]:
    """Yield the place and the length of each record that is there as a whole, in words of two bytes."""
    at = _HEAD
    while at < len(content):
        (length,) = struct.unpack(">i", content[at + 4 : at + 8])
        if length < 2 or at + 8 + 2 * length > len(content):
            break
        yield at // 2, length
        at += 8 + 2 * length


ENDINGS = (".geojson", ".json", ".kml", ".kmz", ".gpkg", ".shp", ".gpx")
"""How the names of the files end."""
MOST_BYTES = 60_000_000
NAMES = ("name", "Name", "NAME", "title", "identifier", "designator")
"""The properties that may name a feature, the first first."""
_SIGNS = {".kmz": b"PK", ".gpkg": b"SQLite format 3\0", ".shp": b"\0\0\x27\x0a", ".kml": b"", ".gpx": b""}
# Of GDAL's warnings: rings are closed here; age, style and measures along lines change no place.
_NO_MATTER = ("Non closed ring", "bad application_id", "Measured (M) geometry types")
_OF_GEOJSON = ("type", "coordinates", "geometries", "geometry", "properties", "id", "bbox")
_POINTS_OF_LINES = {"route_points", "track_points"}  # of GPX, which are in its lines too


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
    if ending in (".geojson", ".json", ".plan"):
        of_members, faults = call_each(_features_of_member, members_of(decoded(content)).items())
        raise_all(faults)
        return list(chain.from_iterable(of_members))
    require(
        content.startswith(_SIGNS[ending]),
        "",
        f"it does not begin as a {ending} file does; is it of another kind?",
    )
    if ending in (".kml", ".kmz"):
        content = kml_of_kmz(content, MOST_BYTES) if ending == ".kmz" else content
        features = [
            _feature(place, shape, _cells(texts.items()), place)
            for place, shape, texts in placemarks_of(root_of(content, "kml"))
        ]
    else:
        if ending == ".gpx":
            root_of(content, "gpx")
        elif ending == ".shp":
            require_whole(content, path, MOST_BYTES)
        # GDAL knows an old GeoPackage by its ending, and reads the journal beside it
        features = list(_features_of_gdal(content if ending == ".gpx" else path))
    require(features, "", "there is no feature in it, must be one or more")
    return features


def _features_of_member(placed: tuple[str, Any]) -> list[Feature]:
    place, member = placed
    geometry, properties = value_of(member, "geometry"), value_of(member, "properties")
    require(
        value_of(member, "type") == "Feature",
        place,
        f'got {described(value_of(member, "type"))}, must be an object with "type": "Feature"',
    )
    require("geometry" in member, f"{place}.geometry", "missing; a feature without a place states null")
    require(
        isinstance(properties, dict | None),
        f"{place}.properties",
        f"got {described(properties)}, must be an object",
    )
    parts = value_of(geometry, "geometries")
    if isinstance(parts, list) and any({"layer", "extent"} & set(each) for each in parts if each):
        shapes = {f"{place}.geometry.geometries[{index}]": each for index, each in enumerate(parts)}
    else:
        shapes = {f"{place}.geometry": geometry}
    whole = _beside(member) | (properties or {})
    return [
        _feature(where.removesuffix(".geometry"), shape, whole | _beside(shape), where)
        for where, shape in shapes.items()
    ]


def _beside(table: object) -> PlainTable:
    """List the members of a feature or a geometry of GeoJSON beside those that the standard names."""
    return {key: table[key] for key in table if key not in _OF_GEOJSON} if isinstance(table, dict) else {}


def _feature(place: str, shape: object, properties: PlainTable, where: str) -> Feature:
    return Feature(
        place,
        _shape(shapely.geometry.shape, shape, where),
        {key: value for key, value in properties.items() if value is not None},
    )


def _shape(read: Callable[[Any], BaseGeometry], geometry: object, place: str) -> BaseGeometry | None:
    """Read a geometry, whose coordinates are longitudes, which may go on beyond 180, and latitudes."""
    if geometry is None:
        return None
    try:
        shape = read(geometry)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError, ShapelyError) as error:
        got = described(geometry["type"] if isinstance(geometry, dict) and "type" in geometry else geometry)
        raise refusal(
            place, f"got {got}, must be a geometry with [longitude, latitude] in degrees ({str(error)[:200]})"
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
        raise refusal("", "this kind of file needs pyogrio; " + install_command("gis")) from None
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


def _features_of_gdal(source: Path | bytes) -> Iterator[Feature]:
    numbers = count()
    read_wkb = partial(shapely.from_wkb, on_invalid="fix")
    for layer, (meta, _, shapes, columns) in _layers_of_gdal(source):
        if shapes is None:  # a table, such as of styles
            shapes = [None] * len(columns[0]) if columns else []
        else:
            require_wgs84(str(meta["crs"]))
        for index, shape in enumerate(shapes):
            found = _cells(zip(meta["fields"], (column[index] for column in columns), strict=True))
            name, number = found.get("Name", found.get("name")), next(numbers)
            place = f"{layer}[{number}]" if name is None else f'{layer} "{name}"'
            yield Feature(place, _shape(read_wkb, shape, place), found)


def _cells(texts: Iterable[tuple[str, object]]) -> PlainTable:
    """Return the values of a table's row that are not empty, by the names of their columns."""
    cells = ((key, _cell(value, key in NAMES)) for key, value in texts)
    return {key: value for key, value in cells if value not in (None, "")}


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
