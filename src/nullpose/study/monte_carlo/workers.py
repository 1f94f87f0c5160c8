"""Who solves the parts of a study: this process, a pool of processes, or a Dask cluster that runs already."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager, suppress
from functools import partial
from multiprocessing import get_context
from typing import TYPE_CHECKING, TypeVar

from nullpose.errors import ClusterError
from nullpose.solver.worker_pool import processors
from nullpose.study.monte_carlo.chunk import fingerprint
from nullpose.study.monte_carlo.processes import at_starting_processes, end_with

if TYPE_CHECKING:
    from distributed import Client

Answer = TypeVar("Answer")

LOOK_S = 0.5  # between two looks at the workers

_CONNECT_S = 5.0  # how long a scheduler has to answer


class Workers:
    """Those who solve the parts: an executor, which is begun anew after one of its processes died.

    Args:
        place: where they are, in messages.
        count: how many there are, the cluster's being counted; 0 for this process.
        begin: makes the executor; None for this process, which works at once.
        client: of a Dask cluster, whose workers come and go.
    """

    def __init__(
        self,
        place: str,
        count: int = 0,
        begin: Callable[[], Executor] | None = None,
        client: Client | None = None,
    ) -> None:
        self._place, self._count, self._begin, self._client = place, count, begin, client
        self._looked_s, self._executor = -LOOK_S, begin and begin()

    def look(self) -> int:
        """Count them.

        Raises:
            ClusterError: the cluster is gone.
        """
        if self._client is not None and time.monotonic() - self._looked_s >= LOOK_S:
            threads = None
            with suppress(OSError):
                threads = self._client.nthreads() if self._client.status == "running" else None
            if threads is None:
                raise self._lost()
            self._count, self._looked_s = sum(threads.values()), time.monotonic()
        return self._count

    def submit(self, function: Callable[..., Answer], *arguments: object) -> Future[Answer]:
        """Begin some work."""
        if self._begin is None or self._executor is None:
            future = Future[Answer]()
            future.set_result(function(*arguments))
            return future
        # a process may be started by this; none of them hears Ctrl-C
        with at_starting_processes():
            try:
                return self._executor.submit(function, *arguments)
            except BrokenExecutor:
                self._executor.shutdown()
                self._executor = self._begin()
                return self._executor.submit(function, *arguments)

    def end(self) -> None:
        """End all processes, once what watches them has let them go."""
        if self._executor is not None:
            self._executor.shutdown(cancel_futures=True)

    def result(self, future: Future[Answer]) -> Answer:
        """Wait for work that was submitted.

        Raises:
            BrokenExecutor: every worker that took it died.
            ClusterError: the workers are gone, or cannot do it.
        """
        while not wait([future], LOOK_S).done:
            self.look()
        try:
            return future.result()
        except (ClusterError, BrokenExecutor):
            raise
        except (CancelledError, OSError) as error:
            raise self._lost() from error
        except Exception as error:
            if type(error).__name__ == "KilledWorker":  # that of Dask
                raise BrokenExecutor from error
            raise ClusterError(
                f"workers: those at {self._place} cannot do the work ({type(error).__name__}: {error}); they "
                "need nullpose and its extra study as it is here: install it and start them again"
            ) from error

    def _lost(self) -> ClusterError:
        """Make the error of a scheduler that went away."""
        return ClusterError(
            f"scheduler: the one at {self._place} went away; the parts so far are kept, and the same command "
            "goes on from there once it is back (or without --scheduler, on this machine)"
        )


@contextmanager
def workers_of(scheduler: str | None, workers: int | None) -> Iterator[Workers]:
    """Have workers in the block.

    Args:
        scheduler: address of a Dask scheduler that runs; None for this machine.
        workers: processes on this machine; None for one on each processor, 0 for this process alone.

    Raises:
        ClusterError: no scheduler answers, or no process can be started.
    """
    if scheduler is not None:
        with _connected(scheduler) as client:
            yield Workers(scheduler, begin=partial(client.get_executor, pure=False), client=client)
    elif workers == 0:
        yield Workers("this machine")
    else:
        with _processes(workers or processors()) as crew:
            yield crew


@contextmanager
def _processes(count: int) -> Iterator[Workers]:
    """Have a pool of processes in the block, all of which end with it at once, whatever they do."""
    context = get_context("spawn")  # forked processes would share the locks of numba's threads
    watched, lifeline = context.Pipe(duplex=False)
    crew = Workers("this machine", count, partial(ProcessPoolExecutor, count, context, end_with, (watched,)))
    try:
        crew.result(crew.submit(fingerprint))
    except BrokenExecutor as error:
        raise ClusterError(
            "workers: no process can be started on this machine; in a script call run_study under "
            'if __name__ == "__main__":, or give workers=0 (--workers 0)'
        ) from error
    else:
        yield crew
    finally:
        with at_starting_processes():
            lifeline.close()
            crew.end()
            watched.close()


@contextmanager
def _connected(scheduler: str) -> Iterator[Client]:
    import dask

    quiet = dict.fromkeys(("distributed", "distributed.client", "tornado.application", "asyncio"), "critical")
    with dask.config.set(logging=quiet):  # read by the first import
        from distributed import Client
    try:
        # A client that cannot connect takes long to be given up: this tells sooner. In a thread of its own,
        # since a notebook has a loop running in this one.
        with ThreadPoolExecutor(1) as pool:
            pool.submit(lambda: asyncio.run(_reach(scheduler))).result()
        client = Client(scheduler, timeout=_CONNECT_S, set_as_default=False)
    except Exception as error:
        reason = (str(error).strip() or type(error).__name__).splitlines()[0]
        raise ClusterError(
            f"scheduler: no Dask scheduler answers at {scheduler} ({reason}); check the address "
            "(as in tcp://host:8786) and that it runs: dask scheduler on its machine, dask worker "
            f"{scheduler} --nthreads 1 on the others; or leave it out to use this machine"
        ) from error
    try:
        yield client
    finally:
        with suppress(Exception):  # the scheduler may be gone, and all parts are written
            client.close(timeout=2)


async def _reach(scheduler: str) -> None:
    from distributed import Security
    from distributed.comm import connect

    # the certificate that Dask's configuration names, which a tls:// address needs
    await (await connect(scheduler, timeout=_CONNECT_S, **Security().get_connection_args("client"))).close()
