"""All real roots of a polynomial on [-1, 1], found between the roots of its derivative."""

from __future__ import annotations

from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch

_EDGE = 1.0 + 1e-9


@inner_kernel
def horner(coefficients, degree, x):
    """Return the polynomial's value and its slope; coefficients run from the constant up."""
    value, slope = coefficients[degree], 0.0
    for i in range(degree - 1, -1, -1):
        slope = slope * x + value
        value = value * x + coefficients[i]
    return value, slope


@inner_kernel
def bracketed_root(coefficients, degree, low, high, rises):
    """Return the root in a bracket by Newton's method kept inside it by bisection."""
    x = 0.5 * (low + high)
    for _ in range(80):
        value, slope = horner(coefficients, degree, x)
        if value == 0.0:
            return x
        if (value < 0.0) == rises:
            low = x
        else:
            high = x
        before, x = x, x - value / slope
        if not low < x < high:
            x = 0.5 * (low + high)
        if abs(x - before) <= 2e-16 * abs(before):
            return x
    return x


@kernel
def real_roots(coefficients, degree, roots):
    """Fill the roots in [-1, 1] (a hair beyond included), ascending; return how many there are.

    Between neighbouring roots of the derivative a polynomial is monotone, so each bracket with a change of
    sign holds one root: differentiate down to degree one and climb back up.

    Args:
        coefficients: from the constant up, at least ``degree + 1`` of them.
        degree: nominal degree, at most 8; leading zeros are allowed.
        roots: scratch and output, at least 10 long.
    """
    derivative, knots = scratch(9), scratch(12)
    count = 0
    for order in range(degree - 1, -1, -1):
        for i in range(degree - order + 1):
            derivative[i] = coefficients[i + order]
            for m in range(order):
                derivative[i] *= i + order - m
        knots[0], knots[count + 1] = -_EDGE, _EDGE
        for i in range(count):
            knots[i + 1] = roots[i]
        last, count, before, d = count + 1, 0, 0.0, degree - order
        for i in range(last + 1):
            value, _ = horner(derivative, d, knots[i])
            if value == 0.0:
                if count == 0 or knots[i] > roots[count - 1]:
                    roots[count] = knots[i]
                    count += 1
            elif before != 0.0 and (before < 0.0) != (value < 0.0):
                roots[count] = bracketed_root(derivative, d, knots[i - 1], knots[i], before < 0.0)
                count += 1
            before = value
    return count
