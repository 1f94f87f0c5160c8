"""The rows of a study: their columns, and the Parquet files that hold them."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.files import PlainTable
from nullpose.study.monte_carlo.spec import StudySpec

if TYPE_CHECKING:
    import pyarrow as pa

# Columns by name: what a case reaches in a scene at a combination of swept values.
Row = PlainTable

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
    "least_tilt_deg": "float64",
    "too_little_deg": "float64",
    "boxes": "int64",
    "seconds": "float64",
    "reason": "string",
}


def row_of(scene: int, point: int, case: str, status: str, **columns: object) -> Row:
    """Make a row.

    Args:
        scene: the scene's number.
        point: the combination's number.
        case: the case's name.
        status: certified, gap-not-reached, best-found, given or failed.
        columns: further columns.
    """
    at = {"scene": scene, "point": point, "case": case, "status": status}
    return at | {"boxes": 0, "seconds": 0.0, "reason": ""} | columns


def schema_of(spec: StudySpec) -> pa.Schema:
    """List the columns of a study's rows."""
    import pyarrow as pa

    swept = [(path, pa.float64()) for path in spec.swept]
    case = pa.dictionary(pa.int16(), pa.string())
    tilts = set() if any(case.reach for case in spec.cases) else {"least_tilt_deg", "too_little_deg"}
    results = [(name, pa.type_for_alias(kind)) for name, kind in _COLUMNS.items() if name not in tilts]
    return pa.schema([("scene", pa.int64()), ("point", pa.int32()), *swept, ("case", case), *results])


def as_parquet(spec: StudySpec, rows: Sequence[Row], seconds: float) -> bytes:
    """Pack rows into a Parquet file; its pages have checksums, its footer the counts.

    Args:
        spec: the study.
        rows: in the order of the file.
        seconds: time that the work took.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    failed = sum(row["status"] == FAILED for row in rows)
    table = pa.Table.from_pylist(
        [row | spec.points[row["point"]] for row in rows],
        schema=schema_of(spec).with_metadata({"failed": str(failed), "seconds": repr(seconds)}),
    )
    content = io.BytesIO()
    # statistics of pages are for searching; without them there is less that no checksum covers
    pq.write_table(table, content, compression="zstd", write_page_checksum=True, write_statistics=False)
    return content.getvalue()


def read_parquet(spec: StudySpec, path: Path) -> pa.Table:
    """Read a part of a study, every page by its checksum.

    Raises:
        ValueError: a page has another checksum, or this is no file of the study's columns.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        # threads that meet damage may never end
        table = pq.read_table(path, page_checksum_verification=True, use_threads=False, partitioning=None)
    except (OSError, pa.ArrowException) as error:
        raise ValueError(str(error)) from None
    if not table.schema.equals(schema_of(spec)):
        raise ValueError("it has other columns than this study")
    return table


def read_counts(path: Path) -> tuple[int, int, float]:
    """Read the numbers of rows and failures, and the seconds of work, from a part's footer.

    Raises:
        ValueError: it has no such footer.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        footer = pq.read_metadata(path)
        counts = footer.metadata or {}
        return footer.num_rows, int(counts[b"failed"]), float(counts[b"seconds"])
    except (OSError, KeyError, pa.ArrowException) as error:
        raise ValueError(str(error)) from None
