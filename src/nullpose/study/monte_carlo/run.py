"""A study run from its spec into its folder: in this process, on this machine or on a cluster."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from nullpose.errors import UsageError
from nullpose.files import prepare_folder
from nullpose.study.monte_carlo.engine import solver_of
from nullpose.study.monte_carlo.extra import require_extra
from nullpose.study.monte_carlo.ledger import Ledger, StudyProgress
from nullpose.study.monte_carlo.loading import require_sound
from nullpose.study.monte_carlo.lock import locked
from nullpose.study.monte_carlo.mounts import with_best_mounts
from nullpose.study.monte_carlo.reading import StudyStatus, study_spec, study_status
from nullpose.study.monte_carlo.spec import StudySpec, known
from nullpose.study.monte_carlo.store import Store

MOST_IN_A_PART = 5000  # scenes, however quick they are: a part is held in memory whole

_PART_S = 1.0
_MOST_WORKERS = 1024


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
        begun = store.is_begun()
        before = store.require_same(spec) if begun else {}
        spec = (
            study_spec(store.folder)
            if begun
            else with_best_mounts(spec, Ledger(spec, store, on_progress).tell)
        )
        ledger = Ledger(spec, store, on_progress)
        to_do = ledger.open(int(before["chunk"])) if begun else iter(())
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
