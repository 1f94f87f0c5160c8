"""What a worker does: the rows of some scenes, as the content of a Parquet file."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from nullpose.errors import ScenarioError
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.rows import FAILED, Row, as_parquet, as_table
from nullpose.study.monte_carlo.solving import reason_of, solved_row
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.versions import fingerprint

__all__ = ["Done", "failed_rows", "packed", "rows_of", "seconds_per_scene", "solve_chunk"]

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
        content: the rows as a Parquet file; empty if the worker's nullpose is not the client's.
        fingerprint: which nullpose did it.
    """

    first: int
    last: int
    rows: int
    failed: int
    seconds: float
    content: bytes
    fingerprint: str


def rows_of(spec: StudySpec, first: int, last: int) -> Iterator[Row]:
    """Yield the rows of some scenes, by scene, combination of swept values and case.

    Args:
        spec: the study.
        first: the first scene.
        last: the last scene.
    """
    draws = Draws(spec)
    for index in range(first, last + 1):
        for point in range(len(spec.points)):
            try:
                scene = draws.at(index, point)
            except ScenarioError as error:
                yield from failed_rows(spec, index, point, reason_of(error))
                continue
            for place in range(len(spec.cases)):
                yield solved_row(spec, scene, index, point, place)


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


def solve_chunk(spec_json: str, expected: str, first: int, last: int) -> Done:
    """Return the rows of some scenes; this is what is sent to a worker.

    Args:
        spec_json: the study as JSON.
        expected: the fingerprint of the client's nullpose.
        first: the first scene.
        last: the last scene.
    """
    if fingerprint() != expected:  # told, not raised: the client says what to do about it
        return Done(first, last, 0, 0, 0.0, b"", fingerprint())
    spec = _spec(spec_json)
    began = time.perf_counter()
    rows = list(rows_of(spec, first, last))
    return packed(spec, rows, first, last, time.perf_counter() - began)


def seconds_per_scene(spec_json: str) -> float:
    """Return how long a scene takes here, from the first few, once all is compiled.

    Args:
        spec_json: the study as JSON.
    """
    spec = _spec(spec_json)
    last = min(spec.n_scenes, _MOST_CALIBRATED) - 1
    for _ in rows_of(spec, 0, 0):
        pass
    began = time.perf_counter()
    for done in range(1, last + 2):
        for _ in rows_of(spec, done - 1, done - 1):
            pass
        spent = time.perf_counter() - began
        if spent >= _CALIBRATED_S:
            break
    return spent / done


@lru_cache(maxsize=4)
def _spec(spec_json: str) -> StudySpec:
    import json

    return StudySpec.from_dict(json.loads(spec_json))
