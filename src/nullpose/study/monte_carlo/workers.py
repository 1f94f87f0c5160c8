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

_IN_FLIGHT = 2  # parts for each worker: one that it solves, and the next
_CONNECT_S = 5.0  # how long a scheduler has to answer

# Libraries would start more threads in each worker.
_ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)


class WorkerDiedError(Exception):
    """A worker that died of its work."""


class Workers:
    """An executor, and what may happen to it.

    Args:
        place: in messages.
        on_look: called with the number of workers.
    """

    deaths: tuple[type[Exception], ...] = ()
    _executor: Executor

    def __init__(self, place: str, on_look: OnLook) -> None:
        self._place, self._on_look = place, on_look
        self.count = 1

    @property
    def in_flight(self) -> int:
        """Number of parts that are submitted at a time."""
        return _IN_FLIGHT * max(1, self.count)

    def submit(self, function: Callable[..., Answer], *arguments: object) -> Future[Answer]:
        """Submit work."""
        return self._executor.submit(function, *arguments)

    def look(self) -> None:
        """Look whether the workers are there.

        Raises:
            ClusterError: they are not.
        """
        self._on_look(self.count, "")

    def renew(self) -> None:
        """Replace workers after one died."""

    def outcome(self, future: Future[Answer]) -> Answer:
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
        except self.deaths as error:
            self.renew()
            raise WorkerDiedError from error
        except (CancelledError, OSError) as error:
            raise self.lost() from error
        except Exception as error:
            raise ClusterError(
                f"workers: those at {self._place} cannot do the work ({type(error).__name__}: {error}); they "
                "need nullpose and its extra study as it is here: install it and start them again"
            ) from error

    def lost(self) -> ClusterError:
        """Make the error of a scheduler that went away."""
        return ClusterError(
            f"scheduler: the one at {self._place} went away; the parts so far are kept, and the same command "
            "goes on from there once it is back (or without --scheduler, on this machine)"
        )


class _Alone(Workers):
    """This process alone, which works at once."""

    in_flight = 1

    def submit(self, function: Callable[..., Answer], *arguments: object) -> Future[Answer]:
        future: Future[Answer] = Future()
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future


class _Pool(Workers):
    """Worker processes on this machine, which end when the other end of a pipe is closed."""

    deaths = (BrokenExecutor,)

    def __init__(self, count: int, on_look: OnLook) -> None:
        self._size = count
        self._watched, self._lifeline = get_context("spawn").Pipe(duplex=False)
        super().__init__("this machine", on_look)
        self._executor, self.count = self._started(), count

    def _started(self) -> Executor:
        # forked processes would share the locks of numba's threads
        return ProcessPoolExecutor(self._size, get_context("spawn"), end_with, (self._watched,))

    def submit(self, function: Callable[..., Answer], *arguments: object) -> Future[Answer]:
        # a process may be started by this; none of them hears Ctrl-C
        with interrupts_put_off(), environment(_ONE_THREAD):
            try:
                return super().submit(function, *arguments)
            except BrokenExecutor:
                self.renew()
                return super().submit(function, *arguments)

    def renew(self) -> None:
        with interrupts_put_off():
            self._executor.shutdown()
            self._executor = self._started()

    def end(self) -> None:
        """End all processes at once, whatever they do."""
        with interrupts_put_off():
            self._lifeline.close()
            self._executor.shutdown(cancel_futures=True)
            self._watched.close()


class _Cluster(Workers):
    """The workers of a Dask cluster, which come and go."""

    def __init__(self, client: Client, place: str, on_look: OnLook) -> None:
        from distributed import KilledWorker

        super().__init__(place, on_look)
        self._executor = client.get_executor(pure=False)
        self.deaths = (KilledWorker,)
        self._client, self.count, self._looked_s = client, -1, -LOOK_S
        self.look()

    def look(self) -> None:
        if self._client.status != "running":
            raise self.lost()
        if time.monotonic() - self._looked_s < LOOK_S:
            return
        try:
            threads = self._client.nthreads()
        except OSError as error:
            raise self.lost() from error
        before, self.count, self._looked_s = self.count, sum(threads.values()), time.monotonic()
        note = ""
        if not threads:
            note = f"no worker at {self._place} yet: waiting for one"
        elif before != self.count:
            crowded = max(threads.values()) > 1
            hint = " (some have several threads; dask worker --nthreads 1 is faster)" if crowded else ""
            note = f"{len(threads)} worker{'s' * (len(threads) > 1)}{hint}"
        self._on_look(self.count, note)


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
            yield _Cluster(client, scheduler, on_look)
    elif workers == 0:
        yield _Alone("this machine", on_look)
    else:
        pool = _Pool(workers or processors(), on_look)
        try:
            try:
                pool.outcome(pool.submit(fingerprint))
            except WorkerDiedError as error:
                raise ClusterError(
                    "workers: no process can be started on this machine; in a script call run_study under "
                    'if __name__ == "__main__":, or give workers=0 (--workers 0)'
                ) from error
            yield pool
        finally:
            pool.end()


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
    comm = await connect(scheduler, timeout=_CONNECT_S, **Security().get_connection_args("client"))
    await comm.close()


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
