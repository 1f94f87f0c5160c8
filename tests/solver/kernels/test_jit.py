"""The kernels' one decorator."""

import math

from nullpose.solver.kernels.compiler.jit import kernel


@kernel
def quotient(above, below):
    """Divides."""
    return above / below


def test_division_by_zero_follows_ieee() -> None:
    """A kernel that divides by zero returns what IEEE says and raises nothing."""
    assert math.isnan(quotient(0.0, 0.0))
    assert quotient(-1.0, 0.0) == -math.inf
