"""All real roots of a polynomial on [-1, 1], found between the roots of its derivative."""

from __future__ import annotations

import numpy as np

from nullpose.solve.kernels.jit import inner_kernel, kernel
from nullpose.solve.kernels.scratch import scratch

__all__ = ["real_roots"]

_EDGE = 1.0 + 1e-9


@inner_kernel
def horner(coefficients, degree, x):
    """Return the polynomial's value; coefficients run from the constant up."""
    value = coefficients[degree]
    for i in range(degree - 1, -1, -1):
        value = value * x + coefficients[i]
    return value


@inner_kernel
def bracketed_root(coefficients, degree, low, high, f_low):
    """Return the root in a bracket by Newton's method kept inside it by bisection."""
    x = 0.5 * (low + high)
    for _ in range(80):
        value = horner(coefficients, degree, x)
        if value == 0.0:
            return x
        if (value > 0.0) == (f_low > 0.0):
            low = x
        else:
            high = x
        slope = degree * coefficients[degree]
        for i in range(degree - 1, 0, -1):
            slope = slope * x + i * coefficients[i]
        step = value / slope if slope != 0.0 else np.inf
        new = x - step
        if not (low < new < high):
            new = 0.5 * (low + high)
        if new == x or abs(new - x) <= 2e-16 * abs(x) or high - low <= 1e-300:
            return new
        x = new
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
    count = 0
    derivative = scratch(9)
    knots = scratch(12)
    for order in range(degree - 1, -1, -1):
        d = degree - order
        for i in range(d + 1):
            factor = 1.0
            for m in range(order):
                factor *= i + order - m
            derivative[i] = coefficients[i + order] * factor
        knots[0] = -_EDGE
        for i in range(count):
            knots[1 + i] = roots[i]
        knots[1 + count] = _EDGE
        segments = count + 1
        count = 0
        left = horner(derivative, d, knots[0])
        if left == 0.0:
            roots[count] = knots[0]
            count += 1
        for i in range(segments):
            right = horner(derivative, d, knots[i + 1])
            if right == 0.0:
                if knots[i + 1] > knots[i]:
                    roots[count] = knots[i + 1]
                    count += 1
            elif left != 0.0 and (left > 0.0) != (right > 0.0):
                roots[count] = bracketed_root(derivative, d, knots[i], knots[i + 1], left)
                count += 1
            left = right
    return count
