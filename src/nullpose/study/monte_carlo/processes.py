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

    def watch() -> None:
        pipe.poll(None)
        os._exit(0)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def interrupts_put_off() -> Iterator[None]:
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
def environment(values: dict[str, str]) -> Iterator[None]:
    """Set variables of the environment in the block, which processes that it starts inherit."""
    before = {name: os.environ[name] for name in values if name in os.environ}
    os.environ.update(values)
    try:
        yield
    finally:
        for name in values:
            del os.environ[name]
        os.environ.update(before)
