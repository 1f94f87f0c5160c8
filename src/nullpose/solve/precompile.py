"""The first compilation, shared between two processes: one compiles the proof, the other the search."""

from __future__ import annotations

import gc
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FunctionType
from typing import Any

import numpy as np

from nullpose.family import AxisField, Family
from nullpose.solve.compiling import PREPARING

_WAIT_S = 300.0  # the other process is ended then, and what it compiled is compiled again
_ONE_AT_A_TIME = threading.Lock()  # threads that come first together start one process, not one each
_PROGRAM = "from nullpose.solve.precompile import compile_proof as c; c({})"


def precompile(dipoles: bool) -> None:
    """Compile search and proof if this process has not, or load them from the cache.

    Without a second process, or without a cache, this one compiles both: nothing depends on that but time.

    Args:
        dipoles: whether for ratios of points with dipoles, whose kernels are others.
    """
    from numba.core import event

    from nullpose.solve.kernels.branch import branch

    if _is_compiled(branch, dipoles):
        return
    with _ONE_AT_A_TIME:
        if not _is_compiled(branch, dipoles):
            with event.trigger_event(PREPARING):
                _compile_both(branch, dipoles)


def _compile_both(branch: Any, dipoles: bool) -> None:
    cache_path = branch.stats.cache_path
    # two where both kinds are known; if it is not this one that is, the other process has less to do
    cached = cache_path is None or len(list(Path(cache_path).glob("branch.branch-*.nbc"))) > dipoles
    other = None if cached else _started(dipoles)
    try:
        compile_search(dipoles)
        if other is not None:
            other.wait(_WAIT_S)
    except subprocess.TimeoutExpired:
        pass
    finally:
        if other is not None:
            other.kill()
            other.wait()
    compile_proof(dipoles)


def _started(dipoles: bool) -> subprocess.Popen[bytes] | None:
    try:
        command = [sys.executable, "-c", _PROGRAM.format(dipoles)]
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    except OSError:
        return None


def _is_compiled(kernel: Any, dipoles: bool) -> bool:
    """Return whether there is nothing to compile in this process: done, or told not to."""
    return isinstance(kernel, FunctionType) or dipoles in kernel.entries


def compile_proof(dipoles: bool) -> None:
    """Compile the branch and bound by giving it no box to work off.

    Args:
        dipoles: whether for ratios of points with dipoles.
    """
    from nullpose.solve.kernels import branch, node
    from nullpose.solve.kernels.records import Goal

    family, field = _smallest_family(dipoles), AxisField.free()
    row, rows, none = np.zeros(node.COLUMNS), np.zeros((1, node.COLUMNS)), np.empty(3)
    with _collecting_no_garbage():
        branch.branch(
            family.arrays,
            family.domain,
            field.arrays,
            1.0,
            Goal(1.0, row, 1.0),
            rows,
            0,
            rows,
            0,
            1,
            none,
            none,
        )


def compile_search(dipoles: bool) -> None:
    """Compile what is needed beside that, by a search of no round and a climb of no step.

    Args:
        dipoles: whether for ratios of points with dipoles.
    """
    from nullpose.solve.kernels.links import min_log_ratio
    from nullpose.solve.kernels.multistart import search_and_climb
    from nullpose.solve.kernels.node import COLUMNS, keep_largest
    from nullpose.solve.kernels.root import fill_root
    from nullpose.solve.multistart import climb

    if _is_compiled(search_and_climb, dipoles):
        return
    family, one = _smallest_family(dipoles), np.ones(1)
    up, high_m, row = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 10.0]), np.zeros(COLUMNS)
    with _collecting_no_garbage():
        climb(family, AxisField.free(), high_m, up, mu=0.1, steps=0)
        fill_root(family.arrays, family.domain, 0.0, 1.0, 1.0, one, row)
        min_log_ratio(family.arrays, high_m, up, one, one)
        keep_largest(one, 1, row)


@contextmanager
def _collecting_no_garbage() -> Iterator[None]:
    """Leave garbage uncollected: a compiler makes little, and looking for it is a fifth of its time."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def _smallest_family(dipoles: bool) -> Family:
    """Return a family of one ratio: its arrays have the types of any other's."""
    return Family(
        ground_axes=np.zeros((1, 3)) if dipoles else None,
        ground_leaks=np.zeros(1) if dipoles else None,
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
