"""Parts handed to a cluster's workers, a few at a time, and taken back as they are done."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from nullpose.errors import ClusterError
from nullpose.study.monte_carlo.chunk import (
    Done,
    failed_rows,
    joined,
    packed,
    seconds_per_scene,
    solve_chunk,
)
from nullpose.study.monte_carlo.cluster import connected
from nullpose.study.monte_carlo.ledger import Ledger
from nullpose.study.monte_carlo.versions import fingerprint

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["KILLED", "run_on_cluster"]

KILLED = "every worker that took this scene died; it may need more memory than they have"
"""The reason of the rows of a scene that no worker survives."""

_IN_FLIGHT = 2  # parts for each worker's thread: one at work and one in store
_LOOK_S = 0.5  # between two looks at the cluster


def run_on_cluster(
    ledger: Ledger,
    begin: Callable[[Callable[[], float]], None],
    scheduler: str | None,
    workers: int | None,
) -> None:
    """Solve what is to do on a cluster.

    Args:
        ledger: what is to do.
        begin: opens the ledger, given what tells how long a scene takes.
        scheduler: address of a running scheduler; None for an embedded cluster.
        workers: processes of the embedded cluster; None for one on each processor.

    Raises:
        ClusterError: no scheduler answers, it went away, or its workers cannot do the work.
        OutputError: a part cannot be written.
    """
    if not ledger.is_open or not ledger.is_complete:
        with connected(scheduler, workers) as client:
            dispatch = _Dispatch(client, ledger, scheduler)
            dispatch.require_same_code()
            begin(dispatch.seconds_per_scene)
            dispatch.run()


class _Dispatch:
    """The parts in flight."""

    def __init__(self, client: Client, ledger: Ledger, scheduler: str | None) -> None:
        self._client, self._ledger = client, ledger
        self._where = scheduler or "this machine"
        self._finished: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._pending: dict[str, tuple[Future, int, int]] = {}
        self._looked = 0.0

    def require_same_code(self) -> None:
        """Raise a ClusterError if the workers that are there have no nullpose, or another one."""
        self._look()
        try:
            found = self._client.run(fingerprint, on_error="return")
        except Exception as error:
            raise self._unable(error) from error
        for address, other in found.items():
            if isinstance(other, Exception):
                raise self._unable(other) from other
            self._require(address, other)

    def seconds_per_scene(self) -> float:
        """Return how long a scene takes on a worker."""
        future = self._client.submit(seconds_per_scene, self._ledger.json, pure=False)
        self._wait(future)
        if future.status == "error":  # whatever it is, it will show again at the scene's own part
            return float("inf")
        return float(self._result(future))

    def run(self) -> None:
        """Hand out what is to do, and keep what comes back."""
        to_do = self._ledger.to_do()
        while True:
            for first, last in to_do:
                self._submit(first, last)
                if len(self._pending) >= _IN_FLIGHT * max(1, self._ledger.workers):
                    break
            if not self._pending:
                return
            self._take()

    def _submit(self, first: int, last: int) -> None:
        arguments = (self._ledger.json, self._ledger.fingerprint, first, last)
        # Earlier parts first: what a run leaves behind has no holes but those of its last seconds.
        future = self._client.submit(solve_chunk, *arguments, pure=False, priority=-first)
        self._pending[future.key] = (future, first, last)
        future.add_done_callback(lambda done: self._finished.put(done.key))

    def _take(self) -> None:
        """Keep the next part that is done, looking at the cluster now and then."""
        try:
            key = self._finished.get(timeout=_LOOK_S)
        except queue.Empty:
            self._look()
            return
        future, first, last = self._pending.pop(key)
        self._ledger.add(self._done(future, first, last))
        if time.monotonic() - self._looked > _LOOK_S:
            self._look()

    def _done(self, future: Future, first: int, last: int) -> Done:
        """Return what a worker made of a part."""
        from distributed import KilledWorker

        if future.status == "error":
            error = future.exception()
            if isinstance(error, KilledWorker):
                return self._one_by_one(first, last)
            raise self._unable(error) from error
        done: Done = self._result(future)
        self._require("a worker", done.fingerprint)
        if done.fault:
            raise ClusterError(f"workers: scenes {first} to {last} cannot be worked on: {done.fault}")
        return done

    def _one_by_one(self, first: int, last: int) -> Done:
        """Return the rows of a part whose workers died, each scene by itself, to lose only those at fault."""
        from distributed import KilledWorker

        spec = self._ledger.spec
        self._ledger.tell(f"workers died at scenes {first} to {last}: each is tried by itself")
        pieces = []
        for index in range(first, last + 1):
            arguments = (self._ledger.json, self._ledger.fingerprint, index, index)
            future = self._client.submit(solve_chunk, *arguments, pure=False, priority=-first)
            self._wait(future)
            if future.status == "error" and isinstance(future.exception(), KilledWorker):
                rows = [
                    row
                    for point in range(len(spec.points))
                    for row in failed_rows(spec, index, point, KILLED)
                ]
                pieces.append(packed(spec, rows, index, index, 0.0))
            else:
                pieces.append(self._done(future, index, index))
        return joined(pieces)

    def _wait(self, future: Future) -> None:
        """Wait until a future is done, looking at the cluster now and then."""
        ready: queue.SimpleQueue[str] = queue.SimpleQueue()
        future.add_done_callback(lambda done: ready.put(done.key))
        while True:
            try:
                ready.get(timeout=_LOOK_S)
            except queue.Empty:
                self._look()
            else:
                return

    def _result(self, future: Future) -> Any:
        if future.status != "finished":
            raise self._lost()
        try:
            return future.result(timeout=60)
        except OSError as error:  # a lost connection, or no answer in time
            raise self._lost() from error

    def _look(self) -> None:
        """See who works, and whether the scheduler is still there."""
        self._looked = time.monotonic()
        if self._client.status != "running":
            raise self._lost()
        try:
            threads = self._client.nthreads()
        except OSError as error:
            raise self._lost() from error
        before, self._ledger.workers = self._ledger.workers, sum(threads.values())
        if not threads:
            self._ledger.tell(f"no worker at {self._where} yet: waiting for one")
        elif before != self._ledger.workers:
            crowded = max(threads.values()) > 1
            hint = " (some have several threads; dask worker --nthreads 1 is faster)" if crowded else ""
            self._ledger.tell(f"{len(threads)} worker{'s' * (len(threads) > 1)}{hint}")

    def _lost(self) -> ClusterError:
        return ClusterError(
            f"scheduler: the one at {self._where} went away; the parts so far are kept, and the same command "
            "goes on from there once it is back (or without --scheduler, on this machine)"
        )

    def _require(self, address: str, other: str) -> None:
        if other != self._ledger.fingerprint:
            raise ClusterError(
                f"workers: {address} at {self._where} has nullpose {other}, and here it is "
                f"{self._ledger.fingerprint}; install the same on both and start the workers again"
            )

    def _unable(self, error: BaseException | None) -> ClusterError:
        return ClusterError(
            f"workers: those at {self._where} cannot do the work ({type(error).__name__}: {error}); they "
            "need nullpose[study] as it is here: install it and start them again"
        )
