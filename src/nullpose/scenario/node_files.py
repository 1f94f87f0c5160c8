"""Files of nodes: CSV, a line for each node, and geographic files, a point for each."""

from __future__ import annotations

import csv
import io
import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from itertools import islice
from typing import TYPE_CHECKING

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.areas import counted, name_of, parts_of, unique
from nullpose.scenario.faults import Raw, RawTable, refusal
from nullpose.scenario.geo_file import Feature
from nullpose.scenario.ground_points import PLACE, Node
from nullpose.scenario.rules import MOST_MEMBERS
from nullpose.scenario.units import ALTITUDE_KEYS, GEODETIC_KEYS
from nullpose.scenario.ways import Ways
from nullpose.scenario.wording import listed, printable, unknown

if TYPE_CHECKING:
    from shapely import Point

_NODE = re.compile(r"nodes\[(\d+)\](?:\.(.+))?")
_LOCAL = ("x_m", "y_m", "z_m")
_PLACE = Ways((_LOCAL, GEODETIC_KEYS), twins=PLACE.twins)
_COLUMNS = ("name", *_LOCAL, *(key for key in Node.model_fields if key not in ("name", "position_m")))
_PLACES = {"position_m": ""} | {f"position_m[{axis}]": f", column {key}" for axis, key in enumerate(_LOCAL)}
_OF_KML = {"absolute": "alt_msl_m", "relativeToGround": "alt_agl_m"}  # by altitude mode
_TYPO = 0.75  # similarity from which an unknown property is taken for a key
_NO_HEIGHT = (
    "there is no altitude; add it to the coordinates, or as a property alt_m (ellipsoid), alt_msl_m (sea) or "
    "alt_agl_m (above the ground)"
)
_NO_PLACE = "remove this property: the place is in the coordinates"


@dataclass(frozen=True, slots=True)
class ListedNode:
    """A node as a scenario file would state it, and the way back to the file it is from.

    Args:
        where: its place in the file, such as ``line 7``.
        values: the raw node; empty if it could not be read.
        usual: the place of a value below the node's, with ``{}`` for its key.
        places: the places of those values that stand elsewhere, by key, such as ``position_m[1]``.
        fault: why it could not be read, below its own place.
    """

    where: str
    values: Mapping[str, object] = field(default_factory=dict)
    usual: str = ""
    places: Mapping[str, str] = field(default_factory=dict)
    fault: Fault | None = None


def fault_in_file(fault: Fault, file: str, nodes: Sequence[ListedNode]) -> Fault | None:
    """Give a scenario's fault its place in the nodes' file; None if it only repeats another.

    Args:
        fault: as the scenario reports it, at ``nodes[6].power_dbm`` or anywhere else.
        file: the file's name, as it stands in the scenario file.
        nodes: its nodes.
    """
    message = re.sub(r"nodes\[(\d+)\]", lambda index: f"{file}: {nodes[int(index[1])].where}", fault.message)
    place = _NODE.fullmatch(fault.path)
    if place is None:
        return Fault(fault.path, message)
    node, key = nodes[int(place[1])], place[2]
    below = node.places.get(key, node.usual.format(key)) if key else ""
    return None if node.fault else Fault(f"{file}: {node.where}{below}", message)


def nodes_of_csv(text: str) -> list[ListedNode]:
    """Read the nodes of a CSV file.

    Args:
        text: the file's content: columns ``x_m``, ``y_m``, ``z_m`` or ``lat_deg``, ``lon_deg`` and an
            altitude, a power, and any other key of a node; an empty cell is a key left out.

    Raises:
        ScenarioError: no CSV, a header that cannot be used, or no line below it.
    """
    reader = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True, strict=True)
    cells = ([cell.strip() for cell in row] for row in reader)
    lines = ((reader.line_num, row) for row in cells if any(row))
    try:
        line, header = next(lines, (1, []))
        rows = list(islice(lines, MOST_MEMBERS + 1))  # one more than are allowed, so that it is refused
    except csv.Error as error:
        raise refusal("", f"this is not CSV: {error}; check the quotes") from None
    faults = [Fault(f"line {line}", message) for message in _header_faults(header)]
    if not rows and not faults:
        faults.append(Fault("", "there is no line below the header, must be one for each node"))
    if faults:
        raise ScenarioError(faults)
    return [_node_of_row(number, header, row) for number, row in rows]


