"""The rows of a study: their columns, and how they are packed into Parquet."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from nullpose.study.monte_carlo.spec import StudySpec

if TYPE_CHECKING:
    import pyarrow as pa

__all__ = ["FAILED", "Row", "as_parquet", "as_table", "schema_of"]

FAILED = "failed"
"""The status of a row that has a reason in place of a pose."""

COLUMNS_BEFORE = ("scene", "point")
COLUMNS_AFTER = (
    "case",
    "status",
    "value",
    "bound",
    "gap",
    "x_m",
    "y_m",
    "z_m",
    "roll_rad",
    "pitch_rad",
    "yaw_rad",
    "binding_node",
    "boxes",
    "seconds",
    "reason",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """What one case gives in one scene at one combination of swept values.

    Args:
        scene: the scene's number.
        point: the combination's number.
        case: the case's place in the spec.
        status: certified, gap-not-reached, best-found or failed.
        value: what was maximised: a power ratio, or bits/s/Hz; None of a failure, as the next ones.
        bound: no pose exceeds it; None if nothing is proved.
        gap: relative gap between the two; None if nothing is proved.
        position_m: where the drone hovers.
        attitude_rad: roll, pitch and yaw.
        binding_node: name of the node that decides.
        boxes: boxes that the proof examined.
        seconds: how long it took.
        reason: why there is no pose, or why the gap was not reached; empty otherwise.
    """

    scene: int
    point: int
    case: int
    status: str
    value: float | None = None
    bound: float | None = None
    gap: float | None = None
    position_m: tuple[float, float, float] | None = None
    attitude_rad: tuple[float, float, float] | None = None
    binding_node: str | None = None
    boxes: int = 0
    seconds: float = 0.0
    reason: str = ""


def schema_of(spec: StudySpec) -> pa.Schema:
    """Return the columns of a study's rows.

    Args:
        spec: the study.
    """
    import pyarrow as pa

    floats = ("value", "bound", "gap", "x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad", "seconds")
    kinds: dict[str, Any] = dict.fromkeys(floats, pa.float64())
    kinds |= {"scene": pa.int64(), "point": pa.int32(), "boxes": pa.int64()}
    kinds |= {"case": pa.dictionary(pa.int16(), pa.string())}
    swept = [(path, pa.float64()) for path in spec.swept]
    before, after = (
        [(name, kinds.get(name, pa.string())) for name in names] for names in (COLUMNS_BEFORE, COLUMNS_AFTER)
    )
    return pa.schema([*before, *swept, *after])


def as_table(spec: StudySpec, rows: Sequence[Row]) -> pa.Table:
    """Return rows as a table.

    Args:
        spec: the study.
        rows: in the order in which they are to stand.
    """
    import pyarrow as pa

    points = spec.points
    places = [row.position_m or (None,) * 3 for row in rows]
    attitudes = [row.attitude_rad or (None,) * 3 for row in rows]
    columns: dict[str, Any] = {
        "case": pa.DictionaryArray.from_arrays(
            pa.array([row.case for row in rows], pa.int16()), pa.array(spec.case_names, pa.string())
        )
    }
    for axis, name in enumerate(("x_m", "y_m", "z_m")):
        columns[name] = [place[axis] for place in places]
    for angle, name in enumerate(("roll_rad", "pitch_rad", "yaw_rad")):
        columns[name] = [attitude[angle] for attitude in attitudes]
    for path in spec.swept:
        columns[path] = [points[row.point][path] for row in rows]
    schema = schema_of(spec)
    for name in schema.names:
        if name not in columns:
            columns[name] = [getattr(row, name) for row in rows]
    return pa.table({name: columns[name] for name in schema.names}, schema=schema)


def as_parquet(table: pa.Table) -> bytes:
    """Return a table as the content of a Parquet file.

    Args:
        table: the rows.
    """
    import pyarrow.parquet as pq

    content = io.BytesIO()
    pq.write_table(table, content, compression="zstd")
    return content.getvalue()
