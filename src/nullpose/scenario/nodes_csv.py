"""Nodes as a table of comma-separated values: a header of keys, then a line for each node."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from itertools import islice

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.faults import refusal
from nullpose.scenario.ground_points import PLACE, Node
from nullpose.scenario.listed_nodes import ListedNode
from nullpose.scenario.rules import MOST_MEMBERS
from nullpose.scenario.units import GEODETIC_KEYS
from nullpose.scenario.ways import Ways
from nullpose.scenario.wording import listed, printable, unknown

_LOCAL = ("x_m", "y_m", "z_m")
_PLACE = Ways((_LOCAL, GEODETIC_KEYS), twins=PLACE.twins)
_COLUMNS = ("name", *_LOCAL, *(key for key in Node.model_fields if key not in ("name", "position_m")))
_PLACES = {"position_m": ""} | {f"position_m[{axis}]": f", column {key}" for axis, key in enumerate(_LOCAL)}


def nodes_from_csv(text: str) -> list[ListedNode]:
    """Returns the nodes of a CSV file.

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
    return [_node(number, header, row) for number, row in rows]


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


def _node(line: int, header: Sequence[str], row: Sequence[str]) -> ListedNode:
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
