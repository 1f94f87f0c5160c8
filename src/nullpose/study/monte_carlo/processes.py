"""How the processes of a pool begin and end: with their owner, and deaf to Ctrl-C."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection


def end_with(pipe: Connection) -> None:
    """End this process when the other end of a pipe is closed, be it by the death of who holds it."""
    threading.Thread(target=lambda: pipe.poll(None) and os._exit(0), daemon=True).start()


# Libraries would start more threads in each process.
_ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)


@contextmanager
def at_starting_processes() -> Iterator[None]:
    """Start processes in the block that never hear Ctrl-C, with one thread each; hear it at the end."""
    heard: list[int] = []
    is_main = threading.current_thread() is threading.main_thread()
    before = is_main and signal.signal(signal.SIGINT, lambda number, _: heard.append(number))
    if has_mask := is_main and hasattr(signal, "pthread_sigmask"):
        resource_tracker.ensure_running()  # it would take the mask away if it were started in the block
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    stated = {name: os.environ[name] for name in _ONE_THREAD if name in os.environ}
    os.environ.update(_ONE_THREAD)
    try:
        yield
    finally:
        for name in _ONE_THREAD:
            del os.environ[name]
        os.environ.update(stated)
        if has_mask:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        if is_main:
            signal.signal(signal.SIGINT, before)
        if heard:
            signal.raise_signal(signal.SIGINT)
