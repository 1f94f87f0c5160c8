"""The kernels made ready, by loading or compiling them, and the clocks that stand still meanwhile."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import FunctionType
from typing import Any

import numpy as np

from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.solver.background_compiler import LOOK_S, BackgroundCompiler
from nullpose.solver.kernels.compiler import interpreted

_ONE_AT_A_TIME = threading.Lock()  # threads that come first together start one process, not one each

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
    """Read a clock, in seconds, of work alone: not of compiling, nor of what Python began in vain meanwhile.

    Only differences between two calls mean something.

    Example:
        >>> began = working_clock()
        >>> working_clock() - began < 1.0
        True
    """
    return _clock() - interpreted.vain_s


def limit_clock() -> float:
    """Read the clock of time limits, in seconds, which stands still while this process compiles kernels.

    While others compile them it stands still, too, unless a command was given the limit: Python gets on with
    a proof a hundred times slower.
    """
    compiler = interpreted.compiler
    return _clock() - (0.0 if compiler is None or compiler.counts else compiler.busy_s())


def _clock() -> float:
    compiling = _compiling()
    return time.perf_counter() - (float(compiling.duration) if compiling.done else 0.0)


@cache
def _compiling() -> Any:
    """Start adding up, at the first call, the time in which this process compiles kernels."""
    from numba.core import event

    total = event.TimingListener()  # type: ignore[no-untyped-call]
    for kind in ("numba:compile", PREPARING):
        event.register(kind, total)  # type: ignore[no-untyped-call]
    return total


def precompile() -> None:
    """Compile search and proof if this process has not, or load them from the cache.

    Two other processes compile them where a folder keeps what they make; otherwise this one does.
    """
    from numba.core import event

    from nullpose.solver.kernels.bounds.branch import branch

    if _is_compiled(branch):
        return
    with _ONE_AT_A_TIME, event.trigger_event(PREPARING):
        if interpreted.compiler is None and branch.stats.cache_path is not None:
            elsewhere = BackgroundCompiler()
            with elsewhere.in_use():
                compile_proof()
                compile_search()
                while elsewhere.is_busy():
                    time.sleep(LOOK_S)
        compile_proof()
        compile_search()


def _is_compiled(kernel: object) -> bool:
    """Test if nothing is to be compiled in this process: done, or switched off."""
    return isinstance(kernel, FunctionType) or bool(getattr(kernel, "overloads", False))


def compile_proof() -> None:
    """Compile the branch and bound by giving it no box to work off."""
    from nullpose.solver.kernels.bounds import branch, node
    from nullpose.solver.kernels.bounds.records import Goal

    family, field = _smallest_family(), AxisField.free()
    row, rows, none = np.zeros(node.COLUMNS), np.zeros((1, node.COLUMNS)), np.empty(3)
    problem = family.ratios, family.domain, field.arrays
    branch.branch(*problem, 1.0, Goal(1.0, row, 0.0), rows, 0, rows, 0, 1, none, none)


def compile_search() -> None:
    """Compile what is needed beside that, by a search of no round and a climb of no step."""
    from nullpose.solver.kernels.bounds.node import COLUMNS, keep_largest
    from nullpose.solver.kernels.bounds.root import fill_root
    from nullpose.solver.kernels.bounds.signed_sum import touch
    from nullpose.solver.kernels.linear_algebra.links import log_objective
    from nullpose.solver.kernels.search.search import search_and_climb
    from nullpose.solver.multistart import climb

    if _is_compiled(search_and_climb):
        return
    family, weight = _smallest_family(), np.ones(1)
    up, high_m, row = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 10.0]), np.zeros(COLUMNS)
    climb(family, AxisField.free(), high_m, up, mu=0.1, steps=0)
    fill_root(family.ratios, family.domain, 0.0, 1.0, 1.0, weight, up, row)
    log_objective(family.ratios, high_m, up, weight, weight)
    keep_largest(weight, 1, row, False)
    touch(row, up)


def _smallest_family() -> Family:
    """Build a family of one ratio: its arrays have the types of any other's."""
    return Family(
        points_m=np.zeros((1, 3)),
        numerator_isotropic=np.zeros(1),
        numerator_weight=np.ones(1),
        numerator_point=np.zeros(1, dtype=np.int64),
        denominator_of=np.zeros(1, dtype=np.int64),
        denominator_isotropic=np.ones(1),
        denominator_start=np.zeros(2, dtype=np.int64),
        denominator_point=np.zeros(0, dtype=np.int64),
        denominator_weight=np.zeros(0),
        low_m=np.zeros(3),
        high_m=np.ones(3),
        keep_out_points_m=np.zeros((0, 3)),
        keep_out_m=1.0,
    )
