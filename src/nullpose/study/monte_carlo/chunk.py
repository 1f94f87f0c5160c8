"""What a worker does: the rows of some scenes, as the content of a Parquet file; and the mount chosen."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Collection, Iterator
from functools import cache, lru_cache
from importlib.metadata import version
from itertools import product
from pathlib import Path

import numpy as np

from nullpose.errors import ClusterError, ScenarioError, require
from nullpose.scenario import Scenario
from nullpose.study.case import Case
from nullpose.study.monte_carlo.draw import Draws, quantity_of
from nullpose.study.monte_carlo.rows import FAILED, Row, as_parquet, row_of
from nullpose.study.monte_carlo.solving import At, reason_of, solved_row, solved_together
from nullpose.study.monte_carlo.spec import StudySpec

# The reason of the rows of a scene that no worker survives.
KILLED = "every worker that took this scene died; it may need more memory than they have"

_TOGETHER = 512  # scenes at swept values that are in memory, and solved, together
_CALIBRATED_S = 0.3  # this much work tells the time of a scene
_CALIBRATING = tuple(1 << doubled for doubled in range(10))  # scenes, until they take that long


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
        yield from _block_rows(spec, {at: KILLED if at[0] in deadly else _drawn(draws, at) for at in places})


def _block_rows(spec: StudySpec, drawn: dict[At, Scenario | str]) -> Iterator[Row]:
    """Yield the rows of scenes that are in memory together; a text is why there is no scene."""
    scenes = {at: scene for at, scene in drawn.items() if not isinstance(scene, str)}
    together = solved_together(spec, scenes)
    for at, case in product(drawn, spec.cases):
        if at not in scenes:
            yield row_of(*at, case.name, FAILED, reason=str(drawn[at]))
        else:
            yield together.get((*at, case.name)) or solved_row(spec, scenes[at], *at, case)


def _drawn(draws: Draws, at: At) -> Scenario | str:
    try:
        return draws.at(*at)
    except ScenarioError as error:
        return reason_of(error)


def solve_chunk(spec_json: str, expected: str, first: int, last: int, deadly: Collection[int] = ()) -> bytes:
    """Solve some scenes, as the content of their Parquet file; this is the work that a worker is sent.

    Args:
        spec_json: the study as JSON.
        expected: the fingerprint of the client's nullpose.
        first: the first scene.
        last: the last scene.
        deadly: scenes among them that no worker survives.

    Raises:
        ClusterError: the worker has another nullpose, or the fault is beyond a single scene.
    """
    began = time.perf_counter()
    spec = _spec(spec_json, expected)
    try:
        return as_parquet(spec, list(rows_of(spec, first, last, deadly)), time.perf_counter() - began)
    except Exception as error:  # not every exception can be sent from one process to another
        reason = reason_of(error)
    raise ClusterError(f"workers: scenes {first} to {last} cannot be worked on: {reason}")


def seconds_per_scene(spec_json: str, expected: str) -> float:
    """Measure the time of a scene on the first few, once all is compiled.

    Args:
        spec_json: the study as JSON.
        expected: the fingerprint of the client's nullpose.

    Raises:
        ClusterError: the worker has another nullpose.
    """
    solve_chunk(spec_json, expected, 0, 0)
    for scenes in _CALIBRATING:
        began = time.perf_counter()
        solve_chunk(spec_json, expected, 0, scenes - 1)
        if (seconds := time.perf_counter() - began) >= _CALIBRATED_S:
            break
    return seconds / scenes


@lru_cache(maxsize=4)
def _spec(spec_json: str, expected: str) -> StudySpec:
    require(
        ClusterError,
        fingerprint() == expected,
        f"workers: one has nullpose {fingerprint()}, and here it is {expected}; install the same on both "
        "and start the workers again",
    )
    return StudySpec.from_dict(json.loads(spec_json))


@cache
def fingerprint() -> str:
    """Join the version of nullpose and a digest of its code: two that agree make the same rows."""
    root = Path(__file__).parents[2]
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes().replace(b"\r\n", b"\n"))
    return f"{version('nullpose')}+{digest.hexdigest()[:12]}"


_STAGES = ((15.0, 3), (5.0, 2), (1.0, 2))  # degrees between two mounts, and how many to each side


def with_best_mounts(spec: StudySpec, on_note: Callable[[str], None]) -> StudySpec:
    """Return a study with a number for every mount that its scenes choose, to a degree.

    A mount's level is the median over the first scenes, searched without proofs, in dB (or bits/s/Hz),
    averaged over the combinations of swept values. Mounts 15 degrees apart are tried from 0 to 90 degrees,
    then mounts 5 degrees and 1 degree apart beside the best. A higher level between mounts that are not tried
    may be missed.

    Args:
        spec: the study.
        on_note: called with a sentence before mounts are tried.
    """
    cases = [_with_best_mount(spec, case, on_note) if case.mount_scenes else case for case in spec.cases]
    return spec.model_copy(update={"cases": cases})


def _with_best_mount(spec: StudySpec, case: Case, on_note: Callable[[str], None]) -> Case:
    best_deg, levels = 45.0, dict[float, float]()
    scenes, quantity = min(case.mount_scenes or 1, spec.n_scenes), quantity_of(spec)
    search = {"certify": None if case.pose else False}  # proofs would take three times as long
    for step_deg, count in _STAGES:
        on_note(f"case {case.name}: mounts in steps of {step_deg:g} degrees are tried")
        mounted = {
            mount: case.mounted(mount, name=str(mount), **search)
            for mount in (best_deg + step_deg * step for step in range(-count, count + 1))
            if 0 <= mount <= 90
        }
        rows = rows_of(spec.model_copy(update={"cases": list(mounted.values())}), 0, scenes - 1)
        values = [quantity.in_unit(row.get("value", 0.0)) for row in rows]  # no pose is no signal
        medians = np.median(np.reshape(values, (scenes, -1, len(mounted))), axis=0)  # by point and mount
        levels |= dict(zip(mounted, medians.mean(axis=0).tolist(), strict=True))
        best_deg = max(levels, key=levels.__getitem__)
    return case.mounted(best_deg)
