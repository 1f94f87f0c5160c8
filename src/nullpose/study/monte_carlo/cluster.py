"""The Dask cluster of a study: one embedded on this machine's processors, or one that runs already."""

from __future__ import annotations

import asyncio
import logging
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from multiprocessing import resource_tracker
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from nullpose.errors import ClusterError
from nullpose.solver.worker_pool import processors

if TYPE_CHECKING:
    from distributed import Client

_CONNECT_S = 5.0  # how long a scheduler has to answer

# Nothing is served over HTTP: no password would guard it.
_NO_PAGES: dict[str, Any] = {"distributed.scheduler.http.routes": [], "distributed.worker.http.routes": []}

# One thread for each worker, also in the libraries that would start more by themselves.
_ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)


@contextmanager
def connected(scheduler: str | None, workers: int | None) -> Iterator[Client]:
    """Yield a client of a running cluster, or of one that lives as long as the block.

    Args:
        scheduler: address of a running scheduler; None for an embedded cluster.
        workers: processes of the embedded cluster; None for one on each processor.

    Raises:
        ClusterError: no scheduler answers.
    """
    with _quiet():
        if scheduler is None:
            with _embedded(workers or processors()) as client:
                yield client
        else:
            client = _client_of(scheduler)
            try:
                yield client
            finally:
                with suppress(Exception):  # the scheduler may be gone, and what counts is written
                    client.close(timeout=2)


@contextmanager
def _embedded(workers: int) -> Iterator[Client]:
    import dask
    from distributed import Client, LocalCluster, Security

    environment = dask.config.get("distributed.nanny.pre-spawn-environ", {}) | _ONE_THREAD
    settings = _NO_PAGES | {"distributed.nanny.pre-spawn-environ": environment}
    running = ExitStack()
    try:
        with _ctrl_c_put_off():
            scratch = TemporaryDirectory(prefix="nullpose-study-", ignore_cleanup_errors=True)
            settings["temporary-directory"] = running.enter_context(scratch)
            running.enter_context(dask.config.set(settings))
            cluster = LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                security=Security.temporary(),  # else anybody on this machine could run programs as us
                dashboard_address="127.0.0.1:0",  # its usual port may be another cluster's
                scheduler_kwargs={"dashboard": False},
                silence_logs=logging.CRITICAL,
            )
            client = running.enter_context(Client(running.enter_context(cluster)))
        yield client
    finally:
        with _ctrl_c_put_off():
            running.close()


def _client_of(scheduler: str) -> Client:
    from distributed import Client

    try:
        # A client that cannot connect takes long to be given up: this tells sooner. In a thread of its own,
        # since a notebook has a loop running in this one.
        with ThreadPoolExecutor(1) as pool:
            pool.submit(lambda: asyncio.run(_reached(scheduler))).result()
        return Client(scheduler, timeout=_CONNECT_S, set_as_default=False)
    except Exception as error:
        reason = (str(error).strip() or type(error).__name__).splitlines()[0]
        raise ClusterError(
            f"scheduler: no Dask scheduler answers at {scheduler} ({reason}); check the address "
            "(as in tcp://host:8786) and that it runs: dask scheduler on its machine, dask worker "
            f"{scheduler} --nthreads 1 on the others; or leave it out to use this machine"
        ) from error


async def _reached(scheduler: str) -> None:
    from distributed import Security
    from distributed.comm import connect

    # the certificate that Dask's configuration names, which a tls:// address needs
    comm = await connect(scheduler, timeout=_CONNECT_S, **Security().get_connection_args("client"))
    await comm.close()


@contextmanager
def _ctrl_c_put_off() -> Iterator[None]:
    """Hear Ctrl-C at the end of the block; processes that the block starts never hear it."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: heard.append(number))
    if has_mask := hasattr(signal, "pthread_sigmask"):
        resource_tracker.ensure_running()  # it would take the mask away if it were started in the block
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        if has_mask:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        signal.signal(signal.SIGINT, before)
        if heard:
            signal.raise_signal(signal.SIGINT)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep Dask's own log lines off the terminal: what matters is said in this package's words."""
    import distributed  # noqa: F401  its import sets up its loggers

    with ExitStack() as afterwards:
        for name in [name for name in logging.root.manager.loggerDict if name.split(".")[0] == "distributed"]:
            logger = logging.getLogger(name)
            afterwards.callback(logger.setLevel, logger.level)
            logger.setLevel(logging.CRITICAL + 1)
        yield
