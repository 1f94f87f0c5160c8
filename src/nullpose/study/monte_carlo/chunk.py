"""What a worker does: the rows of some scenes, as the content of a Parquet file."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

from nullpose.errors import ScenarioError
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.rows import FAILED, Row, as_parquet, as_table
from nullpose.study.monte_carlo.solving import reason_of, solved_row
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.together import Instance, solved_together
from nullpose.study.monte_carlo.versions import fingerprint

__all__ = ["Done", "failed_rows", "joined", "packed", "rows_of", "seconds_per_scene", "solve_chunk"]

_TOGETHER = 512  # scenes at swept values that are in memory, and solved, together
_CALIBRATED_S = 0.3  # so much work tells how long a scene takes
_MOST_CALIBRATED = 1000


@dataclass(frozen=True, slots=True)
class Done:
    """The rows of some scenes.

    Args:
        first: the first scene.
        last: the last scene.
        rows: how many rows there are.
        failed: how many of them are failures.
        seconds: how long the work took.
        content: the rows as a Parquet file; empty if there are none.
        fingerprint: which nullpose did it; none is done by another than the client's.
        fault: what went wrong beyond a scene of its own; empty if nothing did.
    """

    first: int
    last: int
    rows: int
    failed: int
    seconds: float
    content: bytes
    fingerprint: str
    fault: str = ""


def rows_of(spec: StudySpec, first: int, last: int) -> Iterator[Row]:
    """Yield the rows of some scenes, by scene, combination of swept values and case.

    Args:
        spec: the study.
        first: the first scene.
        last: the last scene.
    """
    draws = Draws(spec)
    for start in range(first, last + 1, block := max(1, _TOGETHER // len(spec.points))):
        instances: list[Instance] = []
        faults: dict[tuple[int, int], str] = {}
        indices = range(start, min(start + block, last + 1))
        for index, point in product(indices, range(len(spec.points))):
            try:
                instances.append((index, point, draws.at(index, point)))
            except ScenarioError as error:
                faults[index, point] = reason_of(error)
        scenes = {(index, point): scene for index, point, scene in instances}
        rows = solved_together(spec, instances) if instances else {}
        for at in product(indices, range(len(spec.points))):
            if at in faults:
                yield from failed_rows(spec, *at, faults[at])
                continue
            for place in range(len(spec.cases)):
                yield rows.get((*at, place)) or solved_row(spec, scenes[at], *at, place)


def failed_rows(spec: StudySpec, index: int, point: int, reason: str) -> Iterator[Row]:
    """Yield the rows of a scene at a combination of swept values of which nothing can be solved.

    Args:
        spec: the study.
        index: the scene's number.
        point: the combination's number.
        reason: why.
    """
    for place in range(len(spec.cases)):
        yield Row(scene=index, point=point, case=place, status=FAILED, reason=reason)


def packed(spec: StudySpec, rows: list[Row], first: int, last: int, seconds: float) -> Done:
    """Return rows as a part.

    Args:
        spec: the study.
        rows: all rows of the scenes.
        first: the first scene.
        last: the last scene.
        seconds: how long the work took.
    """
    failed = sum(row.status == FAILED for row in rows)
    content = as_parquet(as_table(spec, rows))
    return Done(first, last, len(rows), failed, seconds, content, fingerprint())


def joined(pieces: list[Done]) -> Done:
    """Return parts that follow one another as one.

    Args:
        pieces: at least one, in order.
    """
    import io

    import pyarrow as pa
    import pyarrow.parquet as pq

    return Done(
        pieces[0].first,
        pieces[-1].last,
        sum(piece.rows for piece in pieces),
        sum(piece.failed for piece in pieces),
        sum(piece.seconds for piece in pieces),
        as_parquet(pa.concat_tables([pq.read_table(io.BytesIO(piece.content)) for piece in pieces])),
        pieces[0].fingerprint,
    )


def solve_chunk(spec_json: str, expected: str, first: int, last: int) -> Done:
    """Return the rows of some scenes; this is what is sent to a worker.

    It raises nothing: not every exception finds its way from one process to another.

    Args:
        spec_json: the study as JSON.
        expected: the fingerprint of the client's nullpose.
        first: the first scene.
        last: the last scene.
    """
    if fingerprint() != expected:
        return Done(first, last, 0, 0, 0.0, b"", fingerprint())
    began = time.perf_counter()
    try:
        spec = _spec(spec_json)
        rows = list(rows_of(spec, first, last))
        return packed(spec, rows, first, last, time.perf_counter() - began)
    except Exception as error:
        return Done(first, last, 0, 0, 0.0, b"", expected, fault=reason_of(error))


def seconds_per_scene(spec_json: str) -> float:
    """Return how long a scene takes here, from the first few, once all is compiled.

    Args:
        spec_json: the study as JSON.
    """
    spec = _spec(spec_json)
    for _ in rows_of(spec, 0, 0):
        pass
    scenes, spent = 1, 0.0
    while True:
        began = time.perf_counter()
        for _ in rows_of(spec, 0, scenes - 1):
            pass
        spent = time.perf_counter() - began
        if spent >= _CALIBRATED_S or 2 * scenes > min(spec.n_scenes, _MOST_CALIBRATED):
            return spent / scenes
        scenes *= 2


@lru_cache(maxsize=4)
def _spec(spec_json: str) -> StudySpec:
    import json

    return StudySpec.from_dict(json.loads(spec_json))
