"""The rows of a study: their columns, and how they are packed into Parquet."""

from __future__ import annotations

import io
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from nullpose.study.monte_carlo.spec import StudySpec

if TYPE_CHECKING:
    import pyarrow as pa

# What one case gives in one scene at one combination of swept values: what is known, by column.
Row = dict[str, Any]

FAILED = "failed"  # the status of a row that has a reason in place of a pose

# Arrow's types of the columns after scene, combination, swept values and case.
_COLUMNS = {
    "status": "string",
    "value": "float64",
    "bound": "float64",
    "gap": "float64",
    "x_m": "float64",
    "y_m": "float64",
    "z_m": "float64",
    "roll_rad": "float64",
    "pitch_rad": "float64",
    "yaw_rad": "float64",
    "null_gain": "float64",
    "binding_node": "string",
    "boxes": "int64",
    "seconds": "float64",
    "reason": "string",
}


def row_of(scene: int, point: int, case: str, status: str, **known: Any) -> Row:
    """Return a row.

    Args:
        scene: the scene's number.
        point: the combination's number.
        case: the case's name.
        status: certified, gap-not-reached, best-found, given or failed.
        known: further columns.
    """
    at = {"scene": scene, "point": point, "case": case, "status": status}
    return at | {"boxes": 0, "seconds": 0.0, "reason": ""} | known


def schema_of(spec: StudySpec) -> pa.Schema:
    """Return the columns of a study's rows.

    Args:
        spec: the study.
    """
    import pyarrow as pa

    swept = [(path, pa.float64()) for path in spec.swept]
    case = pa.dictionary(pa.int16(), pa.string())
    results = [(name, pa.type_for_alias(kind)) for name, kind in _COLUMNS.items()]
    return pa.schema([("scene", pa.int64()), ("point", pa.int32()), *swept, ("case", case), *results])


def as_parquet(spec: StudySpec, rows: Iterable[Row]) -> bytes:
    """Return rows as the content of a Parquet file.

    Args:
        spec: the study.
        rows: in the order in which they are to stand.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    points, content = spec.points, io.BytesIO()
    whole = [row | points[row["point"]] for row in rows]
    pq.write_table(pa.Table.from_pylist(whole, schema=schema_of(spec)), content, compression="zstd")
    return content.getvalue()
