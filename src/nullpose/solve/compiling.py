"""Telling the user about the one slow moment: the first compilation of the kernels."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def announce_compiling(announce: Callable[[], None]) -> Iterator[None]:
    """Call ``announce`` once if a kernel has to be compiled in the block, not if all come from the cache.

    Args:
        announce: what to do at the first compilation, such as printing a line.
    """
    from numba.core import event

    class FirstCompilation(event.Listener):
        done = False

        def on_start(self, event: object) -> None:
            if not self.done:
                self.done = True
                announce()

        def on_end(self, event: object) -> None:
            pass

    with event.install_listener("numba:compile", FirstCompilation()):
        yield
