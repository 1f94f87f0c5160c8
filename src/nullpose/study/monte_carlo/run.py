"""A study run from its spec into its folder: in this process, on this machine or on a cluster."""

from __future__ import annotations

import json
import os
import platform
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait
from dataclasses import dataclass, replace
from importlib.metadata import version
from itertools import islice
from pathlib import Path

from nullpose.errors import require_number, require_usage
from nullpose.files import prepare_folder
from nullpose.study.monte_carlo.chunk import fingerprint, seconds_per_scene, solve_chunk, with_best_mounts
from nullpose.study.monte_carlo.folder import Folder, PartFile, require_extra
from nullpose.study.monte_carlo.loading import require_sound
from nullpose.study.monte_carlo.reading import StudyStatus, study_spec, study_status
from nullpose.study.monte_carlo.rows import read_counts
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.workers import LOOK_S, Workers, workers_of

MOST_IN_A_PART = 5000  # scenes, however quick they are: a part is held in memory whole

_PART_S = 1.0
_MOST_WORKERS = 1024

Scenes = tuple[int, int]  # the first and the last


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyProgress:
    """How far a run is, for its callback.

    Args:
        scenes: how many there are.
        done: how many are in parts, those of earlier runs too.
        rows: how many rows these have.
        failed: how many of them are failures.
        workers: threads that work; 0 while there is none but this process.
        rate: scenes per second of this run so far; 0 before the first part.
        note: news besides; empty while scenes are solved.
    """

    scenes: int
    done: int = 0
    rows: int = 0
    failed: int = 0
    workers: int = 0
    rate: float = 0.0
    note: str = ""

    @property
    def seconds_left(self) -> float | None:
        """Time that the rest takes at this rate; None before the first part."""
        return (self.scenes - self.done) / self.rate if self.rate > 0.0 else None


class _Tally:
    """Counts of what is done, and the callback that hears of them."""

    def __init__(self, scenes: int, on_progress: Callable[[StudyProgress], None] | None) -> None:
        self.at = StudyProgress(scenes=scenes)
        self._on_progress = on_progress or (lambda progress: None)
        self.began_s, self.before = time.monotonic(), 0  # of the work of this run; what earlier ones did

    def count(self, part: PartFile) -> None:
        """Count a part."""
        (rows, failed, _), at = read_counts(part.path), self.at
        self.at = replace(at, done=at.done + part.scenes, rows=at.rows + rows, failed=at.failed + failed)

    def tell(self, note: str = "", workers: int = 0) -> None:
        """Call the callback, with the number of workers."""
        fresh, spent = self.at.done - self.before, time.monotonic() - self.began_s
        self.at = replace(self.at, workers=workers)
        self._on_progress(replace(self.at, rate=fresh / spent if fresh and spent > 0.0 else 0.0, note=note))


