"""The kernels' decorators, and the cache behind them."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numba
from numba import config

from nullpose.channel import elevation, model
from nullpose.objectives import ratios
from nullpose.problem import records
from nullpose.solver.kernels.compiler.notices import OTHER_NUMBA, UNCACHED, warn_once

LINKED_FROM, LINKED_BEFORE = (0, 61), (0, 69)
"""The versions of numba whose inside ``linked.py`` knows, which pyproject.toml asks for."""

IS_LINKED = LINKED_FROM <= tuple(map(int, numba.__version__.split(".")[:2])) < LINKED_BEFORE
"""Whether this numba is one of them; with another, kernels are compiled as any function is."""

# without the wrapper that C callbacks would use, a tenth less is compiled
_OPTIONS: dict[str, object] = {"error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}
# no references are counted, which in short kernels is a fifth of the time
_LEAN: dict[str, object] = _OPTIONS | {"_nrt": False}
# said, since a kernel inherits what is not said from the first that calls it
_HEAP: dict[str, object] = _OPTIONS | {"_nrt": True}


def kernel(function: Callable[..., object]):
    """Return the function compiled on first use, cached on disk, following IEEE rules on division by zero.

    It may take views of arrays and scratch space (``scratch.py``), but make no array on the heap: the
    compiler refuses that. Where no folder can hold a cache (a read-only installation without a home), it is
    compiled in every process.
    """
    return _compiled(function, _LEAN)


def inner_kernel(function: Callable[..., object]):
    """Return a kernel that only kernels can call: without a Python wrapper a tenth less is compiled."""
    return _compiled(function, _LEAN, is_part=True)


def small_kernel(function: Callable[..., object]):
    """Return such a kernel that is put into each of its callers.

    For a few operations, and where a family is handed on: what a kernel uses of its arrays is copied onto the
    stack.
    """
    return _compiled(function, _LEAN | {"forceinline": True}, is_part=True)


def rare_kernel(function: Callable[..., object]):
    """Return a kernel that only kernels can call and that is not put into them, nor what it calls.

    For what few scenes need: the code of all others, which grows with every copy, is compiled sooner.
    """
    return _compiled(function, _LEAN | {"forceinline": False}, is_part=True)


def heap_kernel(function: Callable[..., object]):
    """Return a kernel that makes arrays whose size is not known when it is compiled."""
    return _compiled(function, _HEAP)


def inner_heap_kernel(function: Callable[..., object]):
    """Return a kernel that makes such arrays and that only kernels can call."""
    return _compiled(function, _HEAP, is_part=True)


def _compiled(function, options, is_part=False):
    if getattr(config, "DISABLE_JIT", False):
        return function
    if IS_LINKED:
        from nullpose.solver.kernels.compiler.linked import LinkedDispatcher, Part

        kind = Part if is_part else LinkedDispatcher
        kernel = kind(function, {"nopython": True, "boundscheck": None, **options})
        if is_part:
            return kernel
    else:
        warn_once(OTHER_NUMBA.format(numba.__version__))
        kernel = numba.njit(error_model="numpy", nogil=True)(function)
    try:
        kernel.enable_caching()
    except RuntimeError:  # numba's word for "no locator available"
        warn_once(f"No folder can be written that keeps kernels. {UNCACHED}")
    else:
        _drop_outdated(kernel.stats.cache_path)
    return kernel


@cache
def digest_of_sources() -> str:
    """Return the SHA-256 of the sources of all kernels and of what these take, as they are at the first call.

    A cached kernel holds the code of those it calls, but numba compares only the file of the kernel itself.
    """
    kernels = sorted(Path(__file__).parents[1].rglob("*.py"))
    sources = [*kernels, *(Path(str(module.__file__)) for module in (records, ratios, model, elevation))]
    return sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()


@cache
def _drop_outdated(cache_path: str) -> None:
    """Delete the cached kernels unless they were made of the present sources."""
    present, stamp = digest_of_sources(), Path(cache_path) / "kernels.sha256"
    with contextlib.suppress(OSError):
        if stamp.exists() and stamp.read_text() == present:
            return
        for kept in Path(cache_path).glob("*.nb[ci]"):
            kept.unlink(missing_ok=True)
        stamp.write_text(present)


def entry_of(kernel: Any) -> Any:
    """Return the quickest entry to a kernel whose arguments are always of the same types.

    That is its machine code, once it is compiled: to choose by types, which for named tuples takes as long
    as a short kernel, is left out.

    Args:
        kernel: any.
    """
    return getattr(kernel, "entry", kernel)
