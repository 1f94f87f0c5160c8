"""Whether the parts of a shapefile agree: GDAL reads what they have in common, and says nothing."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

from nullpose.files import read_bytes
from nullpose.scenario.faults import refusal, require

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
