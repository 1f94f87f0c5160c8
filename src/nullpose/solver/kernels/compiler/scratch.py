"""Small arrays on the stack: scratch space that costs a kernel nothing to make.

An array of ``np.empty`` is a heap allocation with a counted reference, which in a kernel of a microsecond is
a third of its time. One from here lives until the kernel that asked for it returns: it may be filled, read
and handed to other kernels, never returned or kept.
"""

from __future__ import annotations

import math

import numpy as np
from numba import config, njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from nullpose.solver.kernels.compiler.jit import IS_LINKED

_ITEM = 8  # bytes of a float64 and of an int64
_MOST = 4096  # of them in one array: a thread's stack is small


def _allocate(context, builder, kind, shape: list[int], fill: bool):
    """Return the value of an array in the calling kernel's own frame."""
    count = math.prod(shape)
    # in the entry block: one place however often the line is passed
    data = cgutils.alloca_once(builder, context.get_value_type(kind.dtype), size=count)
    if fill:
        cgutils.memset(builder, data, context.get_constant(types.intp, _ITEM * count), 0)
    steps = [_ITEM * math.prod(shape[i + 1 :]) for i in range(len(shape))]
    none, counts = cgutils.get_null_value(cgutils.voidptr_t), (count, _ITEM)
    numbers = [context.get_constant(types.intp, n) for n in counts]
    ends = [
        cgutils.pack_array(builder, [context.get_constant(types.intp, n) for n in each])
        for each in (shape, steps)
    ]
    return cgutils.pack_struct(builder, [none, none, *numbers, data, *ends])


def _maker(plain, item, fill: bool):
    """Return the function that kernels call with the lengths, which are known when they are compiled."""
    if getattr(config, "DISABLE_JIT", False):  # then kernels run without the compiler
        return plain
    if not IS_LINKED:
        return njit(plain)

    @intrinsic(prefer_literal=True)
    def make(_, *lengths):
        shape = [n.literal_value for n in lengths if isinstance(n, types.IntegerLiteral)]
        if len(shape) < len(lengths) or math.prod(shape) > _MOST:
            return None
        kind = types.Array(item, len(shape), "C")

        def codegen(context, builder, signature, arguments):
            return _allocate(context, builder, kind, shape, fill)

        return kind(types.StarArgTuple.from_types(lengths)), codegen

    vars(make).update(py_func=plain, makes_arrays=True)  # as kernels have them
    return make


def _plain(*lengths: int):
    return np.empty(lengths)


def _plain_int(*lengths: int):
    return np.empty(lengths, np.int64)


def _plain_zeros(*lengths: int):
    return np.zeros(lengths)


scratch = _maker(_plain, types.float64, False)
scratch_int = _maker(_plain_int, types.int64, False)
zeroed = _maker(_plain_zeros, types.float64, True)