def _header_faults(header: Sequence[str]) -> Iterator[str]:
    if len(header) < 2:
        got = f'got "{printable(header[0])}"' if header else "the file is empty"
        yield f"{got}, must be a header line of columns separated by commas, such as {listed(_COLUMNS[:8])}"
        return
    for index, column in enumerate(header):
        if column in header[:index]:
            yield f'the column "{printable(column)}" is there twice; remove one'
        elif column not in _COLUMNS:
            absent = [key for key in _COLUMNS if key not in header]
            yield f'"{printable(column)}": {unknown("column", column, _COLUMNS, absent)}'
    yield from _PLACE.faults(header)


def _node_of_row(line: int, header: Sequence[str], row: Sequence[str]) -> ListedNode:
    where = f"line {line}"
    if len(row) != len(header):
        fault = Fault("", f"got {len(row)} values, must be {len(header)}, as many as the header has")
        return ListedNode(where, fault=fault)
    cells = {key: cell if key == "name" else _number(cell) for key, cell in zip(header, row, strict=True)}
    # A place is never left out, so its empty cells stay, to be refused.
    values = {key: cell for key, cell in cells.items() if cell != "" or key in GEODETIC_KEYS}
    if "x_m" in header:
        values = {key: value for key, value in values.items() if key not in _LOCAL}
        values["position_m"] = [cells[key] for key in _LOCAL]
    return ListedNode(where, values, ", column {}", _PLACES)


def _number(cell: str) -> object:
    try:
        return cell if "_" in cell else float(cell)
    except ValueError:
        return cell


def nodes_of_features(features: Sequence[Feature]) -> tuple[list[ListedNode], list[str]]:
    """Read the points of a geographic file as nodes, and account for what is passed over, if anything is.

    Args:
        features: of the file.

    Raises:
        ScenarioError: there is no point.
    """
    nodes: list[ListedNode] = []
    passed, unread, taken = Counter[str](), set[str](), set[str]()
    for feature in features:
        parts = list(parts_of(feature.geometry))
        passed["feature without a place"] += not parts
        values = _values(feature, unread)
        for index, part in enumerate(parts):
            if part.geom_type != "Point":
                passed["line" if "Line" in part.geom_type else "polygon"] += 1
                continue
            name = name_of(feature)
            name = unique(f"{name} ({index + 1})" if name and len(parts) > 1 else name, taken)
            nodes.append(_node_of_point(feature, part, values | ({"name": name} if name else {})))
    if not nodes:
        raise refusal("", f"it has no point, must have one for each node; it has {counted(passed)}")
    words = [f"passed over: {counted(passed)}"] if any(passed.values()) else []
    words += [f"properties not read: {', '.join(sorted(unread))}"] if unread else []
    return nodes, [f"nodes: {len(nodes)}; {'; '.join(words)}"] if words else []


def _values(feature: Feature, unread: set[str]) -> RawTable:
    """Pick the properties that are keys of a node or look like one; add the others to those unread."""
    keys = set(Node.model_fields)
    likely = {key for key in feature.properties if key in keys or get_close_matches(key, keys, 1, _TYPO)}
    unread |= feature.properties.keys() - likely - {"Name", "altitudeMode", "extrude", "ele"}
    return {key: feature.properties[key] for key in likely - {"name", "Name"}}


def _node_of_point(feature: Feature, point: Point, values: Raw) -> ListedNode:
    where, coordinates = feature.place, ".geometry.coordinates"
    key, height_m = "alt_m", point.z if point.has_z and math.isfinite(point.z) else None
    if where.startswith("Placemark"):  # KML clamps a point without a mode to the ground
        key = _OF_KML.get(str(feature.properties.get("altitudeMode")), "")
    if "ele" in feature.properties:  # of GPX
        key, height_m = "alt_msl_m", feature.properties["ele"]
    has_height = key != "" and height_m is not None
    for wrong in ("position_m", "lat_deg", "lon_deg", *(ALTITUDE_KEYS if has_height else ())):
        if wrong in values:
            return ListedNode(where, fault=Fault(f".properties.{wrong}", _NO_PLACE))
    if not has_height and values.keys().isdisjoint(ALTITUDE_KEYS):
        return ListedNode(where, fault=Fault(coordinates, _NO_HEIGHT))
    place = {"lon_deg": point.x, "lat_deg": point.y} | ({key: height_m} if has_height else {})
    places = {each: f"{coordinates}[{axis}]" for axis, each in enumerate(place)}
    return ListedNode(where, {**values, **place}, ".properties.{}", places | {"position_m": ".geometry"})
