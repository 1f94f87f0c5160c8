"""What a worker does: the rows of some scenes, as the content of a Parquet file."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Collection, Iterator
from functools import lru_cache
from itertools import product
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from nullpose.errors import ClusterError, ScenarioError
from nullpose.scenario import Scenario
from nullpose.study.grid import solved_grid
from nullpose.study.monte_carlo.case import StudyCase
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.rows import FAILED, Row, as_parquet, row_of
from nullpose.study.monte_carlo.solving import At, reason_of, solved_row, solved_together
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.versions import fingerprint

# The reason of the rows of a scene that no worker survives.
KILLED = "every worker that took this scene died; it may need more memory than they have"

_TOGETHER = 512  # scenes at swept values that are in memory, and solved, together
_CALIBRATED_S = 0.3  # so much work tells how long a scene takes
_CALIBRATING = tuple(2**doubled for doubled in range(10))  # scenes, until they take so long

# Below 10^15, which is above all counts that there are, and below what a float cannot hold.
Count = Annotated[int, Field(ge=0, lt=10**15)]


class Part(BaseModel):
    """The rows of some scenes in a file, as the journal lists it.

    Args:
        first: the first scene.
        last: the last scene.
        rows: how many rows there are.
        failed: how many of them are failures.
        seconds: how long a worker took for it.
        size: the file's size in bytes.
        sha256: the file's checksum.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    first: Count
    last: Count
    rows: Count
    failed: Count
    seconds: Annotated[float, Field(ge=0.0, lt=1e15)]
    size: Count
    sha256: str

    @property
    def scenes(self) -> int:
        """How many scenes it has."""
        return self.last - self.first + 1

    @property
    def name(self) -> str:
        """The file's name."""
        return f"part-{self.first:09d}-{self.last:09d}.parquet"


def rows_of(spec: StudySpec, first: int, last: int, deadly: Collection[int] = ()) -> Iterator[Row]:
    """Yield the rows of some scenes, by scene, combination of swept values and case.

    Args:
        spec: the study.
        first: the first scene.
        last: the last scene.
        deadly: scenes among them that are not touched, since no worker survives them.
    """
    draws, points = Draws(spec), range(len(spec.points))
    block = max(1, _TOGETHER // len(points))
    for start in range(first, last + 1, block):
        places = list(product(range(start, min(start + block, last + 1)), points))
        drawn = {at: KILLED if at[0] in deadly else _drawn(draws, at) for at in places}
        yield from _block_rows(spec, drawn)


def _block_rows(spec: StudySpec, drawn: dict[At, Scenario | str]) -> Iterator[Row]:
    """Yield the rows of scenes that are in memory together; of one that is none the reason is given."""
    scenes = {at: scene for at, scene in drawn.items() if not isinstance(scene, str)}
    together = solved_together(spec, scenes)

    def solved(at: At, case: StudyCase) -> Row:
        if at not in scenes:
            return row_of(*at, case.name, FAILED, reason=str(drawn[at]))
        return together.get((*at, case.name)) or solved_row(spec, scenes[at], *at, case)

    return solved_grid(list(drawn), spec.cases, solved)


def _drawn(draws: Draws, at: At) -> Scenario | str:
    """Return a scene at a combination of swept values, or why there is none."""
    try:
        return draws.at(*at)
    except ScenarioError as error:
        return reason_of(error)


def packed(spec: StudySpec, rows: list[Row], first: int, last: int, seconds: float) -> tuple[Part, bytes]:
    """Return rows as a part, and the content of its file.

    Args:
        spec: the study.
        rows: all rows of the scenes.
        first: the first scene.
        last: the last scene.
        seconds: how long the work took.
    """
    content = as_parquet(spec, rows)
    part = Part(
        first=first,
        last=last,
        rows=len(rows),
        failed=sum(row["status"] == FAILED for row in rows),
        seconds=seconds,
        size=len(content),
        sha256=hashlib.sha256(content).hexdigest(),
    )
    return part, content


def solve_chunk(
    spec_json: str, expected: str, first: int, last: int, deadly: Collection[int] = ()
) -> tuple[Part, bytes]:
    """Return the rows of some scenes as a part; this is what is sent to a worker.

    Args:
        spec_json: the study as JSON.
        expected: the fingerprint of the client's nullpose.
        first: the first scene.
        last: the last scene.
        deadly: scenes among them that no worker survives.

    Raises:
        ClusterError: another nullpose is here, or what goes wrong is beyond a scene of its own.
    """
    began = time.perf_counter()
    spec = _spec(spec_json, expected)
    try:
        rows = list(rows_of(spec, first, last, deadly))
        return packed(spec, rows, first, last, time.perf_counter() - began)
    except Exception as error:  # not every exception finds its way from one process to another
        reason = reason_of(error)
    raise ClusterError(f"workers: scenes {first} to {last} cannot be worked on: {reason}")


def seconds_per_scene(spec_json: str, expected: str) -> float:
    """Return how long a scene takes here, from the first few, once all is compiled.

    Args:
        spec_json: the study as JSON.
        expected: the fingerprint of the client's nullpose.

    Raises:
        ClusterError: another nullpose is here.
    """
    solve_chunk(spec_json, expected, 0, 0)
    for scenes in _CALIBRATING:
        part, _ = solve_chunk(spec_json, expected, 0, scenes - 1)
        if part.seconds >= _CALIBRATED_S:
            break
    return part.seconds / part.scenes


@lru_cache(maxsize=4)
def _spec(spec_json: str, expected: str) -> StudySpec:
    if fingerprint() != expected:
        raise ClusterError(
            f"workers: one has nullpose {fingerprint()}, and here it is {expected}; install the same on both "
            "and start the workers again"
        )
    return StudySpec.from_dict(json.loads(spec_json))
