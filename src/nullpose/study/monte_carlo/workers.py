"""Who solves the parts of a study: this process, a pool of processes, or a Dask cluster that runs already."""

from __future__ import annotations

import asyncio
import logging
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
from contextlib import ExitStack, contextmanager, suppress
from multiprocessing import get_context
from typing import TYPE_CHECKING, TypeVar

from nullpose.errors import ClusterError
from nullpose.solver.worker_pool import processors
from nullpose.study.monte_carlo.chunk import fingerprint
from nullpose.study.monte_carlo.processes import end_with, environment, interrupts_put_off

if TYPE_CHECKING:
    from distributed import Client

Answer = TypeVar("Answer")
OnLook = Callable[[int, str], None]  # called with the number of workers and a note, which may be empty

LOOK_S = 0.5  # between two looks at the workers

_CONNECT_S = 5.0  # how long a scheduler has to answer

# Libraries would start more threads in each worker.
_ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)


class WorkerDiedError(Exception):
    """A worker that died of its work."""


class _ThisProcess(Executor):
    """This process alone, which works at once."""

    def submit(self, function: Callable[..., Answer], /, *arguments: object) -> Future[Answer]:  # type: ignore[override]
        future: Future[Answer] = Future()
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future


class _LocalProcesses(Executor):
    """Processes on this machine: new ones after one died; all end when the other end of a pipe is closed."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._watched, self._lifeline = get_context("spawn").Pipe(duplex=False)
        self._processes = self._started()

    def _started(self) -> Executor:
        # forked processes would share the locks of numba's threads
        return ProcessPoolExecutor(self._count, get_context("spawn"), end_with, (self._watched,))

    def submit(self, function: Callable[..., Answer], /, *arguments: object) -> Future[Answer]:  # type: ignore[override]
        # a process may be started by this; none of them hears Ctrl-C
        with interrupts_put_off(), environment(_ONE_THREAD):
            try:
                return self._processes.submit(function, *arguments)
            except BrokenExecutor:
                self._processes.shutdown()
                self._processes = self._started()
                return self._processes.submit(function, *arguments)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End all processes at once, whatever they do."""
        with interrupts_put_off():
            self._lifeline.close()
            self._processes.shutdown(cancel_futures=True)
            self._watched.close()


class Workers:
    """An executor, and what may happen to those that work for it.

    Args:
        executor: to which work is submitted.
        place: in messages.
        on_look: called with the number of workers and a note.
        count: the number of workers.
        ahead: parts that are with a worker at a time: one that it solves, and the next.
        client: of a Dask cluster, whose workers come and go.
    """

    def __init__(
        self,
        executor: Executor,
        place: str,
        on_look: OnLook,
        *,
        count: int = 1,
        ahead: int = 2,
        client: Client | None = None,
    ) -> None:
        self.executor, self.count = executor, count
        self._place, self._on_look, self.ahead = place, on_look, ahead
        self._client, self._looked_s = client, -LOOK_S
        self.look()

    def look(self) -> None:
        """Look whether the workers are there.

        Raises:
            ClusterError: they are not.
        """
        note = ""
        if self._client is not None:
            if self._client.status != "running":
                raise self._lost()
            if time.monotonic() - self._looked_s < LOOK_S:
                return
            try:
                threads = self._client.nthreads()
            except OSError as error:
                raise self._lost() from error
            before, self.count, self._looked_s = self.count, sum(threads.values()), time.monotonic()
            if not threads:
                note = f"no worker at {self._place} yet: waiting for one"
            elif before != self.count:
                crowded = max(threads.values()) > 1
                hint = " (some have several threads; dask worker --nthreads 1 is faster)" if crowded else ""
                note = f"{len(threads)} worker{'s' * (len(threads) > 1)}{hint}"
        self._on_look(self.count, note)

    def outcome(self, function: Callable[..., Answer], *arguments: object) -> Answer:
        """Submit work and wait for it, as :meth:`result` does."""
        return self.result(self.executor.submit(function, *arguments))

    def result(self, future: Future[Answer]) -> Answer:
        """Wait for work that was submitted.

        Raises:
            WorkerDiedError: every worker that took it died.
            ClusterError: the workers are gone, or cannot do it.
        """
        while not wait([future], LOOK_S).done:
            self.look()
        try:
            return future.result()
        except ClusterError:
            raise
        except (CancelledError, OSError) as error:
            raise self._lost() from error
        except Exception as error:
            if isinstance(error, BrokenExecutor) or type(error).__name__ == "KilledWorker":  # that of Dask
                raise WorkerDiedError from error
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
def workers_of(scheduler: str | None, workers: int | None, on_look: OnLook) -> Iterator[Workers]:
    """Have workers in the block.

    Args:
        scheduler: address of a Dask scheduler that runs; None for this machine.
        workers: processes on this machine; None for one on each processor, 0 for this process alone.
        on_look: called with the number of workers and a note, which may be empty.

    Raises:
        ClusterError: no scheduler answers, or no process can be started.
    """
    if scheduler is not None:
        with _quiet(), _connected(scheduler) as client:
            yield Workers(client.get_executor(pure=False), scheduler, on_look, count=-1, client=client)
    elif workers == 0:
        yield Workers(_ThisProcess(), "this machine", on_look, ahead=1)
    else:
        count = workers or processors()
        with _LocalProcesses(count) as pool:
            crew = Workers(pool, "this machine", on_look, count=count)
            try:
                crew.outcome(fingerprint)
            except WorkerDiedError as error:
                raise ClusterError(
                    "workers: no process can be started on this machine; in a script call run_study under "
                    'if __name__ == "__main__":, or give workers=0 (--workers 0)'
                ) from error
            yield crew


@contextmanager
def _connected(scheduler: str) -> Iterator[Client]:
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


_LOGGERS = ("distributed", "tornado", "asyncio")


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep log lines of Dask, and of what it runs on, off the terminal."""
    import distributed  # noqa: F401  its import sets up its loggers

    with ExitStack() as afterwards:
        for name in [name for name in logging.root.manager.loggerDict if name.split(".")[0] in _LOGGERS]:
            logger = logging.getLogger(name)
            afterwards.callback(logger.setLevel, logger.level)
            logger.setLevel(logging.CRITICAL + 1)
        yield
