"""Nodes as a table of comma-separated values: a header of keys, then a line for each node."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from itertools import islice

from nullpose.errors import Fault
from nullpose.scenario.ground_points import Node
from nullpose.scenario.listed_nodes import WHOLE, ListedNodes, NodesFileError
from nullpose.scenario.origin import GEODETIC_KEYS
from nullpose.scenario.section import MOST_MEMBERS
from nullpose.scenario.wording import listed, nearest, printable

__all__ = ["nodes_from_csv"]

_LOCAL = ("x_m", "y_m", "z_m")


def nodes_from_csv(text: str) -> ListedNodes:
    """Returns the nodes of a CSV file.

    Args:
        text: the file's content: columns ``x_m``, ``y_m``, ``z_m`` or ``lat_deg``, ``lon_deg``, ``alt_m``, a
            power, and any other key of a node; an empty cell is a key left out.

    Raises:
        NodesFileError: no CSV, a header that cannot be used, or no line below it.
    """
    lines = _lines(text)
    try:
        header_line, header = next(lines, (1, []))
        if words := list(_header_faults(header)):
            raise NodesFileError(*(Fault(f"line {header_line}", message) for message in words))
        rows = list(islice(lines, MOST_MEMBERS + 1))  # one more than are allowed, so that it is refused
    except csv.Error as error:
        raise NodesFileError(Fault("", f"this is not CSV: {error}; check the quotes")) from None
    if not rows:
        raise NodesFileError(Fault("", "there is no line below the header, must be one for each node"))
    faults: list[Fault] = []
    hidden: dict[int, str] = {}
    members: list[dict[str, object]] = []
    for index, (line, row) in enumerate(rows):
        members.append(_member(header, row) if len(row) == len(header) else {})
        if len(row) != len(header):
            message = f"got {len(row)} values, must be {len(header)}, as many as the header has"
            faults.append(Fault(f"line {line}", message))
            hidden[index] = WHOLE
    return ListedNodes(
        members=tuple(members),
        where=tuple(f"line {line}" for line, _ in rows),
        place_of=_place_of,
        faults=tuple(faults),
        hidden=hidden,
    )


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yields the lines that hold anything, each with its number, their cells without blanks at the ends."""
    reader = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True, strict=True)
    before = 0
    for row in reader:
        cells = [cell.strip() for cell in row]
        if any(cells):
            yield before + 1, cells
        before = reader.line_num


def _header_faults(header: Sequence[str]) -> Iterator[str]:
    values = [key for key in Node.model_fields if key not in ("position_m", *GEODETIC_KEYS)]
    known = ["name", *_LOCAL, *GEODETIC_KEYS, *(key for key in values if key != "name")]
    if not header:
        yield f"the file is empty, must have a header line with columns such as {listed(known[:8])}"
        return
    if len(header) == 1 and any(mark in header[0] for mark in ";\t"):
        yield "the columns are not separated by commas; save the file as comma-separated values (CSV)"
        return
    for index, column in enumerate(header):
        if column in header[:index]:
            yield f'the column "{printable(column)}" is there twice; remove one'
        elif column not in known:
            guess = nearest(column, [key for key in known if key not in header])
            meant = f'; did you mean "{guess}"?' if guess else ";"
            yield f'unknown column "{printable(column)}"{meant} the columns here are {listed(known)}'
    yield from _place_faults(header)


def _place_faults(header: Sequence[str]) -> Iterator[str]:
    local, earthly = ([key for key in keys if key in header] for keys in (_LOCAL, GEODETIC_KEYS))
    if local and earthly:
        yield f"columns {listed(local + earthly)} state places in both ways; keep one of the two"
    elif not local and not earthly:
        yield f"there are no columns of places, must be {listed(_LOCAL)} or {listed(GEODETIC_KEYS)}"
    else:
        missing = [key for key in (_LOCAL if local else GEODETIC_KEYS) if key not in header]
        if missing:
            yield f"the column {' and '.join(missing)} is missing beside {listed(local + earthly)}; add it"


def _member(header: Sequence[str], row: Sequence[str]) -> dict[str, object]:
    cells = dict(zip(header, row, strict=True))
    values = {key: cell if key == "name" else _number(cell) for key, cell in cells.items()}
    places = {key: value for key, value in values.items() if key in GEODETIC_KEYS}
    if "x_m" in values:
        places = {"position_m": [values[key] for key in _LOCAL]}
    # A place is never left out, so its empty cells stay, to be refused.
    others = {
        key: value for key, value in values.items() if key not in (*_LOCAL, *GEODETIC_KEYS) and value != ""
    }
    return others | places


def _number(cell: str) -> object:
    try:
        return cell if "_" in cell else float(cell)
    except ValueError:
        return cell


def _place_of(index: int, key: str, rest: str) -> str:
    if key != "position_m":
        return f", column {key}"
    return f", column {_LOCAL[int(rest[1:-1])]}" if rest else ""
