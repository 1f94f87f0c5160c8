"""The one decorator of the kernels, and the cache behind it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from numba import njit

__all__ = ["inner_kernel", "kernel"]

# without the wrapper that C callbacks would use, a tenth less is compiled
_OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}


def kernel(function: Callable[..., Any]) -> Any:
    """Return the function compiled on first use, cached on disk, following IEEE rules on division by zero.

    Where no folder can hold a cache (a read-only installation without a home), it is compiled in every
    process.
    """
    return _compiled(function, _OPTIONS)


def inner_kernel(function: Callable[..., Any]) -> Any:
    """Return a kernel that only kernels can call: without a Python wrapper a tenth less is compiled."""
    return _compiled(function, _OPTIONS | {"no_cpython_wrapper": True})


def _compiled(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    try:
        dispatcher = njit(cache=True, **options)(function)
    except RuntimeError:  # numba's word for "no locator available"
        return njit(**options)(function)
    if dispatcher is not function:  # numba hands it back as it is where NUMBA_DISABLE_JIT is set
        _drop_outdated(dispatcher.stats.cache_path)
    return dispatcher


@cache
def _drop_outdated(cache_path: str) -> None:
    """Delete cached kernels older than the newest kernel source.

    A cached kernel holds the code of those it calls, but numba compares only the file of the kernel itself.
    """
    sources = Path(__file__).parent.glob("*.py")
    newest = max(source.stat().st_mtime for source in sources)
    for index in Path(cache_path).glob("*.nbi"):
        with contextlib.suppress(OSError):
            if index.stat().st_mtime < newest:
                index.unlink()
