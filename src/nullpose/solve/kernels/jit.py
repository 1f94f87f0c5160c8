"""The one decorator of the kernels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit

__all__ = ["kernel"]


def kernel(function: Callable[..., Any]) -> Any:
    """Return the function compiled on first use, cached on disk, following IEEE rules on division by zero."""
    return njit(cache=True, error_model="numpy", nogil=True)(function)
