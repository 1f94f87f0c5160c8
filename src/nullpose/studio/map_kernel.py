"""The kernel of the map, compiled by another process where it has to be, so that pages stay responsive."""

from __future__ import annotations

import atexit
import subprocess
import sys
import threading
from contextlib import suppress
from functools import cache
from pathlib import Path

import numpy as np

from nullpose.family import build_family
from nullpose.studio.edits import new_scenario

_PROGRAM = "from nullpose.studio.map_kernel import compile_map_kernel as c; c()"

_asking = threading.Lock()


def map_kernel_is_ready() -> bool:
    """Return whether the kernel can be called without compiling it; the first call has it compiled if not."""
    with _asking:
        process = _compilation()
        return process is None or process.poll() is not None


@cache
def _compilation() -> subprocess.Popen[bytes] | None:
    """Return the process that compiles the kernel; None where there is nothing to compile, or no process."""
    if _is_compiled():
        return None
    with suppress(OSError):
        quiet = subprocess.DEVNULL
        process = subprocess.Popen([sys.executable, "-c", _PROGRAM], stdin=quiet, stderr=quiet)
        atexit.register(process.wait)
        atexit.register(process.kill)  # before it is waited for
        return process
    return None


def compile_map_kernel() -> None:
    """Compile the kernel, or load it from its cache, by calling it once."""
    from nullpose.solve.kernels.axis import best_axis

    best_axis(build_family(new_scenario()).arrays, np.array([5.0, 5.0, 9.0]), np.empty(3))


def _is_compiled() -> bool:
    """Return whether the kernel is compiled, in this process or on disk, or is not to be compiled at all."""
    from nullpose.solve.kernels.axis import best_axis

    if getattr(best_axis, "signatures", True):  # a plain function has none
        return True
    cache_path = best_axis.stats.cache_path
    return cache_path is None or any(Path(cache_path).glob("axis.best_axis-*.nbi"))
