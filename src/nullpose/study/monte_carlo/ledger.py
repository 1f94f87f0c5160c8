"""What a run has done and has to do, and how it tells."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from nullpose.study.monte_carlo.chunk import Part
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.store import Store


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
