"""Which parts of a study are done and which are to do, and how far that is."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator

from nullpose.study.monte_carlo.chunk import Done, Part
from nullpose.study.monte_carlo.progress import StudyProgress
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.store import Store

__all__ = ["Ledger"]


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
        self.spec, self._store, self._on_progress = spec, store, on_progress
        self.json = json.dumps(spec.to_dict())
        self.workers = 0
        self._chunk = 1
        self._finished = bytearray()  # a byte for each part: there may be millions
        self._done = self._rows = self._failed = self._before = 0
        self._began = time.monotonic()

    def open(self, chunk: int) -> None:
        """Take up what earlier runs have done.

        Args:
            chunk: scenes of a part.

        Raises:
            OutputError: the folder cannot be written.
        """
        self._chunk = chunk
        self._finished = bytearray(-(-self.spec.n_scenes // chunk))
        kept, redone = self._store.mend()
        for part in kept:
            if part.last < self.spec.n_scenes:
                self._count(part)
        self._began, self._before = time.monotonic(), self._done
        if redone:
            self.tell(f"{redone} part{'s' * (redone > 1)} damaged or missing, to be done anew")

    @property
    def is_complete(self) -> bool:
        """Whether nothing is to do."""
        return self._done == self.spec.n_scenes

    def to_do(self) -> Iterator[tuple[int, int]]:
        """Yield the first and the last scene of each part that is to do."""
        for number, finished in enumerate(self._finished):
            if not finished:
                first = number * self._chunk
                yield first, min(first + self._chunk, self.spec.n_scenes) - 1

    def add(self, done: Done) -> None:
        """Keep a part, on disk before it counts.

        Args:
            done: from a worker.

        Raises:
            OutputError: it cannot be written.
        """
        self._count(self._store.add(done))
        self.tell()

    def tell(self, note: str = "") -> None:
        """Say how far the run is.

        Args:
            note: what is going on besides.
        """
        if self._on_progress is None:
            return
        fresh, spent = self._done - self._before, time.monotonic() - self._began
        self._on_progress(
            StudyProgress(
                scenes=self.spec.n_scenes,
                done=self._done,
                rows=self._rows,
                failed=self._failed,
                workers=self.workers,
                rate=fresh / spent if fresh and spent > 0.0 else 0.0,
                note=note,
            )
        )

    def _count(self, part: Part) -> None:
        self._finished[part.first // self._chunk] = 1
        self._done += part.scenes
        self._rows += part.rows
        self._failed += part.failed
