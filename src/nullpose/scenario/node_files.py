"""Files of nodes: CSV, a line for each node, and geographic files, a point for each."""

from __future__ import annotations

import csv
import io
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from functools import cache
from itertools import islice
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

from shapely import Point

from nullpose.errors import Fault
from nullpose.files import PlainTable
from nullpose.scenario.areas import account, counted, name_of, unique
from nullpose.scenario.faults import call_each, printable, raise_all, refusal, require, unknown
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.ground_points import PLACE, Node
from nullpose.scenario.rules import MOST_MEMBERS
from nullpose.scenario.shapes import parts_of
from nullpose.scenario.units import ALTITUDE_KEYS, GEODETIC_KEYS
from nullpose.scenario.ways import Ways

LOCAL = ("x_m", "y_m", "z_m")
"""The columns of a place in metres."""
_PLACE = Ways((LOCAL, GEODETIC_KEYS), twins=PLACE.twins)
_COLUMNS = ("name", *LOCAL, *(key for key in Node.model_fields if key not in ("name", "position_m")))
_OF_KML = {"absolute": "alt_msl_m", "relativeToGround": "alt_agl_m"}  # by altitude mode
_READ_HERE = {"Name", "altitudeMode", "extrude", "ele"}
_TYPO = 0.75  # similarity from which an unknown property is taken for a key
_NO_HEIGHT = (
    "there is no altitude; add it to the coordinates, or as a property alt_m (ellipsoid), alt_msl_m (sea) or "
    "alt_agl_m (above the ground)"
)
_NO_PLACE = "remove this property: the place is in the coordinates"


class ListedNode(NamedTuple):
    """A raw node, and where its values stand in the file that lists it.

    Args:
        values: as a scenario file would state them.
        places: by their path below the node, such as ``position_m[1]``; by the empty path the node's own.
    """

    values: PlainTable
    places: Mapping[str, str]


ReadNodes: TypeAlias = tuple[list[ListedNode], list[Fault], list[str]]
"""The nodes of a file, the faults of those that are left out, and notes on what is not read."""


def nodes_of_csv(text: str) -> ReadNodes:
    """Read the nodes of a CSV file.

    Args:
        text: the file's content: columns ``x_m``, ``y_m``, ``z_m`` or ``lat_deg``, ``lon_deg`` and an
            altitude, a power, and any other key of a node; an empty cell is a key left out.

    Raises:
        ScenarioError: no CSV, a header that cannot be used, or no line below it.
    """
    header, rows = table_of_csv(text, _COLUMNS)
    rows = [row for row in rows if any(row[1])]
    require(rows, "", "there is no line below the header, must be one for each node")
    return *call_each(lambda row: _node_of_row(f"line {row[0]}", header, row[1]), rows), []


