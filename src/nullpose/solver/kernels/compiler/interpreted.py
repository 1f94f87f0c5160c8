"""Kernels as Python runs them, while other processes compile them.

That is a hundred times slower than machine code and has nothing to wait for: a small scene is solved before
its kernels are compiled.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import FunctionType
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from nullpose.solver.background_compiler import BackgroundCompiler


_LOOK_S = 0.1  # between two looks whether machine code is there


class Superseded(Exception):  # noqa: N818  no error
    """Ends what Python runs once its machine code is there."""


class OutOfTime(Exception):  # noqa: N818  no error
    """Ends what Python runs at a time limit."""


compiler: BackgroundCompiler | None = None
"""A ``BackgroundCompiler`` that compiles kernels elsewhere; None where this process compiles them."""
vain_s = 0.0
"""The time of calls that Python began and machine code did again, seconds."""
_vain_until = 0.0  # when the last of them ended: threads share the time
_is_late: Callable[[], bool] = bool
_call = threading.local()  # the kernel that Python runs, the types of its arguments, when to look again


@contextmanager
def ended_when(is_late: Callable[[], bool]) -> Iterator[None]:
    """End the block when it is late, if Python runs a kernel then; go on after it.

    Args:
        is_late: whether it is.
    """
    global _is_late
    before, _is_late = _is_late, is_late
    try:
        yield
    except OutOfTime:
        pass
    finally:
        _is_late = before


def interpret(kernel, signature, *arguments):
    """Run a kernel in Python, or as machine code if that is there before.

    An array that Python has changed is as before when machine code takes over, or when an interrupt ends the
    call: half a step of a proof must not count.

    Args:
        kernel: the kernel.
        signature: types of its arguments.
        arguments: of the call.
    """
    global vain_s, _vain_until
    kept = [(each, each.copy()) for each in arguments if isinstance(each, np.ndarray)]
    began = time.perf_counter()
    _call.kernel, _call.look_s = (kernel, signature), began + _LOOK_S
    try:
        with np.errstate(all="ignore"):  # machine code follows IEEE rules in silence
            return python_of(kernel.py_func)(*arguments)
    except BaseException as fault:
        for array, before in kept:
            array[...] = before
        if compiler is not None and isinstance(fault, KeyboardInterrupt):
            compiler.end()
        # Python raises where machine code has a number that is not finite: then machine code decides
        is_final = isinstance(fault, OutOfTime) or not isinstance(fault, Exception)
        if is_final or compiler is None or not compiler.wait(kernel, signature, _look):
            raise
    with _building:
        now = time.perf_counter()
        vain_s, _vain_until = vain_s + now - max(began, _vain_until), now
    return kernel.compile(signature)(*arguments)


@cache
def python_of(function: FunctionType) -> FunctionType:
    """Return a kernel's function in a namespace where what it calls is such a function too.

    Args:
        function: as it was written.
    """
    return FunctionType(function.__code__, _namespace(function), function.__name__)


def yielding(function: Callable[..., object]) -> Callable[..., object]:
    """Return a function that first looks, now and then, whether machine code is there or time is up.

    Args:
        function: called now and then in every long kernel.
    """

    def look_and_call(*arguments):
        if compiler is not None and time.perf_counter() > _call.look_s:
            _look()
            if not compiler.takes(*_call.kernel):
                raise Superseded
            _call.look_s = time.perf_counter() + _LOOK_S
        return function(*arguments)

    return look_and_call


def _look() -> None:
    if _is_late():
        raise OutOfTime


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
