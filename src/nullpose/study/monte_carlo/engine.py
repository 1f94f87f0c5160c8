"""Who solves the parts of a study: this process, or a cluster that is handed a few at a time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from typing import TYPE_CHECKING, Any

from nullpose.errors import ClusterError
from nullpose.study.monte_carlo.chunk import Part, seconds_per_scene, solve_chunk
from nullpose.study.monte_carlo.cluster import connected
from nullpose.study.monte_carlo.versions import fingerprint

if TYPE_CHECKING:
    from distributed import Client, Future

    from nullpose.study.monte_carlo.ledger import Ledger

_IN_FLIGHT = 2  # parts for each worker's thread: one at work and one in store
_LOOK_S = 0.5  # between two looks at the cluster


@contextmanager
def solver_of(ledger: Ledger, scheduler: str | None, workers: int | None) -> Iterator[_Here | _Cluster]:
    """Yield what solves a study's parts.

    Args:
        ledger: of the study; it is told what goes on.
        scheduler: address of a running scheduler; None for an embedded cluster.
        workers: processes of the embedded cluster; None for one on each processor, 0 for this process alone.

    Raises:
        ClusterError: no scheduler answers, it went away, or its workers cannot do the work.
    """
    if workers == 0:
        yield _Here(ledger)
        return
    with connected(scheduler, workers) as client:
        yield _Cluster(client, ledger, scheduler or "this machine")


class _Here:
    """This process, one part after the other."""

    def __init__(self, ledger: Ledger) -> None:
        self._study = ledger.json, fingerprint()
        ledger.workers = 1

    def seconds_per_scene(self) -> float:
        """Return how long a scene takes."""
        return seconds_per_scene(*self._study)

    def solved(self, parts: Iterable[tuple[int, int]]) -> Iterator[tuple[Part, bytes]]:
        """Yield what is made of parts, given by their first and last scene, as they are done."""
        return (solve_chunk(*self._study, *part) for part in parts)


class _Cluster:
    """The workers of a cluster."""

    def __init__(self, client: Client, ledger: Ledger, where: str) -> None:
        self._client, self._ledger, self._where = client, ledger, where
        self._look()

    def seconds_per_scene(self) -> float:
        future = self._alone(seconds_per_scene)
        # A scene that no worker survives will show again at its own part.
        return math.inf if _is_killed(future) else float(self._result(future))

    def solved(self, parts: Iterable[tuple[int, int]]) -> Iterator[tuple[Part, bytes]]:
        to_do, pending = iter(parts), dict[Any, tuple[int, int]]()
        while True:
            wanted = max(0, _IN_FLIGHT * max(1, self._ledger.workers) - len(pending))
            # Earlier parts first: what a run leaves behind has no holes but those of its last seconds.
            for part in islice(to_do, wanted):
                pending[self._submit(solve_chunk, *part, priority=-part[0])] = part
            if not pending:
                return
            for future in self._first_done(pending):
                yield self._done(future, *pending.pop(future))
            if time.monotonic() - self._looked > _LOOK_S:
                self._look()

    def _submit(self, function: Callable[..., Any], *scenes: Any, priority: int = 0) -> Future:
        study = self._ledger.json, fingerprint()
        return self._client.submit(function, *study, *scenes, pure=False, priority=priority)

    def _alone(self, function: Callable[..., Any], *scenes: Any) -> Future:
        """Return what is asked of a worker once it is done, waiting for it."""
        (future,) = self._first_done([self._submit(function, *scenes)])
        return future

    def _first_done(self, futures: Iterable[Future]) -> Collection[Future]:
        """Return those futures that are done first, looking at the cluster now and then."""
        from distributed import CancelledError, wait

        while True:
            try:
                with self._client.as_current():
                    done: set[Future] = wait(list(futures), _LOOK_S, "FIRST_COMPLETED").done
                return done
            except TimeoutError:
                self._look()
            except CancelledError as error:
                raise self._lost() from error

    def _done(self, future: Future, first: int, last: int) -> tuple[Part, bytes]:
        """Return what a worker made of a part; one whose workers died is done without the scenes at fault."""
        if _is_killed(future):
            self._ledger.tell(f"workers died at scenes {first} to {last}: each is tried by itself")
            scenes = range(first, last + 1)
            deadly = [scene for scene in scenes if _is_killed(self._alone(solve_chunk, scene, scene))]
            future = self._alone(solve_chunk, first, last, deadly)
        part, content = self._result(future)
        return part, content

    def _result(self, future: Future) -> Any:
        if future.status == "error":
            error = future.exception()
            if isinstance(error, ClusterError):
                raise error
            raise ClusterError(
                f"workers: those at {self._where} cannot do the work ({type(error).__name__}: {error}); they "
                "need nullpose[study] as it is here: install it and start them again"
            ) from error
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


def _is_killed(future: Future) -> bool:
    """Return whether every worker that took a part died."""
    from distributed import KilledWorker

    return future.status == "error" and isinstance(future.exception(), KilledWorker)
