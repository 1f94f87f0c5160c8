"""Telling the user about the one slow moment: the first compilation of the kernels."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from nullpose.solver.kernels import interpreted

PREPARING = "nullpose:prepare"
"""The event that kernels are made ready, by compiling them or by waiting for another process to do so."""


@contextmanager
def announce_compiling(announce: Callable[[], None]) -> Iterator[None]:
    """Call ``announce`` once if a kernel has to be compiled in the block, not if all come from the cache.

    Args:
        announce: what to do at the first compilation, such as printing a line.
    """
    from numba.core import event

    first = cache(announce)

    class FirstCompilation(event.Listener):
        def on_start(self, event: object) -> None:
            first()

        def on_end(self, event: object) -> None:
            pass

    with event.install_listener("numba:compile", FirstCompilation()):
        yield


def working_clock() -> float:
    """Return the seconds of a clock that stands still while kernels are compiled.

    Only differences between two calls mean something.

    Example:
        >>> began = working_clock()
        >>> working_clock() - began < 1.0
        True
    """
    compiling = _compiling()
    return time.perf_counter() - (float(compiling.duration) if compiling.done else 0.0)


def limit_clock() -> float:
    """Return the seconds of the clock of time limits, which stands still until all kernels are compiled.

    While other processes compile them and Python runs them here, a proof gets on a hundred times slower.
    """
    compiler = interpreted.compiler
    return working_clock() - (0.0 if compiler is None else compiler.busy_s())


@cache
def _compiling() -> Any:
    """Return what adds up, from the first call on, the time in which kernels are compiled in this process."""
    from numba.core import event

    total = event.TimingListener()  # type: ignore[no-untyped-call]
    for kind in ("numba:compile", PREPARING):
        event.register(kind, total)  # type: ignore[no-untyped-call]
    return total