def run_study(
    spec: StudySpec,
    out: str | os.PathLike[str],
    *,
    scheduler: str | None = None,
    workers: int | None = None,
    chunk: int | None = None,
    on_progress: Callable[[StudyProgress], None] | None = None,
) -> StudyStatus:
    """Solve all scenes of a study that its folder does not hold yet, and return how far it is then.

    The rows depend on the spec alone: not on the workers, nor on the size of parts. A run that was ended, in
    whatever way, is taken up by the next.

    Args:
        spec: the study.
        out: its folder; made if it is missing.
        scheduler: address of a running Dask scheduler, as in ``tcp://host:8786``; without it processes on
            this machine.
        workers: number of processes; without it one for each processor; 0 for none, which solves everything
            in this process.
        chunk: scenes of a part; without it as many as take about a second. A study that is resumed keeps
            its first size.
        on_progress: called after every part, and twice a second.

    Raises:
        UsageError: another study is in the folder, a bad option, or an extra is missing.
        ScenarioError: the parts of the spec do not fit together.
        OutputError: the folder cannot be written, or another process writes it.
        ClusterError: the scheduler is not there, or went away, or workers have another nullpose.
    """
    require_extra(*(() if scheduler is None else ("distributed",)))
    require_usage(
        scheduler is None or workers is None,
        "workers: given together with a scheduler, whose cluster has workers of its own; leave out one "
        "of the two",
    )
    require_number("workers", 0 if workers is None else workers, 0, _MOST_WORKERS)
    require_number("chunk", 1 if chunk is None else chunk, 1, MOST_IN_A_PART)
    folder, tally = Folder(Path(out)), _Tally(spec.n_scenes, on_progress)
    if not folder.has_manifest:
        require_sound(spec)
    prepare_folder(folder.path)
    with folder.locked():
        if is_new := not folder.has_manifest:
            spec = with_best_mounts(spec, tally.tell)
        else:
            folder.require_same(spec, version("nullpose"))
            spec = study_spec(folder.path)
            to_do = _resume(folder, spec, tally)
            if tally.at.done == tally.at.scenes:
                tally.tell()
                return study_status(folder.path)
        study = json.dumps(spec.to_dict()), fingerprint()
        with workers_of(scheduler, workers) as crew:
            if is_new:
                folder.write_manifest(
                    spec,
                    _size(spec, crew, study) if chunk is None else chunk,
                    {name: version(name) for name in ("nullpose", "numpy", "scipy", "numba", "pyarrow")}
                    | {"python": platform.python_version(), "code": fingerprint()},
                )
                to_do = _resume(folder, spec, tally)
            for (first, last), content in _solved(crew, study, to_do, tally):
                tally.count(folder.add(first, last, content))
    return study_status(folder.path)


def _resume(folder: Folder, spec: StudySpec, tally: _Tally) -> Iterator[Scenes]:
    """Count the sound parts of earlier runs; return the scenes of each part to do."""
    sound, damaged = folder.clean(spec)
    for part in sound:
        tally.count(part)
    tally.began_s, tally.before = time.monotonic(), tally.at.done
    if damaged:
        tally.tell(f"{damaged} part{'s' * (damaged > 1)} damaged, to be done anew")
    done = {part.first for part in sound}
    scenes, chunk = spec.n_scenes, int(folder.manifest()["chunk"])
    return ((at, min(at + chunk, scenes) - 1) for at in range(0, scenes, chunk) if at not in done)


def _solved(
    crew: Workers, study: tuple[str, str], to_do: Iterable[Scenes], tally: _Tally
) -> Iterator[tuple[Scenes, bytes]]:
    """Yield the parts as they are solved; a few are with the workers at a time, earlier scenes first."""
    queue, pending = iter(to_do), dict[Future[bytes], Scenes]()
    while True:
        tally.tell(workers=(count := crew.look()))
        # one that a worker solves, and the next; this process has solved what it is given
        for scenes in islice(queue, max(0, (2 * count or 1) - len(pending))):
            pending[crew.submit(solve_chunk, *study, *scenes)] = scenes
        if not pending:
            return
        for future in wait(pending, LOOK_S, FIRST_COMPLETED).done:
            first, last = scenes = pending.pop(future)
            try:
                content = crew.result(future)
            except BrokenExecutor:
                tally.tell(f"workers died at scenes {first} to {last}: each is tried by itself", count)
                deadly = [scene for scene in range(first, last + 1) if _is_deadly(crew, study, scene)]
                content = crew.result(crew.submit(solve_chunk, *study, first, last, deadly))
            yield scenes, content


def _is_deadly(crew: Workers, study: tuple[str, str], scene: int) -> bool:
    try:
        crew.result(crew.submit(solve_chunk, *study, scene, scene))
    except BrokenExecutor:
        return True
    return False


def _size(spec: StudySpec, crew: Workers, study: tuple[str, str]) -> int:
    """Choose the scenes of a part, which takes about a second."""
    try:
        seconds = crew.result(crew.submit(seconds_per_scene, *study))
    except BrokenExecutor:  # of a scene that will show again in its own part
        return 1
    return max(1, min(MOST_IN_A_PART, spec.n_scenes, int(_PART_S / max(seconds, 1e-9))))
