"""Kernels as Python runs them, while other processes compile them.

That is a hundred times slower than machine code and has nothing to wait for: a small scene is solved before
its kernels are compiled.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from nullpose.solver.background_compiler import BackgroundCompiler


class Superseded(Exception):  # noqa: N818  no error
    """Ends what Python runs once all that is compiled elsewhere is there."""


compiler: BackgroundCompiler | None = None
"""A ``BackgroundCompiler`` that compiles kernels elsewhere; None where this process compiles them."""


def interpret(kernel, signature, *arguments):
    """Run a kernel in Python, or as machine code if that is there before.

    An array that Python has changed is as before when machine code takes over, or when an interrupt ends the
    call: half a step of a proof must not count.

    Args:
        kernel: the kernel.
        signature: types of its arguments.
        arguments: of the call.
    """
    kept = [(each, each.copy()) for each in arguments if isinstance(each, np.ndarray)]
    try:
        with np.errstate(all="ignore"):  # machine code follows IEEE rules in silence
            return python_of(kernel.py_func)(*arguments)
    except BaseException as fault:
        for array, before in kept:
            array[...] = before
        if compiler is not None and isinstance(fault, KeyboardInterrupt):
            compiler.end()
        # Python raises where machine code has a number that is not finite: then machine code decides
        if not isinstance(fault, Exception) or compiler is None or not compiler.wait():
            raise
    return kernel.compile(signature)(*arguments)


@cache
def python_of(function: FunctionType) -> FunctionType:
    """Return a kernel's function in a namespace where what it calls is such a function too.

    Args:
        function: as it was written.
    """
    return FunctionType(function.__code__, _namespace(function), function.__name__)


def yielding(function: Callable[..., object]) -> Callable[..., object]:
    """Return a function that first looks whether machine code is there.

    Args:
        function: called now and then in every long kernel.
    """

    def look_and_call(*arguments):
        if compiler is not None and not compiler.is_busy():
            raise Superseded
        return function(*arguments)

    return look_and_call


_namespaces: dict[str, dict[str, object]] = {}
_building = threading.RLock()


def _namespace(function: FunctionType) -> dict[str, object]:
    """Return the names of a kernel's module with plain functions in place of kernels."""
    module = function.__module__
    with _building:
        if module not in _namespaces:
            names = _namespaces[module] = dict(function.__globals__)
            for name, value in function.__globals__.items():
                if hasattr(value, "py_func"):
                    plain = python_of(value.py_func)
                    is_long = value.makes_arrays or callable(value)  # a part is not, and too short to look
                    names[name] = yielding(plain) if is_long else plain
        return _namespaces[module]
