"""Kernels as Python runs them: for a test that calls one seldom, it is not worth the time to compile it."""

from collections.abc import Callable
from functools import wraps
from typing import Any

import numpy as np

from nullpose.solver.kernels.compiler.interpreted import python_of


def plain(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """Return a kernel as a function in Python, which follows IEEE rules in silence as machine code does."""
    function = python_of(getattr(kernel, "py_func", kernel))

    @wraps(function)
    def call(*arguments: object) -> Any:
        with np.errstate(all="ignore"):
            return function(*arguments)

    return call
