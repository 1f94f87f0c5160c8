"""Scratch space: fresh where it is said to be, of the lengths asked for, and nothing on the heap."""

import numpy as np
import pytest
from numba.core.errors import NumbaError

from nullpose.solver.kernels.compiler.jit import heap_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch, scratch_int, zeroed

LENGTH = 5


@kernel
def fill_row(row, value):
    """Counts on in somebody else's table, through a view of it."""
    for k in range(row.shape[0]):
        row[k] = value + k


@kernel
def filled(turns, out):
    """Counts in scratch space what it adds up, in a loop that meets the same line again and again."""
    for turn in range(turns):
        sums, table, places = zeroed(LENGTH), scratch(3, LENGTH), scratch_int(3)
        for i in range(3):
            places[i] = 2 - i
            fill_row(table[places[i]], turn + 10.0 * i)
        for i in range(3):
            for k in range(LENGTH):
                sums[k] += table[i, k]
        for k in range(LENGTH):
            out[turn, k] = sums[k]


def test_zeroed_space_is_zero_every_time() -> None:
    """Each pass of a loop begins anew, and what was written is read back."""
    out = np.empty((4, LENGTH))
    filled(4, out)
    wanted = 3.0 * np.arange(4)[:, None] + 30.0 + 3.0 * np.arange(LENGTH)
    np.testing.assert_array_equal(out, wanted)


def test_lengths_must_be_known() -> None:
    """A length that only the caller knows is refused by the compiler, not guessed; so is a huge one."""

    @heap_kernel
    def unknown(n):
        return scratch(n)[0]

    @heap_kernel
    def huge():
        return scratch(100, 100)[0, 0]

    for function, arguments in ((unknown, (3,)), (huge, ())):
        with pytest.raises(NumbaError):
            function(*arguments)


def test_a_kernel_makes_nothing_on_the_heap() -> None:
    """Unless it says so by its decorator."""

    @heap_kernel
    def allowed(n):
        return np.empty(n).shape[0]

    @kernel
    def refused(n):
        return np.empty(n).shape[0]

    assert allowed(3) == 3
    with pytest.raises(NumbaError):
        refused(3)
