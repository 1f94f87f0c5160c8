"""Who solves the parts of a study: this process, or a cluster that is handed a few at a time."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

from nullpose.errors import ClusterError
from nullpose.study.monte_carlo.chunk import Done, seconds_per_scene, solve_chunk
from nullpose.study.monte_carlo.ledger import Ledger
from nullpose.study.monte_carlo.versions import fingerprint

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["Solver", "solver_of"]

_IN_FLIGHT = 2  # parts for each worker's thread: one at work and one in store
_LOOK_S = 0.5  # between two looks at the cluster


class Solver(Protocol):
    """What solves parts."""

    def seconds_per_scene(self) -> float:
        """Return how long a scene takes."""

    def solved(self, parts: Iterable[tuple[int, int]]) -> Iterator[Done]:
        """Yield what is made of parts, given by their first and last scene, as they are done.

        Raises:
            ClusterError: they cannot be worked on.
        """


@contextmanager
def solver_of(ledger: Ledger, scheduler: str | None, workers: int | None) -> Iterator[Solver]:
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
    from nullpose.study.monte_carlo.cluster import connected

    with connected(scheduler, workers) as client:
        cluster = _Cluster(client, ledger, scheduler or "this machine")
        cluster.require_same_code()
        yield cluster


def _sound(done: Done, first: int, last: int) -> Done:
    """Return what was made of a part, if something was."""
    if done.fault:
        raise ClusterError(f"workers: scenes {first} to {last} cannot be worked on: {done.fault}")
    return done


class _Here:
    """This process, one part after the other."""

    def __init__(self, ledger: Ledger) -> None:
        self._ledger = ledger
        ledger.workers = 1

    def seconds_per_scene(self) -> float:
        return seconds_per_scene(self._ledger.json)

    def solved(self, parts: Iterable[tuple[int, int]]) -> Iterator[Done]:
        for part in parts:
            yield _sound(solve_chunk(self._ledger.json, fingerprint(), *part), *part)


class _Cluster:
    """The workers of a cluster."""

    def __init__(self, client: Client, ledger: Ledger, where: str) -> None:
        self._client, self._ledger, self._where = client, ledger, where
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
        future = self._client.submit(seconds_per_scene, self._ledger.json, pure=False)
        self._first_done([future])
        if future.status == "error":  # whatever it is, it will show again at the scene's own part
            return float("inf")
        return float(self._result(future))

    def solved(self, parts: Iterable[tuple[int, int]]) -> Iterator[Done]:
        to_do, pending = iter(parts), dict[Any, tuple[int, int]]()
        while True:
            while len(pending) < _IN_FLIGHT * max(1, self._ledger.workers):
                part = next(to_do, None)
                if part is None:
                    break
                pending[self._submit(*part)] = part
            if not pending:
                return
            for future in self._first_done(pending):
                yield self._done(future, *pending.pop(future))
            if time.monotonic() - self._looked > _LOOK_S:
                self._look()

    def _submit(self, first: int, last: int, deadly: Collection[int] = ()) -> Future:
        arguments = (self._ledger.json, fingerprint(), first, last, deadly)
        # Earlier parts first: what a run leaves behind has no holes but those of its last seconds.
        return self._client.submit(solve_chunk, *arguments, pure=False, priority=-first)

    def _first_done(self, futures: Iterable[Future]) -> Collection[Future]:
        """Return those futures that are done first, looking at the cluster now and then."""
        from distributed import CancelledError, wait

        while True:
            try:
                with self._client.as_current():
                    done: set[Future] = wait(list(futures), _LOOK_S, "FIRST_COMPLETED").done
            except TimeoutError:
                self._look()
            except CancelledError as error:
                raise self._lost() from error
            else:
                return done

    def _done(self, future: Future, first: int, last: int) -> Done:
        """Return what a worker made of a part; one whose workers died is done without the scenes at fault."""
        if _is_killed(future):
            self._ledger.tell(f"workers died at scenes {first} to {last}: each is tried by itself")
            deadly = []
            for index in range(first, last + 1):
                alone = self._submit(index, index)
                self._first_done([alone])
                if _is_killed(alone):
                    deadly.append(index)
            future = self._submit(first, last, deadly)
            self._first_done([future])
        if future.status == "error":
            error = future.exception()
            raise self._unable(error) from error
        done: Done = self._result(future)
        self._require("a worker", done.fingerprint)
        return _sound(done, first, last)

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
        if other != fingerprint():
            raise ClusterError(
                f"workers: {address} at {self._where} has nullpose {other}, and here it is {fingerprint()}; "
                "install the same on both and start the workers again"
            )

    def _unable(self, error: BaseException | None) -> ClusterError:
        return ClusterError(
            f"workers: those at {self._where} cannot do the work ({type(error).__name__}: {error}); they "
            "need nullpose[study] as it is here: install it and start them again"
        )


def _is_killed(future: Future) -> bool:
    """Return whether every worker that took a part died."""
    from distributed import KilledWorker

    return future.status == "error" and isinstance(future.exception(), KilledWorker)
