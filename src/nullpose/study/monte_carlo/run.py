"""A study run from its spec into its folder: in this process, on this machine or on a cluster."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from nullpose.errors import UsageError
from nullpose.files import prepare_folder
from nullpose.study.monte_carlo.chunk import Part
from nullpose.study.monte_carlo.engine import solver_of
from nullpose.study.monte_carlo.extra import require_extra
from nullpose.study.monte_carlo.loading import require_sound
from nullpose.study.monte_carlo.lock import locked
from nullpose.study.monte_carlo.reading import StudyStatus, study_status
from nullpose.study.monte_carlo.spec import StudySpec, known
from nullpose.study.monte_carlo.store import Store

__all__ = ["MOST_IN_A_PART", "Ledger", "StudyProgress", "run_study"]

MOST_IN_A_PART = 5000  # scenes, however quick they are: a part is held in memory whole

_PART_S = 1.0
_MOST_WORKERS = 1024


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyProgress:
    """How far a run is, as its callback gets it.

    Args:
        scenes: how many there are.
        done: how many are in parts, those of earlier runs too.
        rows: how many rows these have.
        failed: how many of them are failures.
        workers: threads that work; 0 while none is there.
        rate: scenes per second of this run so far; 0 before the first part.
        note: what is going on, or went wrong and was mended; empty while scenes are solved.
    """

    scenes: int
    done: int
    rows: int
    failed: int
    workers: int
    rate: float
    note: str = ""

    @property
    def seconds_left(self) -> float | None:
        """How long the rest will take at this rate; None before the first part."""
        return (self.scenes - self.done) / self.rate if self.rate > 0.0 else None


class Ledger:
    """What a run has done and has to do.

    Args:
        spec: the study.
        store: where the parts go.
        on_progress: called after every part, and when something is to be told.
    """

    def __init__(
        self, spec: StudySpec, store: Store, on_progress: Callable[[StudyProgress], None] | None
    ) -> None:
        self._store, self._on_progress = store, on_progress
        self.json = json.dumps(spec.to_dict())
        self.workers = 0
        self._at = StudyProgress(scenes=spec.n_scenes, done=0, rows=0, failed=0, workers=0, rate=0.0)
        self._began, self._before = time.monotonic(), 0

    def open(self, chunk: int) -> Iterator[tuple[int, int]]:
        """Take up what earlier runs have done; return the first and the last scene of each part to do.

        Args:
            chunk: scenes of a part.

        Raises:
            OutputError: the folder cannot be written.
        """
        parts, redone = self._store.mend()
        scenes = self._at.scenes
        kept = {part.first: part for part in parts if part.last < scenes}
        for part in kept.values():
            self._count(part)
        self._began, self._before = time.monotonic(), self._at.done
        if redone:
            self.tell(f"{redone} part{'s' * (redone > 1)} damaged or missing, to be done anew")
        to_do = (first for first in range(0, scenes, chunk) if first not in kept)
        return ((first, min(first + chunk, scenes) - 1) for first in to_do)

    @property
    def is_complete(self) -> bool:
        """Whether nothing is to do."""
        return self._at.done == self._at.scenes

    def add(self, part: Part, content: bytes) -> None:
        """Keep a part, on disk before it counts.

        Args:
            part: from a worker.
            content: of its file.

        Raises:
            OutputError: it cannot be written.
        """
        self._store.add(part, content)
        self._count(part)
        self.tell()

    def tell(self, note: str = "") -> None:
        """Say how far the run is.

        Args:
            note: what is going on besides.
        """
        fresh, spent = self._at.done - self._before, time.monotonic() - self._began
        rate = fresh / spent if fresh and spent > 0.0 else 0.0
        if self._on_progress is not None:
            self._on_progress(replace(self._at, workers=self.workers, rate=rate, note=note))

    def _count(self, part: Part) -> None:
        done, rows, failed = self._at.done, self._at.rows, self._at.failed
        self._at = replace(
            self._at, done=done + part.scenes, rows=rows + part.rows, failed=failed + part.failed
        )


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
        scheduler: address of a running Dask scheduler, as in ``tcp://host:8786``; without it an embedded
            cluster on this machine.
        workers: processes of the embedded cluster; without it one for each processor; 0 for none, which
            solves everything in this process.
        chunk: scenes of a part; without it so many as take about a second. A study that is resumed keeps
            the size it was begun with.
        on_progress: called after every part.

    Raises:
        UsageError: another study is in the folder, a bad option, an extra is missing, or workers with
            another nullpose.
        ScenarioError: the parts of the spec do not fit together.
        OutputError: the folder cannot be written, or another client writes it.
        ClusterError: the scheduler is not there, or went away.
    """
    require_extra()
    if scheduler is not None and workers is not None:
        raise UsageError(
            "workers: given together with a scheduler, whose cluster has workers of its own; leave out "
            "one of the two"
        )
    known("workers", 0 if workers is None else workers, 0, _MOST_WORKERS)
    known("chunk", 1 if chunk is None else chunk, 1, MOST_IN_A_PART)
    store = Store(Path(out))
    if not store.is_begun():
        require_sound(spec)
    with locked(prepare_folder(store.folder)):
        ledger = Ledger(spec, store, on_progress)
        begun = store.is_begun()
        to_do = ledger.open(int(store.require_same(spec)["chunk"])) if begun else iter(())
        if begun and ledger.is_complete:
            ledger.tell()
            return study_status(store.folder)
        with solver_of(ledger, scheduler, workers) as solver:
            if not begun:
                size = _size(spec, solver.seconds_per_scene()) if chunk is None else chunk
                store.begin(spec, size)
                to_do = ledger.open(size)
            for part, content in solver.solved(to_do):
                ledger.add(part, content)
    return study_status(store.folder)


def _size(spec: StudySpec, seconds: float) -> int:
    """Return the scenes of a part that takes about a second, given how long one takes."""
    return max(1, min(MOST_IN_A_PART, spec.n_scenes, int(_PART_S / max(seconds, 1e-9))))