def table_of_csv(
    text: str, columns: Sequence[str], aliases: Mapping[str, str] = MappingProxyType({})
) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Return the header of a CSV text of points, and the rows below it with their lines.

    Args:
        text: the file's content.
        columns: that it may have, among them those of a place, of which it must have those of one kind.
        aliases: other names of columns.

    Raises:
        ScenarioError: no CSV, or a header that cannot be used.
    """
    reader = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True, strict=True)
    lines = ((reader.line_num, [cell.strip() for cell in row]) for row in reader if row[1:] or any(row))
    try:
        line, header = next((each for each in lines if any(each[1])), (1, []))
        rows = list(islice(lines, MOST_MEMBERS + 1))  # one more than are allowed, so that it is refused
    except csv.Error as error:
        raise refusal("", f"this is not CSV: {error}; check the quotes") from None
    header = [aliases.get(column, column) for column in header]
    raise_all([Fault(f"line {line}", message) for message in _header_faults(header, columns)])
    return header, rows


def _header_faults(header: Sequence[str], columns: Sequence[str]) -> Iterator[str]:
    if len(header) < 2:
        got = f'got "{printable(header[0])}"' if header else "the file is empty"
        names = ", ".join(columns[:8])
        yield f"{got}, must be a header line of columns separated by commas, such as {names}"
        return
    for index, column in enumerate(header):
        if column in header[:index]:
            yield f'the column "{printable(column)}" is there twice; remove one'
        elif column not in columns:
            absent = [key for key in columns if key not in header]
            yield f'"{printable(column)}": {unknown("column", column, columns, absent)}'
    yield from _PLACE.faults(header)


def cells_of_row(where: str, header: Sequence[str], cells: Sequence[str]) -> dict[str, object]:
    """Return the cells of a row by their columns: numbers, and what is none as it is.

    Raises:
        ScenarioError: there are more or fewer than the header has.
    """
    many = f"got {len(cells)} values, must be {len(header)}, as many as the header has"
    require(len(cells) == len(header), where, many)
    return {
        key: cell if key in ("name", "from") else number_of(cell)
        for key, cell in zip(header, cells, strict=True)
    }


def _node_of_row(where: str, header: Sequence[str], cells: Sequence[str]) -> ListedNode:
    row = cells_of_row(where, header, cells)
    places = {
        "": where,
        "position_m": where,
        **{key: f"{where}, column {key}" for key in row},
        **{f"position_m[{axis}]": f"{where}, column {key}" for axis, key in enumerate(LOCAL)},
    }
    position = {"position_m": [row[key] for key in LOCAL]} if "x_m" in row else {}
    # A place is never left out, so its empty cells stay, to be refused.
    filled = {key: cell for key, cell in row.items() if cell != "" or key in GEODETIC_KEYS}
    return ListedNode({key: filled[key] for key in filled if key not in LOCAL} | position, places)


def number_of(cell: str) -> object:
    """Return the number of a cell; the cell, to be refused, if it is none."""
    try:
        return cell if "_" in cell else float(cell)
    except ValueError:
        return cell


def nodes_of_features(features: Sequence[Feature]) -> ReadNodes:
    """Read the points of a geographic file as nodes.

    Args:
        features: of the file.

    Raises:
        ScenarioError: there is no point.
    """
    passed, taken, points = Counter[str](), set[str](), list[tuple[Feature, Point, str]]()
    for feature in features:
        parts = list(parts_of(feature.geometry))
        passed["feature without a place"] += not parts
        passed.update("line" if "Line" in part.geom_type else part.geom_type.lower() for part in parts)
        for index, part in enumerate(parts, 1):
            if part.geom_type == "Point":
                name = name_of(feature)
                name = unique(f"{name} ({index})" if name and len(parts) > 1 else name, taken)
                points.append((feature, part, name))
    del passed["point"]
    require(points, "", f"it has no point, must have one for each node; it has {counted(passed)}")
    unread = {key for feature in features for key in feature.properties if not _is_like_key(key)} - _READ_HERE
    more = {f"properties not read: {', '.join(sorted(unread))}": unread}
    notes = [account(f"nodes: {len(points)}", passed, more)] if unread or any(passed.values()) else []
    return *call_each(lambda each: _node_of_point(*each), points), notes


@cache
def _is_like_key(name: str) -> bool:
    """Tell whether a property is a key of a node or looks like one."""
    return name in Node.model_fields or bool(get_close_matches(name, Node.model_fields, 1, _TYPO))


def _node_of_point(feature: Feature, point: Point, name: str) -> ListedNode:
    likely = [key for key in feature.properties if _is_like_key(key) and key not in ("name", "Name")]
    values = {key: feature.properties[key] for key in likely} | ({"name": name} if name else {})
    where, coordinates = feature.place, f"{feature.place}.geometry.coordinates"
    key, height_m = "alt_m", point.z if point.has_z and math.isfinite(point.z) else None
    if where.startswith("Placemark"):  # KML clamps a point without a mode to the ground
        key = _OF_KML.get(str(feature.properties.get("altitudeMode")), "")
    if "ele" in feature.properties:  # of GPX
        key, height_m = "alt_msl_m", feature.properties["ele"]
    height = {key: height_m} if key and height_m is not None else {}
    for wrong in ("position_m", "lat_deg", "lon_deg", *(ALTITUDE_KEYS if height else ())):
        require(wrong not in values, f"{where}.properties.{wrong}", _NO_PLACE)
    require(height or values.keys() & ALTITUDE_KEYS, coordinates, _NO_HEIGHT)
    place = {"lon_deg": point.x, "lat_deg": point.y} | height
    places = {
        "": where,
        "position_m": f"{where}.geometry",
        **{each: f"{where}.properties.{each}" for each in values},
        **{each: f"{coordinates}[{axis}]" for axis, each in enumerate(place)},
    }
    return ListedNode({**values, **place}, places)
