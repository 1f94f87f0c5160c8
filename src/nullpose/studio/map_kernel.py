"""The kernel of the map, compiled by another process where it has to be, so that pages stay responsive."""

from __future__ import annotations

import threading
from functools import cache

import numpy as np

from nullpose.problem.build import build_family
from nullpose.solver.background_compiler import BackgroundCompiler
from nullpose.studio.edits import new_scenario

_asking = threading.Lock()


def map_kernel_is_ready() -> bool:
    """Return whether the kernel can be called without compiling it; the first call has it compiled if not."""
    with _asking:
        return not _compiler().is_busy()


@cache
def _compiler() -> BackgroundCompiler:
    """Return what compiles the kernel, after one call that asks for it."""
    from nullpose.solver.kernels.axis import best_axis

    compiler = BackgroundCompiler()
    with compiler.in_use():
        best_axis(build_family(new_scenario()).arrays, np.array([5.0, 5.0, 9.0]), np.empty(3))
    return compiler
